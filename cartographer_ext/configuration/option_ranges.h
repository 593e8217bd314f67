// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Range checks for the stock keys of 2D SLAM. Cartographer's own checks
// terminate the program when a value is used, possibly after an hour, and many
// values silently give an empty map. The ranges of our own options are in
// options/.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_RANGES_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_RANGES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "google/protobuf/descriptor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Largest number of background threads.
constexpr int kMaxBackgroundThreads = 4096;

// Checks the numbers of `table`, whose keys correspond to the fields of
// `message` as in CheckOptionTypes, and of its sub-tables. Keys without a field
// or with a value of another type, tables for 3D and those of disabled features
// are ignored.
//
// InvalidArgument if Cartographer would abort, run out of memory or produce no
// map; it names the key (path.key), the value, the allowed range and the
// reason. A value that works but is unlikely to be intended adds a line to
// `warnings`.
absl::Status CheckOptionRanges(const nlohmann::json& table,
                               const google::protobuf::Descriptor& message,
                               const std::string& path,
                               std::vector<std::string>* warnings);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_RANGES_H_
