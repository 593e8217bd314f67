// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/local_rerun.h"

#include <cmath>
#include <string>
#include <vector>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace repair {
namespace {

class LocalRerunTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_ = new io::Pbstream(
        test::MakeRoomMap(testing::TempDir() + "/local_rerun_test.pbstream"));
  }
  static void TearDownTestSuite() { delete room_; }

  static cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D
  Options() {
    const auto slam = test::RoomConfiguration();
    const auto& stored =
        slam.trajectory_builder_options.trajectory_builder_2d_options();
    return OptionsForClouds(stored, stored);
  }

  static io::Pbstream* room_;
};

io::Pbstream* LocalRerunTest::room_ = nullptr;

TEST_F(LocalRerunTest, RunsFromTheClouds) {
  const evaluation::MapGraph before = evaluation::MakeMapGraph(*room_);
  for (const NodeMatching matching :
       {NodeMatching::kFrontEnd, NodeMatching::kNone}) {
    const auto rerun =
        RerunLocalSlam(*room_, LocalChain(*room_), matching, Options());
    ASSERT_TRUE(rerun.ok()) << rerun.status();
    EXPECT_TRUE(io::FindPbstreamProblems(*rerun).empty());
    const evaluation::MapGraph after = evaluation::MakeMapGraph(*rerun);
    ASSERT_EQ(after.nodes.size(), before.nodes.size());
    EXPECT_EQ(after.num_loops(), 0);
    EXPECT_GE(after.submaps.size() + 1, before.submaps.size());
    const Pose2 start = after.nodes.begin()->second.local_pose *
                        before.nodes.begin()->second.local_pose.Inverse();
    for (const auto& node : before.nodes) {
      const Pose2 error = Between(start * node.second.local_pose,
                                  after.nodes.at(node.first).local_pose);
      EXPECT_LT(error.translation().norm(), 0.25);
    }
  }
}

// The same map as if the gravity alignment had turned by `rate` rad per node
// about the vertical axis, as in Cartographer's maps.
io::Pbstream TurnAlignment(io::Pbstream pbstream, const double rate) {
  double yaw = 0.;
  for (auto& record : pbstream.nodes) {
    auto data = cartographer::mapping::FromProto(record.node_data());
    const auto turn = cartographer::transform::Rigid3d::Rotation(
        Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    data.gravity_alignment = turn.rotation() * data.gravity_alignment;
    data.filtered_gravity_aligned_point_cloud =
        cartographer::sensor::TransformPointCloud(
            data.filtered_gravity_aligned_point_cloud, turn.cast<float>());
    *record.mutable_node_data() = cartographer::mapping::ToProto(data);
    yaw += rate;
  }
  return pbstream;
}

TEST_F(LocalRerunTest, ANodeThatTheGraphLacksKeepsItsLocalPose) {
  evaluation::MapGraph graph = evaluation::MakeMapGraph(*room_);
  const auto lacking = graph.nodes.begin()->first;
  graph.nodes.erase(lacking);
  const MotionChain chain = GlobalChain(*room_, graph);
  EXPECT_EQ(chain.size(), room_->nodes.size());
  EXPECT_EQ(chain.at(lacking).x, LocalChain(*room_).at(lacking).x);
  EXPECT_EQ(chain.rbegin()->second.x,
            graph.nodes.rbegin()->second.global_pose.x);
}

TEST_F(LocalRerunTest, AnyGravityAlignmentGivesTheSameLocalSlam) {
  const io::Pbstream turned = TurnAlignment(*room_, 0.3);
  for (const NodeMatching matching :
       {NodeMatching::kFrontEnd, NodeMatching::kRecordedOdometry,
        NodeMatching::kNone}) {
    std::vector<evaluation::MapGraph> graphs;
    for (const io::Pbstream* const map :
         {static_cast<const io::Pbstream*>(room_), &turned}) {
      const auto rerun =
          RerunLocalSlam(*map, OdometryChain(*map), matching, Options());
      ASSERT_TRUE(rerun.ok()) << rerun.status();
      graphs.push_back(evaluation::MakeMapGraph(*rerun));
    }
    for (const auto& node : graphs[0].nodes) {
      const Pose2 error = Between(node.second.local_pose,
                                  graphs[1].nodes.at(node.first).local_pose);
      // Clouds are stored to the millimetre.
      EXPECT_LT(error.translation().norm(), 0.01);
      EXPECT_LT(std::abs(error.theta), 0.01);
    }
  }
}

TEST_F(LocalRerunTest, RecordedOdometryFollowsALostTurn) {
  // Local SLAM has turned half a radian too far before one node.
  io::Pbstream lost = TurnAlignment(*room_, 0.1);
  const MotionChain right = LocalChain(lost);
  const size_t node = lost.nodes.size() / 2;
  const Pose2 pivot = right.at({0, lost.nodes[node].node_id().node_index()});
  const Pose2 turn = pivot * Pose2(0., 0., 0.5) * pivot.Inverse();
  for (size_t i = node; i < lost.nodes.size(); ++i) {
    auto* const data = lost.nodes[i].mutable_node_data();
    *data->mutable_local_pose() = cartographer::transform::ToProto(
        evaluation::ToHostPose(turn) *
        cartographer::transform::ToRigid3(data->local_pose()));
  }
  const auto rerun = RerunLocalSlam(lost, LocalChain(lost),
                                    NodeMatching::kRecordedOdometry, Options());
  ASSERT_TRUE(rerun.ok()) << rerun.status();
  const evaluation::MapGraph after = evaluation::MakeMapGraph(*rerun);
  const Pose2 start =
      after.nodes.begin()->second.local_pose * right.begin()->second.Inverse();
  for (const auto& entry : right) {
    const Pose2 error =
        Between(start * entry.second, after.nodes.at(entry.first).local_pose);
    EXPECT_LT(error.translation().norm(), 0.25);
    EXPECT_LT(std::abs(error.theta), 0.1);
  }
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
