// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/scan_trajectory.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

StampedPose Scan(io::TimeNs time, const Pose2& pose) {
  return {time, ToIsometry(pose)};
}

NodePoses Node(io::TimeNs time, const Pose2& local, const Pose2& global) {
  NodePoses node;
  node.time = time;
  node.local_pose = ToIsometry(local);
  node.global_pose = ToIsometry(global);
  return node;
}

void ExpectPose(const StampedPose& actual, const Pose2& expected) {
  const Pose2 pose = ToPose2(actual.pose);
  EXPECT_NEAR(pose.x, expected.x, 1e-12);
  EXPECT_NEAR(pose.y, expected.y, 1e-12);
  EXPECT_NEAR(pose.theta, expected.theta, 1e-12);
}

TEST(ScanTrajectoryTest, MeetsTheNodesAndBlendsBetweenThem) {
  // The optimisation moved the first node by 1 m in y and the second by 3 m.
  const auto poses =
      GlobalScanPoses({Scan(0, Pose2(0., 0., 0.)), Scan(5, Pose2(2., 0., 0.)),
                       Scan(10, Pose2(4., 0., 0.))},
                      {Node(0, Pose2(0., 0., 0.), Pose2(0., 1., 0.)),
                       Node(10, Pose2(4., 0., 0.), Pose2(4., 3., 0.))});
  ASSERT_EQ(poses.size(), 3u);
  ExpectPose(poses[0], Pose2(0., 1., 0.));
  ExpectPose(poses[1], Pose2(2., 2., 0.));
  ExpectPose(poses[2], Pose2(4., 3., 0.));
  EXPECT_EQ(poses[1].time, 5);
}

TEST(ScanTrajectoryTest, AStandingRobotStaysWhereTheScansSay) {
  // Between the nodes the robot waits for most of the time and then jumps to
  // the second node's place; interpolating in time would say (2, 0).
  const auto poses =
      GlobalScanPoses({Scan(5, Pose2(0., 0., 0.))},
                      {Node(0, Pose2(0., 0., 0.), Pose2(0., 0., 0.)),
                       Node(10, Pose2(4., 0., 0.), Pose2(4., 0., 0.))});
  ASSERT_EQ(poses.size(), 1u);
  ExpectPose(poses[0], Pose2(0., 0., 0.));
}

TEST(ScanTrajectoryTest, AtTheEndsOneNodeLeads) {
  const auto poses =
      GlobalScanPoses({Scan(0, Pose2(0., 0., 0.)), Scan(20, Pose2(3., 0., 0.))},
                      {Node(10, Pose2(1., 0., 0.), Pose2(5., 5., kPi / 2.))});
  ASSERT_EQ(poses.size(), 2u);
  ExpectPose(poses[0], Pose2(5., 4., kPi / 2.));
  ExpectPose(poses[1], Pose2(5., 7., kPi / 2.));
}

TEST(ScanTrajectoryTest, WithoutNodesThereIsNothing) {
  EXPECT_TRUE(GlobalScanPoses({Scan(0, Pose2())}, {}).empty());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
