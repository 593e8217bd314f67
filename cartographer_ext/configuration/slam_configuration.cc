// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/slam_configuration.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/fatal_guard.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/configuration/option_ranges.h"
#include "cartographer_ext/configuration/option_types.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::common::ConfigurationFileResolver;
using cartographer::common::LuaParameterDictionary;
using cartographer::mapping::TrajectoryBuilderInterface;

// Limit for reading a configuration, which takes about a hundredth of a second.
constexpr int kMaxLuaCpuSeconds = 20;

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

constexpr char kTablesOfBlocks[] =
    "; blocks of that name belong to POSE_GRAPH.constraint_builder, "
    "POSE_GRAPH.optimization_problem, TRAJECTORY_BUILDER_2D and "
    "TRAJECTORY_BUILDER_2D.ceres_scan_matcher";

// Reads the keys that the configuration of a ROS node has at its top level; the
// dictionary requires every key to be read.
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

// Ends the program if the configuration is invalid.
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

// Creates the objects that check their options more closely than the reader.
void ConstructOrDie(const SlamConfiguration& configuration) {
  LOG_IF(FATAL, !configuration.map_builder_options.use_trajectory_builder_2d())
      << "MAP_BUILDER.use_trajectory_builder_2d must be true: this is 2D SLAM";
  auto* const map_builder =
      cartographer::mapping::CreateMapBuilder(configuration.map_builder_options)
          .release();
  map_builder->AddTrajectoryBuilder(
      {{TrajectoryBuilderInterface::SensorId::SensorType::RANGE, "scan"}},
      configuration.trajectory_builder_options, nullptr);
  // The child leaves without destroying it: there is nothing to wait for.
}

// The part of the result with its message, and its name in Lua files.
struct Part {
  const char* key;
  const char* lua_name;
  const google::protobuf::Descriptor* message;
};

std::vector<Part> Parts() {
  using cartographer::mapping::proto::MapBuilderOptions;
  using cartographer::mapping::proto::TrajectoryBuilderOptions;
  return {{"map_builder", "MAP_BUILDER", MapBuilderOptions::descriptor()},
          {"trajectory_builder", "TRAJECTORY_BUILDER",
           TrajectoryBuilderOptions::descriptor()}};
}

// The name that users write: MAP_BUILDER.pose_graph is POSE_GRAPH.
std::string InLuaFile(const std::string& text) {
  return absl::StrReplaceAll(text, {{"MAP_BUILDER.pose_graph", "POSE_GRAPH"},
                                    {"TRAJECTORY_BUILDER.trajectory_builder_2d",
                                     "TRAJECTORY_BUILDER_2D"}});
}

// What every configuration returns.
absl::Status CheckParts(const nlohmann::json& table) {
  for (const Part& part : Parts()) {
    if (table.is_object() && table.count(part.key) > 0) continue;
    return absl::InvalidArgumentError(absl::StrCat(
        "returns no ", part.key, ": ",
        table.is_object() && table.count("parameters") > 0
            ? "it is a search file of cartographer_ext_tune"
            : "a configuration ends with return { map_builder = MAP_BUILDER, "
              "trajectory_builder = TRAJECTORY_BUILDER }; a file without that "
              "is for being included"));
  }
  const auto& map_builder = table["map_builder"];
  if (!map_builder.is_object()) return absl::OkStatus();
  for (const bool is_2d : {true, false}) {
    const auto found = map_builder.find(is_2d ? "use_trajectory_builder_2d"
                                              : "use_trajectory_builder_3d");
    if (found == map_builder.end() || !found->is_boolean() || *found == is_2d) {
      continue;
    }
    return absl::InvalidArgumentError(
        absl::StrCat("MAP_BUILDER.", found.key(), " must be ",
                     is_2d ? "true" : "false", ": this is 2D SLAM"));
  }
  return absl::OkStatus();
}

// Errors that the host's reader ignores, or for which it ends the program
// without naming the key. For all other errors the message of the host is
// better.
absl::Status CheckValues(const nlohmann::json& table,
                         std::vector<std::string>* const warnings) {
  for (const Part& part : Parts()) {
    const auto found = table.find(part.key);
    if (found == table.end() || !found->is_object()) continue;
    absl::Status good = CheckOptionTypes(*found, *part.message, part.lua_name);
    if (good.ok()) {
      good = CheckOptionRanges(*found, *part.message, part.lua_name, warnings);
    }
    if (!good.ok()) {
      return absl::Status(good.code(), InLuaFile(std::string(good.message())));
    }
  }
  return absl::OkStatus();
}

// The host's message without the table that it lists after a missing key, and
// the key as in Lua files.
absl::Status InOneLine(const absl::Status& status) {
  std::string message(status.message());
  const size_t table = message.find("; the table is:\n");
  if (table == std::string::npos) return status;
  message.resize(table);
  for (const Part& part : Parts()) {
    absl::StrReplaceAll({{absl::StrCat("'", part.key, "."),
                          absl::StrCat("'", part.lua_name, ".")}},
                        &message);
  }
  return absl::Status(status.code(), InLuaFile(message));
}

// What is said of a key that does not exist; empty unless `said` is about one
// of `table`.
std::string SayUnknownKey(const absl::string_view said,
                          const nlohmann::json& table,
                          const std::string& prefix,
                          const std::vector<std::string>& known) {
  if (!table.is_object()) return "";
  for (const auto& item : table.items()) {
    if (std::count(known.begin(), known.end(), item.key()) > 0 ||
        !absl::StrContains(said, absl::StrCat(item.key(), "'"))) {
      continue;
    }
    return absl::StrCat(prefix, item.key(), " is not an option",
                        DidYouMean(SimilarWord(item.key(), known)));
  }
  return "";
}

std::vector<std::string> KeysOfSensors() {
  std::vector<std::string> keys;
  for (const auto& setting : DescribeSensorSettings()) {
    keys.push_back(setting.key);
  }
  return keys;
}

std::vector<std::string> KeysOfResult() {
  std::vector<std::string> keys = {"map_builder", "trajectory_builder",
                                   "sensors", "use_odometry", "tracking_frame"};
  keys.insert(keys.end(), std::begin(kRosStrings), std::end(kRosStrings));
  keys.insert(keys.end(), std::begin(kRosBools), std::end(kRosBools));
  keys.insert(keys.end(), std::begin(kRosNumbers), std::end(kRosNumbers));
  return keys;
}

// The host's message and, if an unknown name is the cause, the one that was
// probably meant.
absl::Status Suggest(const absl::Status& status, const nlohmann::json& table) {
  if (!table.is_object()) return InOneLine(status);
  // The host quotes the key; in the lines that follow, the table it missed.
  const absl::string_view said =
      status.message().substr(0, status.message().find('\n'));
  const auto is_meant = [said](const std::string& key) {
    return !key.empty() && absl::StrContains(said, absl::StrCat(key, "'"));
  };
  for (const Part& part : Parts()) {
    const auto found = table.find(part.key);
    if (found == table.end() || !found->is_object()) continue;
    for (const UnknownKey& unknown :
         FindUnknownKeys(*found, *part.message, part.lua_name)) {
      if (!is_meant(unknown.key) && !is_meant(unknown.similar)) continue;
      return absl::InvalidArgumentError(absl::StrCat(
          InLuaFile(absl::StrCat(unknown.table, ".", unknown.key)),
          " is not an option",
          unknown.key == "cartographer_ext" ? kTablesOfBlocks
                                            : DidYouMean(unknown.similar)));
    }
  }
  const std::string of_sensors =
      SayUnknownKey(said, table.value("sensors", nlohmann::json()), "sensors.",
                    KeysOfSensors());
  const std::string text = of_sensors.empty()
                               ? SayUnknownKey(said, table, "", KeysOfResult())
                               : of_sensors;
  return text.empty() ? InOneLine(status) : absl::InvalidArgumentError(text);
}

// What the code returns; discarded if the error is left to the host. The code
// runs in a child process first, because code that calls one function for hours
// cannot be interrupted.
absl::StatusOr<nlohmann::json> Evaluate(
    const std::vector<std::string>& directories, const std::string& name,
    const std::string& code) {
  const absl::Status ends = TryInChildProcess(
      [&] { EvaluateLua(code, name, directories).status().IgnoreError(); },
      kMaxLuaCpuSeconds);
  if (ends.code() == absl::StatusCode::kInvalidArgument) return ends;
  auto table = EvaluateLua(code, name, directories);
  if (table.ok() || IsLuaRestricted() ||
      table.status().code() == absl::StatusCode::kResourceExhausted) {
    return table;
  }
  return nlohmann::json(nlohmann::json::value_t::discarded);
}

absl::Status Explain(const absl::Status& status, const std::string& name,
                     const std::vector<std::string>& directories) {
  return absl::Status(
      status.code(),
      absl::StrCat("configuration ", name, " (searched in ",
                   absl::StrJoin(directories, ", "), "): ", status.message()));
}

// The host does not tell Lua the name of a file, so that Lua calls the code by
// how it begins: [string "-- My robot..."]:9: unexpected symbol. With the name
// in its place.
absl::Status WithFileName(const absl::Status& status, const std::string& name,
                          const std::string& code) {
  constexpr absl::string_view kBegin = "[string \"";
  constexpr absl::string_view kEnd = "\"]:";
  const std::string message(status.message());
  const size_t begin = message.find(kBegin.data());
  const size_t end = message.find(kEnd.data(), begin);
  if (begin == std::string::npos || end == std::string::npos) return status;
  absl::string_view shown = absl::string_view(message).substr(
      begin + kBegin.size(), end - begin - kBegin.size());
  absl::ConsumeSuffix(&shown, "...");
  if (!absl::StartsWith(code, shown)) return status;
  return absl::Status(status.code(),
                      absl::StrCat(message.substr(0, begin), name, ":",
                                   message.substr(end + kEnd.size())));
}

}  // namespace

bool UsesImu(const SlamConfiguration& configuration) {
  return configuration.sensors.use_recorded_imu ||
         configuration.trajectory_builder_options
             .trajectory_builder_2d_options()
             .use_imu_data();
}

absl::StatusOr<SlamConfiguration> LoadSlamConfiguration(
    const std::vector<std::string>& directories, const std::string& basename) {
  auto code = ReadFromDirectories(basename, directories);
  if (code.status().code() == absl::StatusCode::kNotFound) {
    // The host may have a folder with configuration files of its own.
    const absl::Status readable =
        TryInChildProcess([&] { ReadOrDie(directories, basename); });
    if (!readable.ok()) return Explain(readable, basename, directories);
    code = ReadOrDie(directories, basename);
  }
  if (!code.ok()) return Explain(code.status(), basename, directories);
  return ParseSlamConfiguration(directories, basename, *code);
}

absl::StatusOr<SlamConfiguration> ParseSlamConfiguration(
    const std::vector<std::string>& directories, const std::string& name,
    const std::string& code) {
  const auto table = Evaluate(directories, name, code);
  if (!table.ok()) return Explain(table.status(), name, directories);
  std::vector<std::string> warnings;
  absl::Status valid =
      table->is_discarded() ? absl::OkStatus() : CheckParts(*table);
  if (valid.ok()) valid = CheckValues(*table, &warnings);
  if (!valid.ok()) return Explain(valid, name, directories);
  // Restricted code is not run again by the host, which opens all libraries.
  const std::string& host_code = IsLuaRestricted() ? ToLuaCode(*table) : code;
  valid = TryInChildProcess(
      [&] { ConstructOrDie(ParseOrDie(directories, name, host_code)); });
  if (!valid.ok()) {
    return Explain(WithFileName(Suggest(valid, *table), name, code), name,
                   directories);
  }
  SlamConfiguration configuration = ParseOrDie(directories, name, host_code);
  for (const std::string& warning : warnings) {
    configuration.warnings.push_back(
        absl::StrCat(name, ": ", InLuaFile(warning)));
  }
  return configuration;
}

}  // namespace evaluation
}  // namespace cartographer_ext
