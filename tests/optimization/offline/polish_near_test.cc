// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/polish_near.h"

#include <vector>

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Information a hundred times too small: wrong loops fit within the gate.
PoseGraph Careful(PoseGraph graph) {
  for (PoseGraphEdge& edge : graph.edges) edge.information *= 0.01;
  return graph;
}

class PolishNearTest : public ::testing::Test {
 protected:
  PolishNearTest() {
    const test::GridWorld world = test::MakeGridWorld(250, 8, 5);
    const PoseGraph clean = Careful(world.graph);
    optimum_ = clean.poses;
    SolveRobust(Whiten(clean.edges), SolverOptions(), &optimum_);
    graph_ = clean;
    test::AppendOutliers(clean, test::Outliers(300, OutlierType::kLocal),
                         &graph_.edges);
    edges_ = Whiten(graph_.edges);
    lowest_ = optimum_;
    PolishTruncated(edges_, kChi2Gate, 30, &lowest_, nullptr);
    lowest_cost_ = TruncatedCost(edges_, lowest_);
  }

  PoseGraph graph_;
  std::vector<Pose2> optimum_;  // without outliers
  std::vector<WhitenedEdge> edges_;
  std::vector<Pose2> lowest_;
  double lowest_cost_ = 0.;
};

TEST_F(PolishNearTest, KeepsTheLimitAndComesNearer) {
  const double distance = AbsoluteTrajectoryError(lowest_, optimum_);
  double last = distance;
  for (const double excess : {1e-6, 1e-4, 1e-2}) {
    const double limit = (1. + excess) * lowest_cost_;
    std::vector<Pose2> poses = lowest_;
    std::vector<double> weights;
    PolishNear(edges_, optimum_, limit, &poses, &weights);
    EXPECT_LE(TruncatedCost(edges_, poses), limit);
    const double near = AbsoluteTrajectoryError(poses, optimum_);
    EXPECT_LE(near, last);
    last = near;
    ASSERT_EQ(weights.size(), edges_.size());
    for (const double weight : weights) {
      EXPECT_TRUE(weight == 0. || weight == 1.);
    }
  }
  EXPECT_LT(last, 0.8 * distance);
}

TEST_F(PolishNearTest, StaysWhereNoTieIsWeakEnough) {
  std::vector<Pose2> poses = lowest_;
  PolishNear(edges_, optimum_, 0.5 * lowest_cost_, &poses, nullptr);
  EXPECT_EQ(AbsoluteTrajectoryError(poses, lowest_), 0.);
}

TEST_F(PolishNearTest, AutoHasTheLowestCostAndTheShape) {
  OptimizeOptions options;
  options.lowest_cost = false;
  const auto adapted = Optimize(graph_, options);
  ASSERT_TRUE(adapted.ok());
  options.lowest_cost = true;
  const auto both = Optimize(graph_, options);
  ASSERT_TRUE(both.ok());
  EXPECT_LE(both->truncated_chi2, adapted->truncated_chi2);
  for (const char* method : {"dcs", "gm", "acs"}) {
    options.method = method;
    const auto single = Optimize(graph_, options);
    EXPECT_LE(both->truncated_chi2, single->truncated_chi2) << method;
  }
  EXPECT_LT(adapted->truncated_chi2, 1.01 * both->truncated_chi2);
  EXPECT_LT(AbsoluteTrajectoryError(adapted->poses, optimum_), 1e-5);
  // Another start leads lower than downhill from the right shape does, by two
  // parts in 10,000 and with a few wrong loops more; the lowest cost decides.
  EXPECT_LT(both->truncated_chi2, lowest_cost_);
  EXPECT_LT(AbsoluteTrajectoryError(both->poses, optimum_), 0.04);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
