// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/dropin/pose_conversion.h"

#include "Eigen/Geometry"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;

TEST(PoseConversionTest, HeadingIsWrappedOrKept) {
  const Rigid2d pose({1., 2.}, 3. * kPi / 2.);
  EXPECT_NEAR(ToPose2(pose).theta, -kPi / 2., 1e-12);
  EXPECT_EQ(ToUnwrappedPose2(pose).theta, 3. * kPi / 2.);
  EXPECT_EQ(ToPose2(pose).x, 1.);
  EXPECT_EQ(ToUnwrappedPose2(pose).y, 2.);
}

TEST(PoseConversionTest, RoundTripKeepsTheBits) {
  const Pose2 pose(-0.1, 0.7, 9.3);
  const Pose2 back = ToUnwrappedPose2(ToRigid2d(pose));
  EXPECT_EQ(back.x, pose.x);
  EXPECT_EQ(back.y, pose.y);
  EXPECT_EQ(back.theta, pose.theta);
}

TEST(PoseConversionTest, YawOfASpatialPose) {
  const Rigid3d pose(Eigen::Vector3d(1., 2., 3.),
                     Eigen::AngleAxisd(-2.5, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
  const Pose2 planar = ToPose2(pose);
  EXPECT_EQ(planar.x, 1.);
  EXPECT_EQ(planar.y, 2.);
  EXPECT_NEAR(planar.theta, -2.5, 1e-12);
}

}  // namespace
}  // namespace cartographer_ext
