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

using evaluation::GraphId;

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
        RerunLocalSlam(*room_, LocalChain(*room_), matching, false, Options());
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

// Turns the gravity alignment of a node about the vertical axis.
void TurnAlignment(const double angle,
                   cartographer::mapping::proto::Node* const record) {
  auto data = cartographer::mapping::FromProto(record->node_data());
  const auto turn = cartographer::transform::Rigid3d::Rotation(
      Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  data.gravity_alignment = turn.rotation() * data.gravity_alignment;
  data.filtered_gravity_aligned_point_cloud =
      cartographer::sensor::TransformPointCloud(
          data.filtered_gravity_aligned_point_cloud, turn.cast<float>());
  *record->mutable_node_data() = cartographer::mapping::ToProto(data);
}

// The same map as if the gravity alignment had turned by `rate` rad per node
// about the vertical axis, as in Cartographer's maps.
io::Pbstream TurnAlignments(io::Pbstream pbstream, const double rate) {
  double yaw = 0.;
  for (auto& record : pbstream.nodes) {
    TurnAlignment(yaw, &record);
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
  const io::Pbstream turned = TurnAlignments(*room_, 0.3);
  for (const NodeMatching matching :
       {NodeMatching::kFrontEnd, NodeMatching::kRecordedOdometry,
        NodeMatching::kNone}) {
    std::vector<evaluation::MapGraph> graphs;
    for (const io::Pbstream* const map :
         {static_cast<const io::Pbstream*>(room_), &turned}) {
      const auto rerun =
          RerunLocalSlam(*map, OdometryChain(*map), matching, false, Options());
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

// Local SLAM has turned too far by `angle` before the node in the middle.
void TurnTooFar(const double angle, io::Pbstream* const pbstream) {
  const size_t node = pbstream->nodes.size() / 2;
  const Pose2 pivot = LocalChain(*pbstream).at(
      {0, pbstream->nodes[node].node_id().node_index()});
  const Pose2 turn = pivot * Pose2(0., 0., angle) * pivot.Inverse();
  for (size_t i = node; i < pbstream->nodes.size(); ++i) {
    auto* const data = pbstream->nodes[i].mutable_node_data();
    *data->mutable_local_pose() = cartographer::transform::ToProto(
        evaluation::ToHostPose(turn) *
        cartographer::transform::ToRigid3(data->local_pose()));
  }
}

TEST_F(LocalRerunTest, RecordedOdometryFollowsALostTurn) {
  io::Pbstream lost = TurnAlignments(*room_, 0.1);
  const MotionChain right = LocalChain(lost);
  TurnTooFar(0.5, &lost);
  const auto rerun =
      RerunLocalSlam(lost, LocalChain(lost), NodeMatching::kRecordedOdometry,
                     false, Options());
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

// As if local SLAM had used an IMU that turned along `chain`.
void AddGyroscope(const MotionChain& chain, io::Pbstream* const pbstream) {
  auto& options = *pbstream->options.mutable_options_with_sensor_ids(0)
                       ->mutable_trajectory_builder_options();
  options.mutable_trajectory_builder_2d_options()->set_use_imu_data(true);
  for (auto& record : pbstream->nodes) {
    const double aligned =
        cartographer::transform::GetYaw(cartographer::transform::ToEigen(
            record.node_data().gravity_alignment()));
    TurnAlignment(chain.at({0, record.node_id().node_index()}).theta - aligned,
                  &record);
  }
}

// From the middle of the run on, the room is round, so that no scan tells the
// heading, and the stored poses turn by 0.03 rad too much at each node.
io::Pbstream DriftInARoundRoom(io::Pbstream pbstream) {
  cartographer::sensor::PointCloud circle;
  for (int i = 0; i < 90; ++i) {
    const float angle = 2. * kPi * i / 90.;
    circle.push_back({{3.f * std::cos(angle), 3.f * std::sin(angle), 0.f}});
  }
  const MotionChain right = LocalChain(pbstream);
  Pose2 pose;
  for (size_t i = 0; i < pbstream.nodes.size(); ++i) {
    const GraphId id = {0, pbstream.nodes[i].node_id().node_index()};
    const bool is_round = i >= pbstream.nodes.size() / 2;
    if (i == 0) {
      pose = right.at(id);
    } else {
      const GraphId last = {0, pbstream.nodes[i - 1].node_id().node_index()};
      pose = pose * Between(right.at(last), right.at(id)) *
             Pose2(0., 0., is_round ? 0.03 : 0.);
    }
    auto data = cartographer::mapping::FromProto(pbstream.nodes[i].node_data());
    if (is_round) data.filtered_gravity_aligned_point_cloud = circle;
    data.local_pose = evaluation::ToHostPose(pose);
    *pbstream.nodes[i].mutable_node_data() =
        cartographer::mapping::ToProto(data);
  }
  return pbstream;
}

TEST_F(LocalRerunTest, TheStoredGyroscopeHoldsTheHeading) {
  const MotionChain right = LocalChain(*room_);
  io::Pbstream lost = DriftInARoundRoom(*room_);
  lost.odometry_data.clear();
  AddGyroscope(right, &lost);
  const auto slam =
      test::RoomConfiguration("include \"front_end_default.lua\"\n");
  const auto& local =
      slam.trajectory_builder_options.trajectory_builder_2d_options();
  double errors[2];
  for (const bool use_gyroscope : {false, true}) {
    const auto rerun =
        RerunLocalSlam(lost, LocalChain(lost), NodeMatching::kFrontEnd,
                       use_gyroscope, OptionsForClouds(local, local));
    ASSERT_TRUE(rerun.ok()) << rerun.status();
    const evaluation::MapGraph after = evaluation::MakeMapGraph(*rerun);
    const Pose2 start = after.nodes.begin()->second.local_pose *
                        right.begin()->second.Inverse();
    errors[use_gyroscope] = 0.;
    for (const auto& entry : right) {
      const Pose2 error =
          Between(start * entry.second, after.nodes.at(entry.first).local_pose);
      errors[use_gyroscope] =
          std::max(errors[use_gyroscope], std::abs(error.theta));
    }
  }
  EXPECT_GT(errors[false], 0.5);
  EXPECT_LT(errors[true], 0.1);
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
