// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros_frames.h"

#include <string>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;

RosTransform Make(const std::string& parent, const std::string& child, double x,
                  double yaw = 0.) {
  RosTransform transform;
  transform.header.frame = parent;
  transform.child_frame = child;
  transform.pose = Eigen::Isometry3d::Identity();
  transform.pose.translation().x() = x;
  transform.pose.linear() =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return transform;
}

TEST(RosFramesTest, ChainsUpAndDown) {
  RosFrames frames;
  frames.Add(Make("odom", "base", 100.));
  frames.Add(Make("base", "mast", 1., kPi / 2.));
  frames.Add(Make("mast", "laser", 2.));
  frames.Add(Make("base", "imu", -0.5));
  const auto laser = frames.Lookup("base", "laser");
  ASSERT_TRUE(laser.has_value());
  // One ahead, then two to the left, looking left.
  EXPECT_TRUE(
      laser->translation().isApprox(Eigen::Vector3d(1., 2., 0.), 1e-12));
  const auto back = frames.Lookup("laser", "base");
  ASSERT_TRUE(back.has_value());
  EXPECT_TRUE((*laser * *back).matrix().isIdentity(1e-12));
  // Over the common ancestor.
  const auto across = frames.Lookup("imu", "mast");
  ASSERT_TRUE(across.has_value());
  EXPECT_NEAR(across->translation().x(), 1.5, 1e-12);
  EXPECT_TRUE(frames.Lookup("base", "base")->matrix().isIdentity());
  EXPECT_TRUE(frames.Knows("odom"));
  EXPECT_FALSE(frames.Knows("camera"));
  EXPECT_FALSE(frames.Lookup("base", "camera").has_value());
  // Unknown frames coincide with themselves.
  EXPECT_TRUE(frames.Lookup("camera", "camera").has_value());
}

TEST(RosFramesTest, TellsWhatMoves) {
  RosFrames frames;
  frames.Add(Make("odom", "base", 0.));
  frames.Add(Make("odom", "base", 1.));
  frames.Add(Make("base", "turret", 0., 0.));
  frames.Add(Make("base", "turret", 0., 0.1));
  frames.Add(Make("turret", "laser", 0.3));
  frames.Add(Make("turret", "laser", 0.3));
  std::vector<std::string> moving;
  ASSERT_TRUE(frames.Lookup("base", "laser", &moving).has_value());
  EXPECT_THAT(moving, ElementsAre("turret"));  // The first pose is taken.
  EXPECT_NEAR(frames.Lookup("base", "laser")->translation().x(), 0.3, 1e-12);
  moving.clear();
  frames.Lookup("turret", "laser", &moving);
  EXPECT_TRUE(moving.empty());
}

TEST(RosFramesTest, LoopsEnd) {
  RosFrames frames;
  frames.Add(Make("a", "b", 1.));
  frames.Add(Make("b", "a", 1.));
  frames.Add(Make("c", "c", 1.));
  EXPECT_FALSE(frames.Lookup("x", "a").has_value());
  EXPECT_TRUE(frames.Lookup("a", "b").has_value());
  EXPECT_FALSE(frames.Knows("c"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
