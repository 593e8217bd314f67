// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/motion_chain.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace repair {
namespace {

class MotionChainTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_ = new io::Pbstream(
        test::MakeRoomMap(testing::TempDir() + "/motion_chain_test.pbstream"));
  }
  static void TearDownTestSuite() { delete room_; }

  static io::Pbstream* room_;
};

io::Pbstream* MotionChainTest::room_ = nullptr;

TEST_F(MotionChainTest, TheWheelsReplaceALostTurn) {
  // Local SLAM turns half a radian too far before one node.
  io::Pbstream lost = *room_;
  const size_t node = lost.nodes.size() / 2;
  const MotionChain right = LocalChain(lost);
  const auto id = [&](const size_t i) {
    return evaluation::GraphId{0, lost.nodes[i].node_id().node_index()};
  };
  const Pose2 pivot = right.at(id(node));
  const Pose2 turn = pivot * Pose2(0., 0., 0.5) * pivot.Inverse();
  for (size_t i = node; i < lost.nodes.size(); ++i) {
    const Pose2 pose = turn * right.at(id(i));
    auto* const proto = lost.nodes[i].mutable_node_data();
    *proto->mutable_local_pose() = cartographer::transform::ToProto(
        cartographer::transform::Embed3D(cartographer::transform::Rigid2d(
            Eigen::Vector2d(pose.x, pose.y), pose.theta)));
  }
  const MotionChain mixed = MixedChain(lost);
  ASSERT_FALSE(mixed.empty());
  // The room's odometry is exact.
  const auto graph = evaluation::MakeMapGraph(lost);
  const auto truth = [&](const size_t i) {
    return test::RoomSource::TruePose(static_cast<int>(
        (graph.nodes.at(id(i)).time - test::RoomSource::kStart) /
        test::RoomSource::kStep));
  };
  const Pose2 error =
      Between(Between(truth(node - 1), truth(node)),
              Between(mixed.at(id(node - 1)), mixed.at(id(node))));
  EXPECT_LT(std::abs(error.theta), 1e-3);
  EXPECT_LT(error.translation().norm(), 1e-3);
}

TEST_F(MotionChainTest, OdometryThatFreezesAndCatchesUpIsNotFollowed) {
  io::Pbstream frozen = *room_;
  const size_t count = frozen.odometry_data.size();
  const size_t end = count / 2;
  ASSERT_GT(count, 20u);
  // Some two seconds without motion, then one step that makes up for it.
  const auto seconds = [&](const size_t i) {
    return io::ToSeconds(evaluation::FromHostTicks(
        frozen.odometry_data[i].odometry_data().timestamp()));
  };
  size_t begin = end;
  while (begin > 0 && seconds(end) - seconds(begin) < 2.) --begin;
  for (size_t i = begin; i < end; ++i) {
    *frozen.odometry_data[i].mutable_odometry_data()->mutable_pose() =
        frozen.odometry_data[begin].odometry_data().pose();
  }
  const MotionChain local = LocalChain(frozen);
  double largest = 0.;
  const MotionChain wheels = OdometryChain(frozen);
  const MotionChain mixed = MixedChain(frozen);
  ASSERT_EQ(mixed.size(), local.size());
  for (auto to = std::next(local.begin()); to != local.end(); ++to) {
    const evaluation::GraphId from = std::prev(to)->first;
    const Pose2 expected = Between(local.at(from), to->second);
    const Pose2 error =
        Between(expected, Between(mixed.at(from), mixed.at(to->first)));
    EXPECT_LT(error.translation().norm(), 1e-6);
    EXPECT_LT(std::abs(error.theta), 1e-6);
    largest = std::max(largest, Between(expected, Between(wheels.at(from),
                                                          wheels.at(to->first)))
                                    .translation()
                                    .norm());
  }
  EXPECT_GT(largest, 0.3);  // the wheels did freeze
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
