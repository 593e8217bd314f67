// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A configuration file of the commands: Lua code that returns
//   { map_builder = MAP_BUILDER, trajectory_builder = TRAJECTORY_BUILDER }
// and optionally two more kinds of keys:
//   sensors = { use_odometry = true, odometry_source = "auto",
//               use_recorded_imu = true, min_range = 0., max_range = 80.,
//               tracking_frame = "base_link" }
//     all optional: which data of a recording is used. Ranges outside the limits
//     (metres) are dropped before local SLAM. With use_recorded_imu the IMU of a
//     recording that has one is used (levelled, see io/imu_levelling.h) even if
//     TRAJECTORY_BUILDER_2D.use_imu_data is false.
//   the keys of a ROS node's file (map_frame, num_laser_scans, ...): such files
//     can be used unchanged. Of these only use_odometry and tracking_frame have
//     an effect here.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_SLAM_CONFIGURATION_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_SLAM_CONFIGURATION_H_

#include <limits>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer_ext {
namespace evaluation {

struct SensorSettings {
  bool use_odometry = true;
  bool use_recorded_imu = false;
  // For CARMEN logs, see io::SensorSourceOptions.
  std::string odometry_source = "auto";
  double min_range = 0.;                                       // metres
  double max_range = std::numeric_limits<double>::infinity();  // metres
  std::string tracking_frame = "base_link";
};

struct SlamConfiguration {
  std::string name;  // of the file
  cartographer::mapping::proto::MapBuilderOptions map_builder_options;
  cartographer::mapping::proto::TrajectoryBuilderOptions
      trajectory_builder_options;
  SensorSettings sensors;
  // Values that are unlikely to be intended.
  std::vector<std::string> warnings;
};

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
