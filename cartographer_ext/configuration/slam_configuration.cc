// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/slam_configuration.h"

#include <unistd.h>

#include <memory>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer_ext/configuration/fatal_guard.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/configuration/option_types.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::common::ConfigurationFileResolver;
using cartographer::common::LuaParameterDictionary;
using cartographer::mapping::TrajectoryBuilderInterface;

const char* const kRosStrings[] = {"map_frame", "published_frame",
                                   "odom_frame"};
const char* const kRosBools[] = {
    "provide_odom_frame",    "publish_frame_projected_to_2d",
    "use_pose_extrapolator", "use_nav_sat",
    "use_landmarks",         "publish_to_tf",
    "publish_tracked_pose"};
const char* const kRosNumbers[] = {"num_laser_scans",
                                   "num_multi_echo_laser_scans",
                                   "num_subdivisions_per_laser_scan",
                                   "num_point_clouds",
                                   "lookup_transform_timeout_sec",
                                   "submap_publish_period_sec",
                                   "pose_publish_period_sec",
                                   "trajectory_publish_period_sec",
                                   "rangefinder_sampling_ratio",
                                   "odometry_sampling_ratio",
                                   "fixed_frame_pose_sampling_ratio",
                                   "imu_sampling_ratio",
                                   "landmarks_sampling_ratio"};

// Reads what a ROS node's file has at its top; the dictionary wants every key
// to be read.
void ReadRosKeys(LuaParameterDictionary* const dictionary,
                 SensorSettings* const settings) {
  for (const char* key : kRosStrings) {
    if (dictionary->HasKey(key)) dictionary->GetString(key);
  }
  for (const char* key : kRosBools) {
    if (dictionary->HasKey(key)) dictionary->GetBool(key);
  }
  for (const char* key : kRosNumbers) {
    if (dictionary->HasKey(key)) dictionary->GetDouble(key);
  }
  if (dictionary->HasKey("use_odometry")) {
    settings->use_odometry = dictionary->GetBool("use_odometry");
  }
  if (dictionary->HasKey("tracking_frame")) {
    settings->tracking_frame = dictionary->GetString("tracking_frame");
  }
}

void ReadSensorSettings(LuaParameterDictionary* const dictionary,
                        SensorSettings* const settings) {
  if (dictionary->HasKey("use_odometry")) {
    settings->use_odometry = dictionary->GetBool("use_odometry");
  }
  if (dictionary->HasKey("odometry_source")) {
    settings->odometry_source = dictionary->GetString("odometry_source");
    const std::set<std::string> known = {"auto", "scan", "odom", "both"};
    CHECK(known.count(settings->odometry_source) > 0)
        << "sensors.odometry_source is \"" << settings->odometry_source
        << "\", must be one of " << absl::StrJoin(known, ", ");
  }
  if (dictionary->HasKey("min_range")) {
    settings->min_range = dictionary->GetDouble("min_range");
    CHECK_GE(settings->min_range, 0.)
        << "sensors.min_range must not be negative";
  }
  if (dictionary->HasKey("max_range")) {
    settings->max_range = dictionary->GetDouble("max_range");
    CHECK_GT(settings->max_range, settings->min_range)
        << "sensors.max_range must be above sensors.min_range";
  }
  if (dictionary->HasKey("tracking_frame")) {
    settings->tracking_frame = dictionary->GetString("tracking_frame");
  }
}

// Ends the program when something is wrong.
SlamConfiguration ParseOrDie(const std::vector<std::string>& directories,
                             const std::string& name, const std::string& code) {
  SlamConfiguration configuration;
  configuration.name = name;
  LuaParameterDictionary dictionary(
      code, std::make_unique<ConfigurationFileResolver>(directories));
  configuration.map_builder_options =
      cartographer::mapping::CreateMapBuilderOptions(
          dictionary.GetDictionary("map_builder").get());
  configuration.trajectory_builder_options =
      cartographer::mapping::CreateTrajectoryBuilderOptions(
          dictionary.GetDictionary("trajectory_builder").get());
  ReadRosKeys(&dictionary, &configuration.sensors);
  if (dictionary.HasKey("sensors")) {
    ReadSensorSettings(dictionary.GetDictionary("sensors").get(),
                       &configuration.sensors);
  }
  return configuration;
}

std::string ReadOrDie(const std::vector<std::string>& directories,
                      const std::string& basename) {
  return ConfigurationFileResolver(directories).GetFileContentOrDie(basename);
}

// Makes the objects that look closer at the options than the reading does.
void ConstructOrDie(const SlamConfiguration& configuration) {
  CHECK(configuration.map_builder_options.use_trajectory_builder_2d())
      << "map_builder.use_trajectory_builder_2d must be true: this is 2D SLAM";
  const auto map_builder = cartographer::mapping::CreateMapBuilder(
      configuration.map_builder_options);
  map_builder->AddTrajectoryBuilder(
      {{TrajectoryBuilderInterface::SensorId::SensorType::RANGE, "scan"}},
      configuration.trajectory_builder_options, nullptr);
  // The child leaves without destroying it: there is nothing to wait for.
  _exit(0);
}

// What the host's reader may pass over or end the program for without a name.
// Whatever else is wrong with the code, the host says better.
absl::Status CheckTypes(const std::vector<std::string>& directories,
                        const std::string& name, const std::string& code) {
  const auto table = EvaluateLua(code, name, directories);
  if (!table.ok() || !table->is_object()) return absl::OkStatus();
  using cartographer::mapping::proto::MapBuilderOptions;
  using cartographer::mapping::proto::TrajectoryBuilderOptions;
  const std::pair<const char*, const google::protobuf::Descriptor*> parts[] = {
      {"map_builder", MapBuilderOptions::descriptor()},
      {"trajectory_builder", TrajectoryBuilderOptions::descriptor()}};
  for (const auto& part : parts) {
    const auto found = table->find(part.first);
    if (found == table->end() || !found->is_object()) continue;
    const absl::Status good =
        CheckOptionTypes(*found, *part.second, part.first);
    if (!good.ok()) return good;
  }
  return absl::OkStatus();
}

absl::Status Explain(const absl::Status& status, const std::string& name,
                     const std::vector<std::string>& directories) {
  return absl::Status(
      status.code(),
      absl::StrCat("configuration ", name, " (searched in ",
                   absl::StrJoin(directories, ", "), "): ", status.message()));
}

}  // namespace

absl::StatusOr<SlamConfiguration> LoadSlamConfiguration(
    const std::vector<std::string>& directories, const std::string& basename) {
  const absl::Status readable =
      TryInChildProcess([&] { ReadOrDie(directories, basename); });
  if (!readable.ok()) return Explain(readable, basename, directories);
  return ParseSlamConfiguration(directories, basename,
                                ReadOrDie(directories, basename));
}

absl::StatusOr<SlamConfiguration> ParseSlamConfiguration(
    const std::vector<std::string>& directories, const std::string& name,
    const std::string& code) {
  absl::Status valid = CheckTypes(directories, name, code);
  valid.Update(TryInChildProcess(
      [&] { ConstructOrDie(ParseOrDie(directories, name, code)); }));
  if (!valid.ok()) return Explain(valid, name, directories);
  return ParseOrDie(directories, name, code);
}

}  // namespace evaluation
}  // namespace cartographer_ext
