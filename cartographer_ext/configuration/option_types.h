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

#include "absl/status/status.h"
#include "google/protobuf/descriptor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Compares `table` with the fields of `message`, in tables below as well. A key
// belongs to the field of its name; the field may have "_options" in it as
// well, and a number of dimensions after that, as in
// constraint_builder: constraint_builder_options.
// Keys without a field are passed over, as are missing ones: the host looks
// for those. As for the host, a number may be written as a string.
//
// InvalidArgument with the path of the key (which starts with `path`), its
// value and what it must be.
absl::Status CheckOptionTypes(const nlohmann::json& table,
                              const google::protobuf::Descriptor& message,
                              const std::string& path);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_TYPES_H_
