// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/starts.h"

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

TEST(StartsTest, ChainedOdometryIsExactWithoutNoise) {
  test::GridWorld world = test::MakeGridWorld(80, 5, 1);
  for (PoseGraphEdge& edge : world.graph.edges) {
    edge.measurement = Between(world.truth[edge.from], world.truth[edge.to]);
  }
  world.graph.poses.assign(world.truth.size(), Pose2());
  const std::vector<Pose2> chained = ChainOdometry(world.graph);
  const std::vector<Pose2> tree = SpanningTree(
      world.graph, std::vector<double>(world.graph.edges.size(), 1.));
  std::vector<Pose2> chordal(world.truth.size(), Pose2());
  ASSERT_TRUE(ChordalPoses(Whiten(world.graph.edges),
                           std::vector<double>(world.graph.edges.size(), 1.),
                           &chordal));
  const std::vector<const std::vector<Pose2>*> all = {&chained, &tree,
                                                      &chordal};
  for (const std::vector<Pose2>* const poses : all) {
    for (size_t i = 0; i != poses->size(); ++i) {
      EXPECT_NEAR((*poses)[i].x, world.truth[i].x, 1e-6);
      EXPECT_NEAR((*poses)[i].y, world.truth[i].y, 1e-6);
      EXPECT_NEAR(NormalizeAngle((*poses)[i].theta - world.truth[i].theta), 0.,
                  1e-6);
    }
  }
}

TEST(StartsTest, ChainAttachesWhatOdometryDoesNotReach) {
  PoseGraph graph;
  graph.ids = {0, 1, 1000, 1001};
  graph.poses.assign(4, Pose2());
  const auto add = [&](const int from, const int to, const bool is_loop) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.measurement = Pose2(1., 0., 0.);
    edge.is_loop = is_loop;
    graph.edges.push_back(edge);
  };
  add(0, 1, false);
  add(2, 3, false);
  add(1, 3, true);
  const std::vector<Pose2> poses = ChainOdometry(graph);
  EXPECT_DOUBLE_EQ(poses[1].x, 1.);
  EXPECT_DOUBLE_EQ(poses[3].x, 2.);
  EXPECT_DOUBLE_EQ(poses[2].x, 1.);
}

TEST(StartsTest, TreePrefersShortPathsOverLoops) {
  const test::GridWorld world = test::MakeGridWorld(400, 6, 3);
  std::vector<double> weights(world.graph.edges.size(), 1.);
  const double with_loops =
      AbsoluteTrajectoryError(SpanningTree(world.graph, weights), world.truth);
  weights.assign(weights.size(), 0.);
  const double without =
      AbsoluteTrajectoryError(SpanningTree(world.graph, weights), world.truth);
  EXPECT_LT(with_loops, 0.5 * without);
  EXPECT_NEAR(without,
              AbsoluteTrajectoryError(ChainOdometry(world.graph), world.truth),
              1e-9);
}

TEST(StartsTest, RobustChordalPosesSurviveWrongLoops) {
  test::GridWorld world = test::MakeGridWorld(300, 6, 4);
  test::AddOutliers(test::Outliers(30), &world.graph);
  std::vector<Pose2> poses(world.truth.size(), Pose2());
  ASSERT_TRUE(RobustChordalPoses(Whiten(world.graph.edges), &poses));
  EXPECT_LT(AbsoluteTrajectoryError(poses, world.truth), 0.5);
}

TEST(StartsTest, ChordalPosesNeedEdges) {
  const test::GridWorld world = test::MakeGridWorld(20, 4, 1);
  std::vector<Pose2> poses = world.graph.poses;
  EXPECT_FALSE(ChordalPoses(Whiten(world.graph.edges),
                            std::vector<double>(world.graph.edges.size(), 0.),
                            &poses));
  EXPECT_EQ(poses[7].x, world.graph.poses[7].x);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
