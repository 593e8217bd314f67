// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/sensor_settings.h"

#include <set>

#include "absl/strings/str_join.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::common::LuaParameterDictionary;
using options::OptionDescription;

std::set<std::string> OdometrySources() {
  return {"auto", "scan", "odom", "both"};
}

OptionDescription Key(const std::string& key, const std::string& type,
                      const std::string& default_value,
                      const std::string& range, const std::string& unit,
                      const std::string& documentation) {
  OptionDescription description;
  description.key = key;
  description.type = type;
  description.default_value = default_value;
  description.range = range;
  description.unit = unit;
  description.documentation = documentation;
  return description;
}

}  // namespace

void ReadSensorSettings(LuaParameterDictionary* const dictionary,
                        SensorSettings* const settings) {
  if (dictionary->HasKey("use_odometry")) {
    settings->use_odometry = dictionary->GetBool("use_odometry");
  }
  if (dictionary->HasKey("use_recorded_imu")) {
    settings->use_recorded_imu = dictionary->GetBool("use_recorded_imu");
  }
  if (dictionary->HasKey("odometry_source")) {
    settings->odometry_source = dictionary->GetString("odometry_source");
    const std::set<std::string> known = OdometrySources();
    LOG_IF(FATAL, known.count(settings->odometry_source) == 0)
        << "sensors.odometry_source is \"" << settings->odometry_source
        << "\", must be one of " << absl::StrJoin(known, ", ");
  }
  if (dictionary->HasKey("min_range")) {
    settings->min_range = dictionary->GetDouble("min_range");
    LOG_IF(FATAL, !(settings->min_range >= 0.))
        << "sensors.min_range is " << settings->min_range
        << ", must not be negative";
  }
  if (dictionary->HasKey("max_range")) {
    settings->max_range = dictionary->GetDouble("max_range");
    LOG_IF(FATAL, !(settings->max_range > settings->min_range))
        << "sensors.max_range is " << settings->max_range
        << ", must be above sensors.min_range";
  }
  if (dictionary->HasKey("tracking_frame")) {
    settings->tracking_frame = dictionary->GetString("tracking_frame");
  }
}

std::vector<OptionDescription> DescribeSensorSettings() {
  return {
      Key("use_odometry", "boolean", "true", "", "",
          "Use the odometry of a recording that has some."),
      Key("use_recorded_imu", "boolean", "false", "", "",
          "Use the IMU of a recording that has one, levelled, even if "
          "TRAJECTORY_BUILDER_2D.use_imu_data is false. True in default.lua, "
          "corridor.lua, warehouse.lua and localization.lua."),
      Key("odometry_source", "choice", "auto",
          "one of: " + absl::StrJoin(OdometrySources(), ", "), "",
          "Where a CARMEN log has its odometry: in the lines of the scans, in "
          "lines of its own, or in both. auto: lines of its own where they "
          "cover the run in order, else those of the scans."),
      Key("min_range", "number", "0", ">= 0", "m",
          "Shorter ranges are dropped before local SLAM, as those of the robot "
          "itself."),
      Key("max_range", "number", "inf", "> min_range", "m",
          "Longer ranges are dropped before local SLAM."),
      Key("tracking_frame", "text", "base_link", "", "",
          "Frame of the robot in a bag. For ROS, that of the IMU if one is "
          "used."),
  };
}

}  // namespace evaluation
}  // namespace cartographer_ext
