// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_map.h"

#include <cmath>
#include <cstdint>

#include "cartographer_ext/map/host_types.h"
#include "gtest/gtest.h"
#include "tests/map/probability_grid.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraph;

cartographer::transform::proto::Rigid3d PoseProto(double x, double yaw) {
  cartographer::transform::proto::Rigid3d proto;
  proto.mutable_translation()->set_x(x);
  proto.mutable_rotation()->set_z(std::sin(yaw / 2.));
  proto.mutable_rotation()->set_w(std::cos(yaw / 2.));
  return proto;
}

// A submap whose one known cell is occupied, and a node in it that is turned by
// 1 rad and whose gravity alignment holds a yaw of 0.4 rad, as it does in
// states of the real system.
io::Pbstream OneNode() {
  io::Pbstream state;
  auto* const trajectory = state.pose_graph.add_trajectory();
  *trajectory->add_submap()->mutable_pose() = PoseProto(10., kPi / 2.);
  state.submaps.emplace_back();
  auto* const submap = state.submaps.back().mutable_submap_2d();
  *submap->mutable_local_pose() = PoseProto(1., 0.);
  submap->set_finished(true);
  submap->set_num_range_data(180);
  *submap->mutable_grid() =
      cartographer_ext::test::ProbabilityGrid(1., 4., 1., 1, 1, 1);
  auto* const node = trajectory->add_node();
  node->set_node_index(5);
  *node->mutable_pose() = PoseProto(12., 2.);
  state.nodes.emplace_back();
  state.nodes.back().mutable_node_id()->set_node_index(5);
  auto* const data = state.nodes.back().mutable_node_data();
  data->set_timestamp(
      cartographer::common::ToUniversal(ToHostTime(7000000000LL)));
  *data->mutable_gravity_alignment() = PoseProto(0., 0.4).rotation();
  *data->mutable_local_pose() = PoseProto(3., 1.);
  auto* const constraint = state.pose_graph.add_constraint();
  constraint->mutable_submap_id();
  constraint->mutable_node_id()->set_node_index(5);
  *constraint->mutable_relative_pose() = PoseProto(2., 1.);
  constraint->set_translation_weight(500.);
  constraint->set_rotation_weight(1600.);
  return state;
}

TEST(PbstreamMapTest, AllStampsOfFilesHaveDifferences) {
  EXPECT_EQ(FromHostTicks(kUnixEpochTicks), 0);
  EXPECT_EQ(FromHostTicks(kUnixEpochTicks - 15), -1500);
  EXPECT_EQ(FromHostTicks(0), 0);
  EXPECT_EQ(FromHostTicks(15), 1500);
  const io::TimeNs first = FromHostTicks(kUnixEpochTicks - kEraTicks);
  const io::TimeNs last = FromHostTicks(kMaxHostTicks);
  EXPECT_EQ(FromHostTicks(kEraTicks), last);
  EXPECT_EQ(first, -last);
  EXPECT_GT(last - first, 0);
}

TEST(PbstreamMapTest, NodesStandForTheTrackingFrame) {
  const MapGraph graph = MakeMapGraph(OneNode());
  ASSERT_EQ(graph.nodes.size(), 1u);
  const GraphNode& node = graph.nodes.at({0, 5});
  EXPECT_EQ(node.time, 7000000000LL);
  EXPECT_NEAR(node.local_pose.x, 3., 1e-12);
  EXPECT_NEAR(node.local_pose.theta, 1., 1e-12);
  EXPECT_NEAR(node.global_pose.x, 12., 1e-12);
  EXPECT_NEAR(node.global_pose.theta, 2., 1e-12);
  const GraphSubmap& submap = graph.submaps.at({0, 0});
  EXPECT_TRUE(submap.finished);
  EXPECT_EQ(submap.num_range_data, 180);
  ASSERT_EQ(graph.constraints.size(), 1u);
  const GraphConstraint& constraint = graph.constraints[0];
  EXPECT_FALSE(constraint.is_loop);
  EXPECT_EQ(constraint.translation_weight, 500.);
  // The constraint is the local pose, whatever yaw the alignment holds.
  const Pose2 difference = Between(constraint.relative_pose,
                                   Between(submap.local_pose, node.local_pose));
  EXPECT_NEAR(difference.translation().norm(), 0., 1e-12);
  EXPECT_NEAR(difference.theta, 0., 1e-12);
}

TEST(PbstreamMapTest, TheTagMakesALoop) {
  io::Pbstream state = OneNode();
  state.pose_graph.mutable_constraint(0)->set_tag(
      PoseGraph::Constraint::INTER_SUBMAP);
  EXPECT_EQ(MakeMapGraph(state).num_loops(), 1);
}

TEST(PbstreamMapTest, WithoutGlobalPoseThereIsNoVertex) {
  io::Pbstream state = OneNode();
  state.pose_graph.mutable_trajectory(0)->clear_node();
  state.pose_graph.mutable_trajectory(0)->clear_submap();
  const MapGraph graph = MakeMapGraph(state);
  EXPECT_TRUE(graph.nodes.empty());
  EXPECT_TRUE(graph.submaps.empty());
  EXPECT_FALSE(PaintPbstreamMap(state, 1.).ok());
}

TEST(PbstreamMapTest, PaintsSubmapsAtTheirGlobalPoses) {
  const auto map = PaintPbstreamMap(OneNode(), 1.);
  ASSERT_TRUE(map.ok()) << map.status();
  // The cell's centre (3.5, 0.5) is (2.5, 0.5) in the submap, which a quarter
  // turn and ten metres take to (9.5, 2.5).
  bool found = false;
  for (int y = 0; y < map->height; ++y) {
    for (int x = 0; x < map->width; ++x) {
      if (std::isnan(map->at(x, y))) continue;
      found = true;
      EXPECT_NEAR(map->origin.x + x + 0.5, 9.5, 1e-9);
      EXPECT_NEAR(map->origin.y + y + 0.5, 2.5, 1e-9);
      EXPECT_NEAR(map->at(x, y), 0.9, 1e-5);
    }
  }
  EXPECT_TRUE(found);
}

TEST(PbstreamMapTest, InsertionsOfARealMapAreItsLocalPoses) {
  const std::string filename =
      test::SharedData("pbstream/aces-sound-by-cartographer.pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename);
  const auto state = io::ReadPbstream(filename);
  ASSERT_TRUE(state.ok()) << state.status();
  const MapGraph graph = MakeMapGraph(*state);
  EXPECT_EQ(graph.nodes.size(), 2795u);
  EXPECT_EQ(graph.num_loops(), 730);
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop) continue;
    const Pose2 difference =
        Between(constraint.relative_pose,
                Between(graph.submaps.at(constraint.submap_id).local_pose,
                        graph.nodes.at(constraint.node_id).local_pose));
    ASSERT_LT(difference.translation().norm(), 1e-6);
    ASSERT_LT(std::abs(difference.theta), 1e-6);
  }
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
