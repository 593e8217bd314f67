// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/front_end_options.h"

#include "cartographer_ext/options/option_description.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// The parts are usable without the message; both must mean the same.
TEST(FrontEndOptionsTest, DefaultsOfTheMessageAreThoseOfTheParts) {
  proto::FrontEndOptions message;
  options::SetDefaults(&message);
  const MotionPredictorOptions from_message = ToMotionPredictorOptions(message);
  const MotionPredictorOptions own;
  EXPECT_EQ(from_message.use_odometry, own.use_odometry);
  EXPECT_EQ(from_message.odometry.translation, own.odometry.translation);
  EXPECT_EQ(from_message.odometry.translation_per_metre,
            own.odometry.translation_per_metre);
  EXPECT_EQ(from_message.odometry.rotation, own.odometry.rotation);
  EXPECT_EQ(from_message.odometry.rotation_per_radian,
            own.odometry.rotation_per_radian);
  EXPECT_EQ(from_message.odometry.rotation_per_metre,
            own.odometry.rotation_per_metre);
  EXPECT_EQ(from_message.odometry.max_extrapolation,
            own.odometry.max_extrapolation);
  EXPECT_EQ(from_message.time_offset.estimate, own.time_offset.estimate);
  EXPECT_EQ(from_message.time_offset.initial, own.time_offset.initial);
  EXPECT_EQ(from_message.time_offset.minimum, own.time_offset.minimum);
  EXPECT_EQ(from_message.time_offset.maximum, own.time_offset.maximum);
  EXPECT_EQ(from_message.calibration.estimate_odometry_scale,
            own.calibration.estimate_odometry_scale);
  EXPECT_EQ(from_message.calibration.estimate_rotation,
            own.calibration.estimate_rotation);
  EXPECT_EQ(from_message.calibration.translation_scale,
            own.calibration.translation_scale);
  EXPECT_EQ(from_message.calibration.translation_scale_sigma,
            own.calibration.translation_scale_sigma);
  EXPECT_EQ(from_message.calibration.rotation_scale,
            own.calibration.rotation_scale);
  EXPECT_EQ(from_message.calibration.rotation_scale_sigma,
            own.calibration.rotation_scale_sigma);
  EXPECT_EQ(from_message.calibration.rotation_per_metre,
            own.calibration.rotation_per_metre);
  EXPECT_EQ(from_message.calibration.rotation_per_metre_sigma,
            own.calibration.rotation_per_metre_sigma);
  EXPECT_EQ(from_message.calibration.max_deviation,
            own.calibration.max_deviation);
  EXPECT_EQ(from_message.constant_velocity.speed_noise,
            own.constant_velocity.speed_noise);
  EXPECT_EQ(from_message.constant_velocity.turn_rate_noise,
            own.constant_velocity.turn_rate_noise);
  EXPECT_EQ(from_message.constant_velocity.acceleration_noise,
            own.constant_velocity.acceleration_noise);
  EXPECT_EQ(from_message.constant_velocity.turn_acceleration_noise,
            own.constant_velocity.turn_acceleration_noise);
  EXPECT_EQ(from_message.constant_velocity.turn_time,
            own.constant_velocity.turn_time);
  EXPECT_EQ(from_message.constant_velocity.max_time,
            own.constant_velocity.max_time);
  EXPECT_EQ(from_message.check.enabled, own.check.enabled);
  EXPECT_EQ(from_message.check.window, own.check.window);
  EXPECT_EQ(from_message.check.gate, own.check.gate);
  EXPECT_EQ(from_message.check.translation_noise, own.check.translation_noise);
  EXPECT_EQ(from_message.check.rotation_noise, own.check.rotation_noise);
  EXPECT_EQ(from_message.check.translation_noise_per_metre,
            own.check.translation_noise_per_metre);
  EXPECT_EQ(from_message.check.rotation_noise_per_radian,
            own.check.rotation_noise_per_radian);
  EXPECT_EQ(from_message.check.jump_distance, own.check.jump_distance);
  EXPECT_EQ(from_message.check.jump_angle, own.check.jump_angle);
  EXPECT_EQ(from_message.check.max_acceleration, own.check.max_acceleration);
  EXPECT_EQ(from_message.imu.enabled, own.imu.enabled);
  EXPECT_EQ(from_message.imu.noise.acceleration_density,
            own.imu.noise.acceleration_density);
  EXPECT_EQ(from_message.imu.noise.yaw_rate_density,
            own.imu.noise.yaw_rate_density);
  EXPECT_EQ(from_message.imu.yaw_rate_bias_noise, own.imu.yaw_rate_bias_noise);
  EXPECT_EQ(from_message.imu.acceleration_bias_noise,
            own.imu.acceleration_bias_noise);
  EXPECT_EQ(from_message.imu.stationary_time, own.imu.stationary_time);
}

TEST(FrontEndOptionsTest, ValuesArrive) {
  proto::FrontEndOptions message;
  options::SetDefaults(&message);
  message.mutable_odometry()->set_enabled(false);
  message.mutable_odometry()->set_rotation_noise_per_metre(0.5);
  message.mutable_time_offset()->set_maximum(0.4);
  message.mutable_calibration()->set_estimate_turn(true);
  message.mutable_calibration()->set_way_scale(1.03);
  message.mutable_fault_check()->set_gate(7.);
  message.mutable_imu()->set_standing_time(3.);
  message.mutable_features()->set_num_neighbors(6);
  message.mutable_features()->set_distance_weighted(false);
  message.mutable_features()->set_min_points(33);
  const MotionPredictorOptions options = ToMotionPredictorOptions(message);
  EXPECT_FALSE(options.use_odometry);
  EXPECT_EQ(options.odometry.rotation_per_metre, 0.5);
  EXPECT_EQ(options.time_offset.maximum, 0.4);
  EXPECT_TRUE(options.calibration.estimate_odometry_scale);
  EXPECT_TRUE(options.calibration.estimate_rotation);
  EXPECT_EQ(options.calibration.translation_scale, 1.03);
  EXPECT_EQ(options.check.gate, 7.);
  EXPECT_EQ(options.imu.stationary_time, 3.);
  const AdaptiveFeatureOptions features = ToAdaptiveFeatureOptions(message);
  EXPECT_EQ(features.num_neighbors, 6);
  EXPECT_FALSE(features.distance_weighted);
  EXPECT_EQ(features.min_points, 33);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
