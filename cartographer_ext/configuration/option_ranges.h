// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Can Cartographer work with the values of a configuration? Its own checks end
// the program where a value is used, which may be after an hour, and many
// values give an empty map without a word. Our own options have their ranges in
// options/; these are those of the stock keys of 2D SLAM.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_RANGES_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_RANGES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "google/protobuf/descriptor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Background threads that a configuration or a flag may ask for.
constexpr int kMaxBackgroundThreads = 4096;

// Looks at the numbers of `table`, whose keys belong to the fields of `message`
// as in CheckOptionTypes, and of the tables below. Passed over are keys without
// a field or with a value of another type, tables of 3D and those of features
// that are switched off.
//
// InvalidArgument where Cartographer would end the program, run out of memory
// or give no map; it names the key (path.key), the value, what it must be and
// why. A value that Cartographer works with, though hardly as intended, adds a
// line of that kind to `warnings`.
absl::Status CheckOptionRanges(const nlohmann::json& table,
                               const google::protobuf::Descriptor& message,
                               const std::string& path,
                               std::vector<std::string>* warnings);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_RANGES_H_
