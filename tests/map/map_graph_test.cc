// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_graph.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

GraphNode MakeNode(io::TimeNs time, const Pose2& local, const Pose2& global) {
  GraphNode node;
  node.time = time;
  node.local_pose = local;
  node.global_pose = global;
  node.global_tracking_pose = ToIsometry(global);
  return node;
}

MapGraph TwoTrajectories() {
  MapGraph graph;
  graph.nodes[{0, 0}] = MakeNode(10, Pose2(1., 0., 0.), Pose2(2., 0., 0.));
  graph.nodes[{0, 1}] = MakeNode(20, Pose2(3., 0., 0.), Pose2(4., 0., 0.));
  graph.nodes[{1, 0}] = MakeNode(15, Pose2(5., 0., 0.), Pose2(6., 0., 0.));
  graph.submaps[{0, 0}].global_pose = Pose2(1., 0., 0.);
  graph.constraints.resize(3);
  graph.constraints[0].node_id = {0, 1};
  graph.constraints[1].node_id = {0, 0};
  graph.constraints[2].node_id = {1, 0};
  graph.constraints[2].is_loop = true;
  graph.constraints[2].relative_pose = Pose2(4., 3., 0.);
  return graph;
}

TEST(MapGraphTest, TrajectoriesAreInOrderOfTime) {
  const MapGraph graph = TwoTrajectories();
  const Trajectory all = graph.GlobalTrajectory();
  ASSERT_EQ(all.poses().size(), 3u);
  EXPECT_EQ(all.poses()[1].pose.translation().x(), 6.);
  ASSERT_EQ(graph.GlobalTrajectory(0).poses().size(), 2u);
  EXPECT_EQ(graph.GlobalTrajectory(0).poses()[1].pose.translation().x(), 4.);
  ASSERT_EQ(graph.LocalTrajectory(0).poses().size(), 2u);
  EXPECT_EQ(graph.LocalTrajectory(0).poses()[0].pose.translation().x(), 1.);
  EXPECT_TRUE(graph.GlobalTrajectory(7).empty());
}

TEST(MapGraphTest, InsertedNodesAreSortedAndLeaveLoopsOut) {
  const auto inserted = TwoTrajectories().InsertedNodes();
  ASSERT_EQ(inserted.size(), 1u);
  const std::vector<GraphId> expected = {{0, 0}, {0, 1}};
  EXPECT_EQ(inserted.at({0, 0}), expected);
}

TEST(MapGraphTest, CountsLoops) { EXPECT_EQ(TwoTrajectories().num_loops(), 1); }

TEST(MapGraphTest, ResidualIsSeenFromTheConstraint) {
  const MapGraph graph = TwoTrajectories();
  // submap^-1 * node = (5, 0), the constraint says (4, 3).
  const Pose2 residual = Residual(
      graph.constraints[2], graph.submaps.at({0, 0}), graph.nodes.at({1, 0}));
  EXPECT_NEAR(residual.x, 1., 1e-12);
  EXPECT_NEAR(residual.y, -3., 1e-12);
}

TEST(MapGraphTest, IdsPrintAndCompare) {
  EXPECT_EQ(ToString(GraphId{1, 23}), "(1, 23)");
  EXPECT_TRUE((GraphId{0, 9} < GraphId{1, 0}));
  EXPECT_TRUE((GraphId{1, 0} != GraphId{1, 1}));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
