// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The result of a repair as JSON, as text and as a page.
#ifndef CARTOGRAPHER_EXT_REPAIR_REPAIR_OUTPUT_H_
#define CARTOGRAPHER_EXT_REPAIR_REPAIR_OUTPUT_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/repair/map_repair.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace repair {

nlohmann::ordered_json ToJson(const MapRepair& repair);

// Several lines of text, with a final line break.
std::string ToText(const MapRepair& repair);

// One HTML file: the result, advice, the steps with their reasons, both
// versions aligned. An error if a version has no walls.
absl::StatusOr<std::string> MakeRepairReport(const MapRepair& repair,
                                             const std::string& title,
                                             const std::string& command_line);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_REPAIR_OUTPUT_H_
