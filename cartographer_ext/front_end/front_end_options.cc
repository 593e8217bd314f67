// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/front_end_options.h"

namespace cartographer_ext {
namespace front_end {

FrontEndOptions ToFrontEndOptions(const proto::FrontEndOptions& message) {
  FrontEndOptions options;
  MotionPredictorOptions* const prediction = &options.prediction;
  prediction->use_odometry = message.odometry().enabled();
  prediction->odometry.translation = message.odometry().translation_noise();
  prediction->odometry.translation_per_metre =
      message.odometry().translation_noise_per_metre();
  prediction->time_offset.estimate = message.time_offset().estimate();
  prediction->time_offset.initial = message.time_offset().initial();
  prediction->check.enabled = message.fault_check().enabled();
  prediction->check.max_acceleration = message.fault_check().max_acceleration();
  prediction->calibration.estimate_odometry_scale =
      message.calibration().estimate_odometry_scale();
  prediction->calibration.estimate_rotation =
      message.calibration().estimate_rotation();
  prediction->calibration.translation_scale =
      message.calibration().odometry_scale();
  prediction->imu.enabled = message.imu().enabled();
  options.search.enabled = message.search().enabled();
  options.log_directory = message.log().directory();
  options.fill_walls = message.wall_filling().enabled();
  options.smooth_ranges = message.range_smoothing().enabled();
  options.estimate_beam_order = message.beam_order().estimate();
  options.match_features_only = message.paper_mode().adaptive_features();
  return options;
}

WallFillingOptions WallFillingFor(const FrontEndOptions& options,
                                  const double resolution) {
  WallFillingOptions filling = options.wall_filling;
  filling.spacing = resolution;
  if (!options.fill_walls) filling.max_gap = 0.;
  return filling;
}

}  // namespace front_end
}  // namespace cartographer_ext
