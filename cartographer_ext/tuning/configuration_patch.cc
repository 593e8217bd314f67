// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/configuration_patch.h"

#include <algorithm>
#include <set>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/configuration/option_blocks.h"
#include "cartographer_ext/options/option_description.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr char kBlockName[] = "cartographer_ext";

// Creates the tables that lead to the key where they are absent; whether they
// may be is checked before. Our blocks may be one table in several places, so
// they are copied before they are changed.
constexpr char kAssignFunction[] = R"(
local function assign(path, value)
  local names = {}
  for name in path:gmatch("[^.]+") do names[#names + 1] = name end
  local place, in_block = _G, false
  for i = 1, #names - 1 do
    in_block = in_block or names[i] == "cartographer_ext"
    if in_block then
      local copy = {}
      for k, v in pairs(place[names[i]] or {}) do copy[k] = v end
      place[names[i]] = copy
    end
    place = place[names[i]]
  end
  place[names[#names]] = value
end
)";

// The file's code as a function, with its line numbers kept.
std::string AsFunction(const std::string& code) {
  return absl::StrCat("local configuration = (function() ", code, "\nend)()\n");
}

bool IsInBlock(const std::vector<std::string>& path) {
  return std::find(path.begin(), path.end(), kBlockName) != path.end();
}

absl::Status NoSuchKey(const std::string& key, const std::string& missing,
                       const std::vector<std::string>& names) {
  return absl::InvalidArgumentError(
      absl::StrCat("the configuration has no key ", key, ": '", missing,
                   "' is unknown", DidYouMean(SimilarWord(missing, names))));
}

std::vector<std::string> Names(const nlohmann::json& table) {
  std::vector<std::string> names;
  for (const auto& item : table.items()) names.push_back(item.key());
  return names;
}

Value ParseDescribed(const options::OptionDescription& description) {
  if (description.type == "boolean") return description.value == "true";
  int64_t integer;
  if (description.type == "integer" &&
      absl::SimpleAtoi(description.value, &integer)) {
    return integer;
  }
  double number;
  if (description.type == "number" &&
      absl::SimpleAtod(description.value, &number)) {
    return number;
  }
  return description.value;
}

// The options that 2D SLAM reads, serialised.
std::string Bytes(const evaluation::SlamConfiguration& configuration) {
  auto map_builder = configuration.map_builder_options;
  auto* const constraint_builder = map_builder.mutable_pose_graph_options()
                                       ->mutable_constraint_builder_options();
  constraint_builder->clear_fast_correlative_scan_matcher_options_3d();
  constraint_builder->clear_ceres_scan_matcher_options_3d();
  auto trajectory_builder = configuration.trajectory_builder_options;
  trajectory_builder.clear_trajectory_builder_3d_options();
  return absl::StrCat(map_builder.SerializeAsString(), "|",
                      trajectory_builder.SerializeAsString());
}

// The values of a parameter that are checked before the search.
std::vector<Value> Probes(const Parameter& parameter) {
  if (parameter.kind == Parameter::Kind::kChoice) return parameter.choices;
  // The ends of a range may be integers by chance; a value between them is not.
  return {parameter.FromUnit(0.), parameter.FromUnit(0.37),
          parameter.FromUnit(1.)};
}

}  // namespace

std::string HashText(const std::string& text) {
  uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return absl::StrFormat("%016x", hash);
}

absl::StatusOr<BaseConfiguration> BaseConfiguration::Load(
    const std::vector<std::string>& directories, const std::string& basename) {
  BaseConfiguration result;
  result.name_ = basename;
  result.directories_ = directories;
  auto code = evaluation::ReadFromDirectories(basename, directories);
  if (!code.ok()) return code.status();
  result.code_ = *std::move(code);
  auto parsed =
      evaluation::ParseSlamConfiguration(directories, basename, result.code_);
  if (!parsed.ok()) return parsed.status();
  result.parsed_ = *std::move(parsed);
  return result;
}

absl::StatusOr<Point> BaseConfiguration::Values(
    const std::vector<Parameter>& parameters) const {
  std::set<std::string> roots;
  for (const Parameter& parameter : parameters) {
    if (parameter.is_include()) continue;
    roots.insert(parameter.key.substr(0, parameter.key.find('.')));
  }
  std::string code = AsFunction(code_) + "return {\n";
  for (const std::string& root : roots) {
    absl::StrAppend(&code, root, " = ", root, ",\n");
  }
  const auto tables =
      evaluation::EvaluateLua(code + "}\n", name_, directories_);
  if (!tables.ok()) return tables.status();
  Point point;
  for (const Parameter& parameter : parameters) {
    if (parameter.is_include()) {
      point.push_back("");
      continue;
    }
    const std::vector<std::string> path = absl::StrSplit(parameter.key, '.');
    const nlohmann::json* place = &*tables;
    bool in_block = false;
    size_t i = 0;
    for (; i < path.size(); ++i) {
      if (!place->is_object() || !place->contains(path[i])) break;
      place = &(*place)[path[i]];
      in_block |= path[i] == kBlockName;
    }
    if (i == path.size()) {
      if (!place->is_primitive()) {
        return absl::InvalidArgumentError(
            absl::StrCat(parameter.key, " is a table; name the keys in it"));
      }
      point.push_back(*place);
      continue;
    }
    if (in_block) {
      auto value = BlockValue(parameter);
      if (!value.ok()) return value.status();
      point.push_back(*std::move(value));
      continue;
    }
    if (IsInBlock(path) && path[i] == kBlockName) {
      return absl::InvalidArgumentError(absl::StrCat(
          name_, " does not have the block ",
          absl::StrJoin(path.begin(), path.begin() + i + 1, "."), ", so ",
          parameter.key, " has no effect; enable the block first"));
    }
    return NoSuchKey(
        parameter.key, path[i],
        place->is_object() ? Names(*place) : std::vector<std::string>());
  }
  return point;
}

absl::StatusOr<Value> BaseConfiguration::BlockValue(
    const Parameter& parameter) const {
  const std::string separator = absl::StrCat(".", kBlockName, ".");
  const size_t end = parameter.key.find(separator);
  if (end == std::string::npos) {
    return absl::InvalidArgumentError(
        absl::StrCat(parameter.key, " is a table; name the keys in it"));
  }
  const std::string stock_path = parameter.key.substr(0, end);
  const std::string option = parameter.key.substr(end + separator.size());
  std::vector<std::string> names;
  for (const options::OptionBlock& block : evaluation::OptionBlocks(parsed_)) {
    if (block.stock_path != stock_path || !block.present) continue;
    for (const auto& description : options::Describe(*block.options)) {
      if (description.key == option) return ParseDescribed(description);
      names.push_back(description.key);
    }
  }
  return NoSuchKey(parameter.key, option, names);
}

absl::Status BaseConfiguration::CheckParameters(
    const std::vector<Parameter>& parameters) const {
  const auto values = Values(parameters);
  if (!values.ok()) return values.status();
  const std::string base_bytes = Bytes(parsed_);
  for (size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const Value& value = (*values)[i];
    const bool wants_number = parameter.kind != Parameter::Kind::kChoice;
    if (wants_number && !value.is_number()) {
      return absl::InvalidArgumentError(
          absl::StrCat(parameter.key, " is ", evaluation::ToLua(value),
                       " in the configuration; give choices, not a range"));
    }
    bool changes = false;
    for (const Value& probe : Probes(parameter)) {
      const auto configuration = evaluation::ParseSlamConfiguration(
          directories_, name_, CodeWith({{parameter.key, probe}}));
      if (!configuration.ok()) {
        return absl::InvalidArgumentError(absl::StrCat(
            parameter.key, " = ", evaluation::ToLua(probe), ": ",
            configuration.status().message(),
            parameter.kind == Parameter::Kind::kReal &&
                    absl::StrContains(configuration.status().message(),
                                      "must be an integer")
                ? "; give it integer = true"
                : ""));
      }
      changes |= Bytes(*configuration) != base_bytes;
    }
    if (!changes) {
      return absl::InvalidArgumentError(
          absl::StrCat(parameter.key, " is not used: nothing that ", name_,
                       " gives to 2D SLAM changes with it"));
    }
  }
  return absl::OkStatus();
}

std::string BaseConfiguration::CodeWith(
    const nlohmann::json& assignment) const {
  std::string code = AsFunction(code_) + kAssignFunction;
  for (const auto& item : assignment.items()) {
    if (!IsIncludeKey(item.key()) || item.value() == "") continue;
    absl::StrAppend(&code, "include ", evaluation::ToLua(item.value()), "\n");
  }
  for (const auto& item : assignment.items()) {
    if (IsIncludeKey(item.key())) continue;
    absl::StrAppend(&code, "assign(\"", item.key(), "\", ",
                    evaluation::ToLua(item.value()), ")\n");
  }
  return code + "return configuration\n";
}

std::string BaseConfiguration::Fingerprint() const {
  const evaluation::SensorSettings& sensors = parsed_.sensors;
  return HashText(absl::StrCat(
      Bytes(parsed_), "|", sensors.use_odometry, "|", sensors.use_recorded_imu,
      "|", sensors.odometry_source, "|", sensors.min_range, "|",
      sensors.max_range, "|", sensors.tracking_frame));
}

}  // namespace tuning
}  // namespace cartographer_ext
