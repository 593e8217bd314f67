// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/sensor_settings.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::common::ConfigurationFileResolver;
using cartographer::common::LuaParameterDictionary;

SensorSettings Read(const std::string& table) {
  LuaParameterDictionary dictionary(
      "return { " + table + " }",
      std::make_unique<ConfigurationFileResolver>(std::vector<std::string>()));
  // Other than every default.
  SensorSettings settings;
  settings.use_odometry = false;
  settings.use_recorded_imu = true;
  settings.odometry_source = "scan";
  settings.min_range = 1.;
  settings.max_range = 2.;
  settings.tracking_frame = "imu";
  ReadSensorSettings(&dictionary, &settings);
  return settings;
}

// As in Lua.
std::string Default(const options::OptionDescription& setting) {
  if (setting.default_value == "inf") return "math.huge";
  const bool is_quoted = setting.type == "text" || setting.type == "choice";
  const std::string quote = is_quoted ? "\"" : "";
  return quote + setting.default_value + quote;
}

TEST(SensorSettingsTest, EveryKeyIsDescribedWithItsDefault) {
  std::string table;
  for (const auto& setting : DescribeSensorSettings()) {
    EXPECT_FALSE(setting.documentation.empty()) << setting.key;
    table += setting.key + " = " + Default(setting) + ", ";
  }
  const SensorSettings settings = Read(table);
  const SensorSettings expected;
  EXPECT_EQ(settings.use_odometry, expected.use_odometry);
  EXPECT_EQ(settings.use_recorded_imu, expected.use_recorded_imu);
  EXPECT_EQ(settings.odometry_source, expected.odometry_source);
  EXPECT_EQ(settings.min_range, expected.min_range);
  EXPECT_EQ(settings.max_range, expected.max_range);
  EXPECT_EQ(settings.tracking_frame, expected.tracking_frame);
}

TEST(SensorSettingsTest, KeysThatAreAbsentChangeNothing) {
  EXPECT_EQ(Read("max_range = 5").min_range, 1.);
  EXPECT_EQ(Read("max_range = 5").max_range, 5.);
  EXPECT_EQ(Read("min_range = 0.5").tracking_frame, "imu");
}

TEST(SensorSettingsDeathTest, InvalidValues) {
  EXPECT_DEATH(Read("min_range = 0 / 0"), "sensors.min_range");
  EXPECT_DEATH(Read("max_range = 0 / 0"), "sensors.max_range");
  EXPECT_DEATH(Read("odometry_source = \"both?\""),
               "must be one of auto, both, odom, scan");
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
