// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/front_end_options.h"

#include <map>
#include <string>

#include "gtest/gtest.h"
#include "tests/options/every_key.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// What the keys set.
std::map<std::string, double> Values(const FrontEndOptions& options) {
  const MotionPredictorOptions& prediction = options.prediction;
  return {
      {"odometry.enabled", prediction.use_odometry},
      {"odometry.translation_noise", prediction.odometry.translation},
      {"odometry.translation_noise_per_metre",
       prediction.odometry.translation_per_metre},
      {"time_offset.estimate", prediction.time_offset.estimate},
      {"time_offset.initial", prediction.time_offset.initial},
      {"fault_check.enabled", prediction.check.enabled},
      {"fault_check.max_acceleration", prediction.check.max_acceleration},
      {"imu.enabled", prediction.imu.enabled},
      {"search.enabled", options.search.enabled},
      {"wall_filling.enabled", WallFillingFor(options, 0.05).max_gap > 0.},
      {"range_smoothing.enabled", options.smooth_ranges},
      {"beam_order.estimate", options.estimate_beam_order},
      {"calibration.estimate_odometry_scale",
       prediction.calibration.estimate_odometry_scale},
      {"calibration.estimate_rotation",
       prediction.calibration.estimate_rotation},
      {"calibration.odometry_scale", prediction.calibration.translation_scale},
      {"paper_mode.adaptive_features", options.match_features_only},
      {"log.directory", static_cast<double>(options.log_directory.size())},
  };
}

options::test::KeyValues ValuesOfMessage(
    const proto::FrontEndOptions& message) {
  return Values(ToFrontEndOptions(message));
}

// The defaults that are written beside the keys are those of the parts.
TEST(FrontEndOptionsTest, DefaultsAreThoseOfTheParts) {
  options::test::ExpectSameDefaults<proto::FrontEndOptions>(
      ValuesOfMessage, Values(FrontEndOptions()));
}

TEST(FrontEndOptionsTest, EveryKeyHasAnEffect) {
  options::test::ExpectEveryKeyHasAnEffect<proto::FrontEndOptions>(
      ValuesOfMessage);
}

TEST(FrontEndOptionsTest, WallsAreFilledAtTheResolutionOfTheGrid) {
  FrontEndOptions options;
  EXPECT_EQ(WallFillingFor(options, 0.02).spacing, 0.02);
  EXPECT_EQ(WallFillingFor(options, 0.02).max_gap, 1.);
  options.fill_walls = false;
  EXPECT_EQ(WallFillingFor(options, 0.02).max_gap, 0.);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
