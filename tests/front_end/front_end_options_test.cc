// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/front_end_options.h"

#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/options/option_description.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

proto::FrontEndOptions Defaults() {
  proto::FrontEndOptions message;
  options::SetDefaults(&message);
  return message;
}

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
      {"calibration.estimate_odometry_scale",
       prediction.calibration.estimate_odometry_scale},
      {"calibration.estimate_rotation",
       prediction.calibration.estimate_rotation},
      {"calibration.odometry_scale", prediction.calibration.translation_scale},
      {"paper_mode.adaptive_features", options.match_features_only},
      {"log.directory", static_cast<double>(options.log_directory.size())},
  };
}

// The defaults that are written beside the keys are those of the parts.
TEST(FrontEndOptionsTest, DefaultsAreThoseOfTheParts) {
  const std::map<std::string, double> shipped =
      Values(ToFrontEndOptions(Defaults()));
  EXPECT_EQ(shipped, Values(FrontEndOptions()));
  std::vector<std::string> compared, keys;
  for (const auto& value : shipped) compared.push_back(value.first);
  for (const auto& option : options::Describe(Defaults())) {
    keys.push_back(option.key);
  }
  EXPECT_THAT(keys, testing::UnorderedElementsAreArray(compared));
}

TEST(FrontEndOptionsTest, EveryKeyHasAnEffect) {
  const auto& block = *proto::FrontEndOptions::descriptor();
  int num_keys = 0;
  for (int i = 0; i < block.field_count(); ++i) {
    const auto* const table = block.field(i)->message_type();
    if (table == nullptr) continue;
    for (int k = 0; k < table->field_count(); ++k, ++num_keys) {
      const auto* const field = table->field(k);
      std::vector<double> read;
      for (const int value : {0, 7}) {
        proto::FrontEndOptions message = Defaults();
        auto* const target =
            message.GetReflection()->MutableMessage(&message, block.field(i));
        if (field->cpp_type() ==
            google::protobuf::FieldDescriptor::CPPTYPE_BOOL) {
          target->GetReflection()->SetBool(target, field, value > 0);
        } else if (field->cpp_type() ==
                   google::protobuf::FieldDescriptor::CPPTYPE_STRING) {
          target->GetReflection()->SetString(target, field,
                                             std::string(value, 'x'));
        } else {
          target->GetReflection()->SetDouble(target, field, value);
        }
        read.push_back(Values(ToFrontEndOptions(message))
                           .at(block.field(i)->name() + "." + field->name()));
      }
      EXPECT_NE(read[0], read[1]) << field->full_name();
    }
  }
  EXPECT_EQ(num_keys, static_cast<int>(options::Describe(Defaults()).size()));
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
