// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The table `sensors` of a configuration of the commands: which data of a
// recording is used. All keys are optional; docs/options.md lists them.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_SENSOR_SETTINGS_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_SENSOR_SETTINGS_H_

#include <limits>
#include <string>
#include <vector>

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer_ext/options/option_description.h"

namespace cartographer_ext {
namespace evaluation {

struct SensorSettings {
  bool use_odometry = true;
  // The IMU of a recording that has one, levelled (io/imu_levelling.h), even if
  // TRAJECTORY_BUILDER_2D.use_imu_data is false.
  bool use_recorded_imu = false;
  // For CARMEN logs, see io::SensorSourceOptions.
  std::string odometry_source = "auto";
  // Ranges outside the limits are dropped before local SLAM.
  double min_range = 0.;                                       // metres
  double max_range = std::numeric_limits<double>::infinity();  // metres
  std::string tracking_frame = "base_link";
};

// Reads the keys that the table has. Ends the program if a value is invalid.
void ReadSensorSettings(
    cartographer::common::LuaParameterDictionary* dictionary,
    SensorSettings* settings);

// The keys with their defaults, for documents.
std::vector<options::OptionDescription> DescribeSensorSettings();

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_SENSOR_SETTINGS_H_
