// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Type checks for the values of a configuration. The reader of upstream
// Cartographer aborts without naming the key, and silently truncates 0.5 to an
// integer. The option messages give the types: every key of a configuration has
// a field there.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_TYPES_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_TYPES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "google/protobuf/descriptor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// The field that a key of a configuration belongs to: that of its name; the
// field may have "_options" in it as well, and a number of dimensions after
// that, as in constraint_builder: constraint_builder_options. The closest name
// wins: "x" matches x_options rather than x_options_3d. Null if there is none.
const google::protobuf::FieldDescriptor* FindOptionField(
    const google::protobuf::Descriptor& message, const std::string& key);

// Compares `table` with the fields of `message`, including sub-tables. Keys
// without a field and missing ones are ignored, because the host checks those.
// As in the host, a number may be written as a string.
//
// InvalidArgument with the path of the key (which starts with `path`), its
// value and the expected type.
absl::Status CheckOptionTypes(const nlohmann::json& table,
                              const google::protobuf::Descriptor& message,
                              const std::string& path);

// The keys that correspond to no field, including sub-tables, with their path
// and the most similar known key, or "". Our own blocks are ignored. The host
// decides about such keys, since it may accept more than its messages have.
struct UnknownKey {
  std::string table;  // path
  std::string key;
  std::string similar;
};
std::vector<UnknownKey> FindUnknownKeys(
    const nlohmann::json& table, const google::protobuf::Descriptor& message,
    const std::string& path);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_TYPES_H_
