// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The search space: Lua keys with their allowed values. Every parameter is a
// map from the unit interval, so samplers are independent of units, logarithms,
// integers and choices.
#ifndef CARTOGRAPHER_EXT_TUNING_PARAMETER_SPACE_H_
#define CARTOGRAPHER_EXT_TUNING_PARAMETER_SPACE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tuning {

// A boolean, an integer, a number or a string.
using Value = nlohmann::json;

struct Parameter {
  enum class Kind { kReal, kInteger, kChoice };

  // Full name in the configuration: "POSE_GRAPH.constraint_builder.min_score".
  // Or "include.NAME": the choices are Lua files that are run behind the
  // configuration and before the assignments, "" being none.
  std::string key;
  Kind kind = Kind::kReal;
  // The range is inclusive.
  double low = 0.;
  double high = 1.;
  bool log_scale = false;
  int steps = 5;  // of a grid, for ranges
  std::vector<Value> choices;

  bool is_include() const;

  // `unit` in [0, 1], clamped. Numbers are rounded to four digits, so that the
  // result can be read and written again without loss.
  Value FromUnit(double unit) const;

  // Position of the value, clamped to [0, 1]. A value that is not a choice
  // counts as the first.
  double ToUnit(const Value& value) const;

  // Evenly spaced in the unit interval, both ends included, without repetition;
  // all choices.
  std::vector<Value> GridValues() const;
};

// Parses an array of tables from the Lua file:
//   { key = "...", range = { 0.4, 0.8 }, scale = "log", integer = true,
//     steps = 5 }
//   { key = "...", choices = { true, false } }
//   { include = "NAME", choices = { "", "front_end_default.lua" } }
// Errors name the entry, its key and the problem.
absl::StatusOr<std::vector<Parameter>> ParseParameters(
    const nlohmann::json& array);

// Whether the key names a file to be included.
bool IsIncludeKey(const std::string& key);

// Parameter by parameter.
using Point = std::vector<Value>;

// { key: value }, in alphabetical order: what identifies a configuration.
nlohmann::json ToAssignment(const std::vector<Parameter>& parameters,
                            const Point& point);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_PARAMETER_SPACE_H_
