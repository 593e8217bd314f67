// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/stretch_bend.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kSteps = 20;

// A straight chain of 1 m steps, sigma 0.01 m and rad, and a stiff loop between
// its ends.
class StretchBendTest : public ::testing::Test {
 protected:
  StretchBendTest() {
    for (int i = 0; i <= kSteps; ++i) AddPose(Pose2(i, 0., 0.));
    for (int i = 0; i != kSteps; ++i) {
      neighbours_.push_back(i);
      AddEdge(i, i + 1, 1e4);
    }
  }

  void AddPose(const Pose2& pose) {
    graph_.ids.push_back(graph_.poses.size());
    graph_.poses.push_back(pose);
  }

  void AddEdge(const int from, const int to, const double information) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.measurement = Between(graph_.poses[from], graph_.poses[to]);
    edge.information = information * Eigen::Matrix3d::Identity();
    graph_.edges.push_back(edge);
  }

  void AddLoop(const Pose2& error) {
    AddEdge(0, kSteps, 1e8);
    graph_.edges.back().is_loop = true;
    graph_.edges.back().measurement = graph_.edges.back().measurement * error;
  }

  static std::vector<Pose2> Optimum(const PoseGraph& graph) {
    SolverOptions options;
    options.cost_tolerance = 1e-12;
    std::vector<Pose2> poses = graph.poses;
    SolveRobust(Whiten(graph.edges), options, &poses);
    return poses;
  }

  double InTheWholeGraph() const {
    const std::vector<Pose2> poses = Optimum(graph_);
    double largest = 0.;
    for (const int i : neighbours_) {
      const PoseGraphEdge& edge = graph_.edges[i];
      largest = std::max(largest,
                         Chi2(Whiten(edge), poses[edge.from], poses[edge.to]));
    }
    return largest;
  }

  double InStretches(const std::vector<int>& stretches) const {
    const CondensedGraph condensed = Condense(graph_, neighbours_, 10);
    EXPECT_EQ(condensed.chain.size(), 2u);
    return LargestBend(graph_, neighbours_, condensed, Optimum(condensed.graph),
                       stretches);
  }

  PoseGraph graph_;
  std::vector<int> neighbours_;
};

TEST_F(StretchBendTest, StepsShareTheStrain) {
  AddLoop(Pose2(0.6, 0., 0.));
  // 0.03 m at 0.01 m each.
  EXPECT_NEAR(InTheWholeGraph(), 9., 1e-2);
  EXPECT_NEAR(InStretches({0, 1}), 9., 1e-2);
  EXPECT_NEAR(InStretches({1}), 9., 1e-2);
  EXPECT_EQ(InStretches({}), 0.);
}

TEST_F(StretchBendTest, FollowsWhatHoldsThePosesBetween) {
  // Two loose poses, tied to the first and to the second half of a stretch.
  AddPose(Pose2(2., 1., 0.3));
  AddPose(Pose2(7., 1., -0.2));
  for (int i = 1; i != 10; ++i) {
    AddEdge(i < 5 ? kSteps + 1 : kSteps + 2, i, 30.);
  }
  AddLoop(Pose2(0.5, 0.4, 0.2));
  const double expected = InTheWholeGraph();
  EXPECT_GT(expected, 15.);
  EXPECT_NEAR(InStretches({0, 1}), expected, 0.25 * expected);
}

TEST_F(StretchBendTest, TellsNothingOfWhatItDoesNotKnow) {
  AddEdge(5, 15, 1.);
  AddLoop(Pose2());
  EXPECT_TRUE(std::isinf(InStretches({0})));
  EXPECT_NEAR(InStretches({0, 1}), 0., 1e-9);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
