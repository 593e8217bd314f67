// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/loop_growth.h"

#include <cmath>

#include "Eigen/LU"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "gmock/gmock.h"
#include "tests/optimization/loop_counts.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

TEST(LoopGrowthTest, FindsRightLoopsWhereOdometrySaysLittle) {
  for (const uint64_t seed : {1, 2, 3}) {
    test::GridWorld world = test::MakeWeakRing(seed);
    const size_t clean = world.graph.edges.size();
    test::AddOutliers(test::Outliers(40, OutlierType::kRandom, seed),
                      &world.graph);
    const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
    RobustSolver solver(edges);
    std::vector<Pose2> poses = world.graph.poses;
    std::vector<double> weights;
    ASSERT_TRUE(GrowLoops(FindLoopSupport(world.graph, LoopSupportOptions()),
                          GrowthOptions(), &solver, &poses, &weights));
    const test::LoopCounts counts = test::CountLoops(edges, clean, weights);
    EXPECT_GE(counts.right_in_force, 0.9 * counts.right) << seed;
    EXPECT_LE(counts.wrong_in_force, 3) << seed;
  }
}

TEST(LoopGrowthTest, InnovationsAreHonest) {
  // Of one loop that closes a chain: its chi2 over the noise of all.
  double sum = 0.;
  constexpr int kTrials = 300;
  Random random(5);
  for (int trial = 0; trial != kTrials; ++trial) {
    PoseGraph graph;
    Pose2 pose;
    std::vector<PoseGraphEdge> edges;
    for (int i = 0; i != 12; ++i) {
      PoseGraphEdge edge;
      edge.from = i == 11 ? 0 : i;
      edge.to = i == 11 ? 11 : i + 1;
      edge.is_loop = i == 11;
      edge.measurement = Pose2(i == 11 ? 11. : 1., 0., 0.) *
                         Pose2(random.Normal(0., 0.02), random.Normal(0., 0.02),
                               random.Normal(0., 0.005));
      edge.information = Eigen::Vector3d(2500., 2500., 40000.).asDiagonal();
      edges.push_back(edge);
    }
    std::vector<Pose2> poses = {Pose2()};
    for (int i = 0; i != 11; ++i) {
      poses.push_back(poses.back() * edges[i].measurement);
    }
    const std::vector<WhitenedEdge> whitened = Whiten(edges);
    RobustSolver solver(whitened);
    std::vector<double> weights(12, 1.);
    weights[11] = 0.;
    const std::vector<Innovation> innovations =
        PredictLoops({11}, weights, poses, &solver);
    ASSERT_EQ(innovations.size(), 1u);
    sum += innovations[0].chi2;
    EXPECT_GT(innovations[0].log_determinant, 0.);
    EXPECT_NEAR(std::log(innovations[0].covariance.determinant()),
                innovations[0].log_determinant, 1e-9);
  }
  EXPECT_NEAR(sum / kTrials, 3., 0.45);
}

// A prediction with fewer loops in force is less certain: what is far off with it
// is far off with more, which spares predictions while a map grows.
TEST(LoopGrowthTest, WhatIsFarOffStaysFarOff) {
  test::GridWorld world = test::MakeWeakRing(1);
  const size_t clean = world.graph.edges.size();
  test::AddOutliers(test::Outliers(40), &world.graph);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  SolverOptions options;
  options.edge_weights.assign(edges.size(), 1.);
  std::vector<int> right, wrong;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) continue;
    options.edge_weights[i] = 0.;
    (i < clean ? right : wrong).push_back(i);
  }
  std::vector<Pose2> poses = world.graph.poses;
  const auto put_in_force = [&](const size_t begin, const size_t end) {
    for (size_t k = begin; k != end; ++k) {
      options.edge_weights[right[k]] = 1.;
    }
    poses = world.truth;
    solver.Solve(options, &poses);
  };
  put_in_force(0, right.size() / 2);
  const std::vector<Innovation> before =
      PredictLoops(wrong, options.edge_weights, poses, &solver);
  put_in_force(right.size() / 2, right.size());
  const std::vector<Innovation> after =
      PredictLoops(wrong, options.edge_weights, poses, &solver);
  int far_off = 0;
  for (size_t k = 0; k != wrong.size(); ++k) {
    const WhitenedEdge& edge = edges[wrong[k]];
    const Eigen::Vector3d residual =
        Residual(edge, poses[edge.from], poses[edge.to]);
    const double least =
        residual.dot(before[k].covariance.inverse() * residual);
    EXPECT_GT(after[k].chi2, 0.5 * least);
    far_off += least > 4. * kChi2Gate;
  }
  EXPECT_GT(far_off, 10);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
