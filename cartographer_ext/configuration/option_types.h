// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Are the values of a configuration of the types that its keys want? The
// reader of an upstream Cartographer ends the program without naming the key,
// and makes an integer of 0.5 in silence. The messages of the options know
// better: every key of a configuration has a field there.
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
// that, as in constraint_builder: constraint_builder_options. The closer name
// wins: of x_options and x_options_3d the first is meant by "x". Null when there
// is none.
const google::protobuf::FieldDescriptor* FindOptionField(
    const google::protobuf::Descriptor& message, const std::string& key);

// Compares `table` with the fields of `message`, in tables below as well.
// Keys without a field are passed over, as are missing ones: the host looks
// for those. As for the host, a number may be written as a string.
//
// InvalidArgument with the path of the key (which starts with `path`), its
// value and what it must be.
absl::Status CheckOptionTypes(const nlohmann::json& table,
                              const google::protobuf::Descriptor& message,
                              const std::string& path);

// The keys that belong to no field, in tables below as well, with their path
// and the key of the configuration's own names that looks most like it: "" when
// none does. Blocks of our own are passed over. What such keys do the host
// decides: it may know more than its messages.
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
