// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// JSON of files that others may have written or damaged. The library copies,
// compares and prints values recursively, so that deeply nested ones would
// overflow the stack; they are refused while they are parsed.
#ifndef CARTOGRAPHER_EXT_IO_BOUNDED_JSON_H_
#define CARTOGRAPHER_EXT_IO_BOUNDED_JSON_H_

#include <cstdint>
#include <string>

#include "absl/strings/string_view.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace io {

// Null or a discarded value if the text is not JSON or if arrays and objects
// are nested deeper than `max_depth`: a record of numbers has depth 1.
nlohmann::json ParseBoundedJson(absl::string_view text, int max_depth);

// Fields of a value, which need not be an object: `otherwise` if the field is
// missing or has another type.
std::string TextIn(const nlohmann::json& json, const char* key,
                   const std::string& otherwise = "");
double NumberIn(const nlohmann::json& json, const char* key, double otherwise);
bool TruthIn(const nlohmann::json& json, const char* key, bool otherwise);
// Also `otherwise` if the number is not between 0 and 2^53, up to which doubles
// count.
int64_t CountIn(const nlohmann::json& json, const char* key, int64_t otherwise);
// Takes a number that an int can hold; false if it is not one.
bool TakeInt(const nlohmann::json& json, const char* key, int* value);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_BOUNDED_JSON_H_
