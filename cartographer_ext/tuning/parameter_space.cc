// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/parameter_space.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/lua_value.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr int kDigits = 4;
constexpr int kMaxSteps = 1000;

double RoundToDigits(const double value) {
  return std::strtod(absl::StrFormat("%.*g", kDigits, value).c_str(), nullptr);
}

double Clamp(const double value, const double low, const double high) {
  return std::min(std::max(value, low), high);
}

constexpr char kIncludePrefix[] = "include.";

// Dotted Lua names.
bool IsKey(const std::string& key) {
  for (const absl::string_view part : absl::StrSplit(key, '.')) {
    if (part.empty() || absl::ascii_isdigit(part[0])) return false;
    for (const char c : part) {
      if (!absl::ascii_isalnum(c) && c != '_') return false;
    }
  }
  return true;
}

class EntryParser {
 public:
  EntryParser(const nlohmann::json& entry, const size_t index)
      : entry_(entry), name_(absl::StrCat("parameters[", index + 1, "]")) {}

  absl::StatusOr<Parameter> Parse() {
    if (!entry_.is_object()) return Error("is not a table");
    static const std::vector<std::string> known = {
        "key", "include", "range", "scale", "integer", "steps", "choices"};
    for (const auto& item : entry_.items()) {
      if (std::count(known.begin(), known.end(), item.key()) > 0) continue;
      return Error(absl::StrCat("has the unknown key '", item.key(), "'",
                                DidYouMean(SimilarWord(item.key(), known))));
    }
    const char* const name = Has("include") ? "include" : "key";
    if (Has("key") && Has("include")) return Error("has key and include");
    if (!Has(name) || !entry_[name].is_string()) {
      return Error("has no key = \"...\"");
    }
    parameter_.key = absl::StrCat(Has("include") ? kIncludePrefix : "",
                                  entry_[name].get<std::string>());
    name_ = absl::StrCat(name_, " (", parameter_.key, ")");
    if (!IsKey(parameter_.key))
      return Error("has a key that is not a Lua name");
    if (Has("range") == Has("choices")) {
      return Error("needs either range = { low, high } or choices = { ... }");
    }
    const absl::Status status = Has("choices") ? ParseChoices() : ParseRange();
    if (!status.ok()) return status;
    if (parameter_.is_include() &&
        (parameter_.kind != Parameter::Kind::kChoice ||
         !std::all_of(parameter_.choices.begin(), parameter_.choices.end(),
                      [](const Value& file) { return file.is_string(); }))) {
      return Error("needs names of Lua files as choices, \"\" for none");
    }
    return parameter_;
  }

 private:
  bool Has(const char* const key) const { return entry_.contains(key); }

  absl::Status Error(const std::string& what) const {
    return absl::InvalidArgumentError(absl::StrCat(name_, " ", what));
  }

  absl::Status ParseChoices() {
    if (Has("scale") || Has("integer") || Has("steps")) {
      return Error("has choices, so it cannot have scale, integer or steps");
    }
    parameter_.kind = Parameter::Kind::kChoice;
    const nlohmann::json& choices = entry_["choices"];
    if (!choices.is_array() || choices.empty()) {
      return Error("has no choices");
    }
    for (const nlohmann::json& choice : choices) {
      if (!choice.is_primitive() || choice.is_null()) {
        return Error("has a choice that is not a number, string or boolean");
      }
      if (std::find(parameter_.choices.begin(), parameter_.choices.end(),
                    choice) != parameter_.choices.end()) {
        return Error(absl::StrCat("has the choice ", evaluation::ToLua(choice),
                                  " twice"));
      }
      parameter_.choices.push_back(choice);
    }
    return absl::OkStatus();
  }

  absl::Status ParseRange() {
    const nlohmann::json& range = entry_["range"];
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() ||
        !range[1].is_number()) {
      return Error("needs range = { low, high }");
    }
    parameter_.low = range[0].get<double>();
    parameter_.high = range[1].get<double>();
    if (!std::isfinite(parameter_.low) || !std::isfinite(parameter_.high)) {
      return Error("has a range that is not finite");
    }
    if (parameter_.low >= parameter_.high) {
      return Error(absl::StrFormat("has an empty range, %g to %g",
                                   parameter_.low, parameter_.high));
    }
    if (Has("scale")) {
      if (entry_["scale"] != "log" && entry_["scale"] != "linear") {
        return Error("has a scale other than \"log\" and \"linear\"");
      }
      parameter_.log_scale = entry_["scale"] == "log";
    }
    if (parameter_.log_scale && parameter_.low <= 0.) {
      return Error("has a logarithmic scale, so its range must be above 0");
    }
    if (Has("integer")) {
      if (!entry_["integer"].is_boolean()) {
        return Error("needs integer = true or false");
      }
      if (entry_["integer"].get<bool>()) {
        parameter_.kind = Parameter::Kind::kInteger;
      }
    }
    if (parameter_.kind == Parameter::Kind::kInteger &&
        (std::rint(parameter_.low) != parameter_.low ||
         std::rint(parameter_.high) != parameter_.high ||
         std::abs(parameter_.low) > 1e9 || std::abs(parameter_.high) > 1e9)) {
      return Error("is an integer, so its range must be of integers to 1e9");
    }
    if (Has("steps")) {
      const nlohmann::json& steps = entry_["steps"];
      if (!steps.is_number_integer() || steps.get<int64_t>() < 2 ||
          steps.get<int64_t>() > kMaxSteps) {
        return Error("needs steps = 2 ... 1000");
      }
      parameter_.steps = steps.get<int>();
    }
    return absl::OkStatus();
  }

  const nlohmann::json& entry_;
  std::string name_;
  Parameter parameter_;
};

}  // namespace

bool IsIncludeKey(const std::string& key) {
  return absl::StartsWith(key, kIncludePrefix);
}

bool Parameter::is_include() const { return IsIncludeKey(key); }

Value Parameter::FromUnit(const double unit) const {
  const double u = std::isnan(unit) ? 0. : Clamp(unit, 0., 1.);
  if (kind == Kind::kChoice) {
    const size_t index =
        static_cast<size_t>(u * static_cast<double>(choices.size()));
    return choices[std::min(index, choices.size() - 1)];
  }
  const double raw =
      log_scale ? low * std::pow(high / low, u) : low + u * (high - low);
  if (kind == Kind::kInteger) {
    return static_cast<int64_t>(Clamp(std::rint(raw), low, high));
  }
  return Clamp(RoundToDigits(raw), low, high);
}

double Parameter::ToUnit(const Value& value) const {
  if (kind == Kind::kChoice) {
    const auto found = std::find(choices.begin(), choices.end(), value);
    const double index = found == choices.end()
                             ? 0.
                             : static_cast<double>(found - choices.begin());
    // The middle of the part of the unit interval that maps to this choice.
    return (index + 0.5) / static_cast<double>(choices.size());
  }
  if (!value.is_number()) return 0.;
  const double number = Clamp(value.get<double>(), low, high);
  return log_scale ? std::log(number / low) / std::log(high / low)
                   : (number - low) / (high - low);
}

std::vector<Value> Parameter::GridValues() const {
  if (kind == Kind::kChoice) return choices;
  std::vector<Value> values;
  for (int i = 0; i < steps; ++i) {
    const Value value = FromUnit(static_cast<double>(i) / (steps - 1));
    if (values.empty() || values.back() != value) values.push_back(value);
  }
  return values;
}

absl::StatusOr<std::vector<Parameter>> ParseParameters(
    const nlohmann::json& array) {
  if (!array.is_array() || array.empty()) {
    return absl::InvalidArgumentError("parameters is not a list of tables");
  }
  std::vector<Parameter> parameters;
  std::set<std::string> keys;
  for (size_t i = 0; i < array.size(); ++i) {
    auto parameter = EntryParser(array[i], i).Parse();
    if (!parameter.ok()) return parameter.status();
    if (!keys.insert(parameter->key).second) {
      return absl::InvalidArgumentError(absl::StrCat(
          "parameters[", i + 1, "]: ", parameter->key, " is listed twice"));
    }
    parameters.push_back(*std::move(parameter));
  }
  return parameters;
}

nlohmann::json ToAssignment(const std::vector<Parameter>& parameters,
                            const Point& point) {
  nlohmann::json assignment = nlohmann::json::object();
  for (size_t i = 0; i < parameters.size(); ++i) {
    assignment[parameters[i].key] = point[i];
  }
  return assignment;
}

}  // namespace tuning
}  // namespace cartographer_ext
