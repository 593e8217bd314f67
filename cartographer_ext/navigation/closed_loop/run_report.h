// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reports a drive in closed loop as numbers and as a picture.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_RUN_REPORT_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_RUN_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"
#include "cartographer_ext/navigation/closed_loop/shadow_localization.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace navigation {

nlohmann::ordered_json ToJson(const NavigationRun& run);
nlohmann::ordered_json ToJson(const ShadowLocalization& shadow, double seconds);

// A few lines for the terminal.
std::string ToText(const NavigationRun& run);

// PNG of the map, the path driven, the goals and the obstacles put in it.
absl::Status WriteRunPicture(const NavigationRun& run, const std::string& title,
                             const std::string& filename);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_RUN_REPORT_H_
