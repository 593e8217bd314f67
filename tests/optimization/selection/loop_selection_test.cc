// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/selection/loop_selection.h"

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

std::vector<int> Neighbours(const PoseGraph& graph) {
  std::vector<int> result;
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    if (!graph.edges[i].is_loop) result.push_back(i);
  }
  return result;
}

// Least squares with the loops in force.
std::vector<Pose2> Solution(const PoseGraph& graph,
                            const LoopSelection& selection) {
  SolverOptions options;
  options.edge_weights.assign(selection.accepted.begin(),
                              selection.accepted.end());
  std::vector<Pose2> poses = graph.poses;
  SolveRobust(Whiten(graph.edges), options, &poses);
  return poses;
}

TEST(LoopSelectionTest, RightLoopsAreAllAcceptedAfterALongDrift) {
  test::GridWorld world = test::MakeGridWorld(250, 8, 5);
  const LoopSelection selection =
      SelectLoops(world.graph, Neighbours(world.graph), LoopSelectionOptions());
  int rejected = 0;
  for (const bool accepted : selection.accepted) rejected += !accepted;
  // The gate refuses one in a hundred.
  EXPECT_LE(rejected, 5);
  EXPECT_TRUE(selection.suspects.empty());
  EXPECT_LT(
      AbsoluteTrajectoryError(Solution(world.graph, selection), world.truth),
      0.1);
}

TEST(LoopSelectionTest, WrongLoopsAreSwitchedOffAndComeBackWithEvidence) {
  test::GridWorld world = test::MakeGridWorld(250, 8, 5);
  const size_t clean = world.graph.edges.size();
  test::AddOutliers(test::Outliers(20), &world.graph);
  LoopSelection selection =
      SelectLoops(world.graph, Neighbours(world.graph), LoopSelectionOptions());
  int lost = 0, wrong = 0;
  for (size_t i = 0; i != selection.accepted.size(); ++i) {
    if (i < clean) {
      lost += !selection.accepted[i];
    } else {
      wrong += selection.accepted[i];
    }
  }
  EXPECT_LE(lost, 6);
  EXPECT_LE(wrong, 1);
  EXPECT_LT(
      AbsoluteTrajectoryError(Solution(world.graph, selection), world.truth),
      0.1);

  // The "wrong" loops alone, now true: nothing is remembered against them.
  PoseGraph other = world.graph;
  for (size_t i = clean; i != other.edges.size(); ++i) {
    PoseGraphEdge& edge = other.edges[i];
    edge.measurement = Between(world.truth[edge.from], world.truth[edge.to]);
  }
  selection = SelectLoops(other, Neighbours(other), LoopSelectionOptions());
  int back = 0;
  for (size_t i = clean; i != other.edges.size(); ++i) {
    back += selection.accepted[i];
  }
  EXPECT_GE(back, 19);
}

// A chain with one loop that contradicts it, and the decision by consensus off:
// only the odometry check can notice.
TEST(LoopSelectionTest, OdometryCheckSuspectsAndRollsBack) {
  PoseGraph graph;
  for (int i = 0; i != 11; ++i) {
    graph.ids.push_back(i);
    graph.poses.push_back(Pose2(i, 0., 0.));
    if (i == 0) continue;
    PoseGraphEdge edge;
    edge.from = i - 1;
    edge.to = i;
    edge.measurement = Pose2(1., 0., 0.);
    edge.information = 1e4 * Eigen::Matrix3d::Identity();
    graph.edges.push_back(edge);
  }
  PoseGraphEdge right;
  right.from = 0;
  right.to = 10;
  right.is_loop = true;
  right.measurement = Pose2(10., 0., 0.);
  right.information = 1e4 * Eigen::Matrix3d::Identity();
  graph.edges.push_back(right);
  PoseGraphEdge wrong = right;
  wrong.from = 2;
  wrong.to = 8;
  wrong.measurement = Pose2(3., 0., 0.);  // three metres short
  graph.edges.push_back(wrong);
  LoopSelectionOptions options;
  options.robust_loops = false;
  LoopSelection selection = SelectLoops(graph, Neighbours(graph), options);
  ASSERT_EQ(selection.suspects.size(), 1u);
  EXPECT_EQ(selection.suspects[0], 11);
  EXPECT_TRUE(selection.accepted[10]);
  EXPECT_FALSE(selection.accepted[11]);
  EXPECT_EQ(selection.violations, 0);
  EXPECT_NEAR(Solution(graph, selection)[8].x, 8., 1e-3);

  options.max_rollbacks = 0;
  selection = SelectLoops(graph, Neighbours(graph), options);
  EXPECT_TRUE(selection.accepted[11]);
  EXPECT_GT(selection.violations, 0);

  options.odometry_check = false;
  selection = SelectLoops(graph, Neighbours(graph), options);
  EXPECT_TRUE(selection.accepted[11]);

  // Consensus alone decides the same here.
  options.robust_loops = true;
  selection = SelectLoops(graph, Neighbours(graph), options);
  EXPECT_TRUE(selection.accepted[10]);
  EXPECT_FALSE(selection.accepted[11]);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
