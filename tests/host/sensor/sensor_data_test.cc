// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/fixed_frame_pose_data.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/landmark_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace sensor {
namespace {

const transform::Rigid3d kPose({1., 2., 3.},
                               transform::RollPitchYaw(0.1, 0.2, 0.3));

void ExpectSame(const transform::Rigid3d& a, const transform::Rigid3d& b) {
  EXPECT_EQ(a.translation(), b.translation());
  EXPECT_EQ(a.rotation().coeffs(), b.rotation().coeffs());
}

TEST(SensorDataTest, Imu) {
  const ImuData data{common::FromUniversal(5), {1., 2., 3.}, {4., 5., 6.}};
  const ImuData back = FromProto(ToProto(data));
  EXPECT_EQ(back.time, data.time);
  EXPECT_EQ(back.linear_acceleration, data.linear_acceleration);
  EXPECT_EQ(back.angular_velocity, data.angular_velocity);
}

TEST(SensorDataTest, Odometry) {
  const OdometryData back =
      FromProto(ToProto(OdometryData{common::FromUniversal(6), kPose}));
  EXPECT_EQ(back.time, common::FromUniversal(6));
  ExpectSame(back.pose, kPose);
}

TEST(SensorDataTest, FixedFramePose) {
  const FixedFramePoseData with =
      FromProto(ToProto(FixedFramePoseData{common::FromUniversal(7), kPose}));
  ASSERT_TRUE(with.pose.has_value());
  ExpectSame(*with.pose, kPose);
  const FixedFramePoseData without = FromProto(
      ToProto(FixedFramePoseData{common::FromUniversal(8), absl::nullopt}));
  EXPECT_FALSE(without.pose.has_value());
  EXPECT_EQ(without.time, common::FromUniversal(8));
}

TEST(SensorDataTest, Landmark) {
  const LandmarkData back = FromProto(ToProto(LandmarkData{
      common::FromUniversal(9), {LandmarkObservation{"door", kPose, 2., 3.}}}));
  EXPECT_EQ(back.time, common::FromUniversal(9));
  ASSERT_EQ(back.landmark_observations.size(), 1);
  const LandmarkObservation& seen = back.landmark_observations[0];
  EXPECT_EQ(seen.id, "door");
  ExpectSame(seen.landmark_to_tracking_transform, kPose);
  EXPECT_EQ(seen.translation_weight, 2.);
  EXPECT_EQ(seen.rotation_weight, 3.);
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
