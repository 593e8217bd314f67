// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/bounded_json.h"

#include <limits>

namespace cartographer_ext {
namespace io {

nlohmann::json ParseBoundedJson(const absl::string_view text,
                                const int max_depth) {
  using Event = nlohmann::json::parse_event_t;
  bool is_too_deep = false;
  auto json = nlohmann::json::parse(
      text.data(), text.data() + text.size(),
      [&is_too_deep, max_depth](const int depth, const Event event,
                                nlohmann::json&) {
        // `depth` is that around what begins.
        const bool begins =
            event == Event::object_start || event == Event::array_start;
        if (begins && depth >= max_depth) is_too_deep = true;
        return !is_too_deep;
      },
      /*allow_exceptions=*/false);
  return is_too_deep ? nlohmann::json() : json;
}

std::string TextIn(const nlohmann::json& json, const char* const key,
                   const std::string& otherwise) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>()
                                                   : otherwise;
}

double NumberIn(const nlohmann::json& json, const char* const key,
                const double otherwise) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>()
                                                   : otherwise;
}

bool TruthIn(const nlohmann::json& json, const char* const key,
             const bool otherwise) {
  const auto found = json.find(key);
  return found != json.end() && found->is_boolean() ? found->get<bool>()
                                                    : otherwise;
}

int64_t CountIn(const nlohmann::json& json, const char* const key,
                const int64_t otherwise) {
  constexpr double kLargest = static_cast<double>(int64_t{1} << 53);
  const double number = NumberIn(json, key, -1.);
  return number >= 0. && number <= kLargest ? static_cast<int64_t>(number)
                                            : otherwise;
}

bool TakeInt(const nlohmann::json& json, const char* const key,
             int* const value) {
  using Limits = std::numeric_limits<int>;
  const double number =
      NumberIn(json, key, std::numeric_limits<double>::infinity());
  if (!(number >= Limits::min() && number <= Limits::max())) return false;
  *value = static_cast<int>(number);
  return true;
}

}  // namespace io
}  // namespace cartographer_ext
