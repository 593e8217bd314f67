// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A configuration file of the commands: Lua code that returns
//   { map_builder = MAP_BUILDER, trajectory_builder = TRAJECTORY_BUILDER }
// and optionally two more kinds of keys:
//   sensors = { use_odometry = true, use_recorded_imu = true, ... }
//     which data of a recording is used, see sensor_settings.h.
//   the keys of a ROS node's file (map_frame, num_laser_scans, ...): such files
//     can be used unchanged. Of these only use_odometry and tracking_frame have
//     an effect here.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_SLAM_CONFIGURATION_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_SLAM_CONFIGURATION_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "cartographer_ext/configuration/sensor_settings.h"

namespace cartographer_ext {
namespace evaluation {

struct SlamConfiguration {
  std::string name;  // of the file
  cartographer::mapping::proto::MapBuilderOptions map_builder_options;
  cartographer::mapping::proto::TrajectoryBuilderOptions
      trajectory_builder_options;
  SensorSettings sensors;
  // Values that are unlikely to be intended.
  std::vector<std::string> warnings;
};

// Whether local SLAM gets the IMU of a recording that has one.
bool UsesImu(const SlamConfiguration& configuration);

// Reads `basename` and the files it includes from the directories, searched in
// this order. Everything for which the host would abort becomes an error that
// names the file and the key, as do invalid values (option_ranges.h), code that
// does not terminate or takes too much memory, and os.exit; fatal_guard.h
// states the requirements for the caller.
absl::StatusOr<SlamConfiguration> LoadSlamConfiguration(
    const std::vector<std::string>& directories, const std::string& basename);

// The same for given Lua code, named `name` in messages.
absl::StatusOr<SlamConfiguration> ParseSlamConfiguration(
    const std::vector<std::string>& directories, const std::string& name,
    const std::string& code);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_SLAM_CONFIGURATION_H_
