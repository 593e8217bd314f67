// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/front_end_options.h"

namespace cartographer_ext {
namespace front_end {
namespace {

OdometryNoiseOptions ToOdometryNoiseOptions(
    const proto::FrontEndOptions::Odometry& from) {
  OdometryNoiseOptions to;
  to.translation = from.translation_noise();
  to.translation_per_metre = from.translation_noise_per_metre();
  to.rotation = from.rotation_noise();
  to.rotation_per_radian = from.rotation_noise_per_radian();
  to.rotation_per_metre = from.rotation_noise_per_metre();
  to.max_extrapolation = from.max_extrapolation();
  return to;
}

OdometryCalibrationOptions ToOdometryCalibrationOptions(
    const proto::FrontEndOptions::Calibration& from) {
  OdometryCalibrationOptions to;
  to.estimate_odometry_scale = from.estimate_way();
  to.estimate_rotation = from.estimate_turn();
  to.translation_scale = from.way_scale();
  to.translation_scale_sigma = from.way_sigma();
  to.rotation_scale = from.turn_scale();
  to.rotation_scale_sigma = from.turn_sigma();
  to.rotation_per_metre = from.turn_per_metre();
  to.rotation_per_metre_sigma = from.turn_per_metre_sigma();
  to.max_deviation = from.max_deviation();
  return to;
}

OdometryCheckOptions ToOdometryCheckOptions(
    const proto::FrontEndOptions::FaultCheck& from) {
  OdometryCheckOptions to;
  to.enabled = from.enabled();
  to.window = from.window();
  to.gate = from.gate();
  to.translation_noise = from.translation_noise();
  to.rotation_noise = from.rotation_noise();
  to.translation_noise_per_metre = from.translation_noise_per_metre();
  to.rotation_noise_per_radian = from.rotation_noise_per_radian();
  to.jump_distance = from.jump_distance();
  to.jump_angle = from.jump_angle();
  to.max_acceleration = from.max_acceleration();
  return to;
}

ImuPredictorOptions ToImuPredictorOptions(
    const proto::FrontEndOptions::Imu& from) {
  ImuPredictorOptions to;
  to.enabled = from.enabled();
  to.noise.acceleration_density = from.acceleration_noise();
  to.noise.yaw_rate_density = from.yaw_rate_noise();
  to.yaw_rate_bias_noise = from.yaw_rate_bias_noise();
  to.acceleration_bias_noise = from.acceleration_bias_noise();
  to.stationary_time = from.standing_time();
  return to;
}

}  // namespace

MotionPredictorOptions ToMotionPredictorOptions(
    const proto::FrontEndOptions& options) {
  MotionPredictorOptions to;
  to.use_odometry = options.odometry().enabled();
  to.odometry = ToOdometryNoiseOptions(options.odometry());
  to.time_offset.estimate = options.time_offset().estimate();
  to.time_offset.initial = options.time_offset().initial();
  to.time_offset.minimum = options.time_offset().minimum();
  to.time_offset.maximum = options.time_offset().maximum();
  to.calibration = ToOdometryCalibrationOptions(options.calibration());
  to.constant_velocity.speed_noise = options.constant_velocity().speed_noise();
  to.constant_velocity.turn_rate_noise =
      options.constant_velocity().turn_rate_noise();
  to.constant_velocity.acceleration_noise =
      options.constant_velocity().acceleration_noise();
  to.constant_velocity.turn_acceleration_noise =
      options.constant_velocity().turn_acceleration_noise();
  to.constant_velocity.turn_time = options.constant_velocity().turn_time();
  to.constant_velocity.max_time = options.constant_velocity().max_time();
  to.check = ToOdometryCheckOptions(options.fault_check());
  to.imu = ToImuPredictorOptions(options.imu());
  return to;
}

AdaptiveFeatureOptions ToAdaptiveFeatureOptions(
    const proto::FrontEndOptions& options) {
  AdaptiveFeatureOptions to;
  to.num_neighbors = options.features().num_neighbors();
  to.distance_weighted = options.features().distance_weighted();
  to.min_points = options.features().min_points();
  return to;
}

WallFillingOptions ToWallFillingOptions(const proto::FrontEndOptions& options,
                                        const double resolution) {
  WallFillingOptions to;
  to.spacing = resolution;
  to.max_gap =
      options.wall_filling().enabled() ? options.wall_filling().max_gap() : 0.;
  to.tolerance = options.wall_filling().tolerance();
  return to;
}

}  // namespace front_end
}  // namespace cartographer_ext
