// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SLAM_RUN_SUMMARY_H_
#define CARTOGRAPHER_EXT_SLAM_RUN_SUMMARY_H_

#include <string>

#include "cartographer_ext/slam/slam_runner.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Input, results and resource use, as JSON.
nlohmann::ordered_json ToJson(const SlamRun& run);

// A summary in a few lines, with a final line break.
std::string ToText(const SlamRun& run);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_RUN_SUMMARY_H_
