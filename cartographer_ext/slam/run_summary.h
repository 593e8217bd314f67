// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SLAM_RUN_SUMMARY_H_
#define CARTOGRAPHER_EXT_SLAM_RUN_SUMMARY_H_

#include <string>

#include "cartographer_ext/slam/slam_runner.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// What was fed, what came out and what it took, for programs.
nlohmann::ordered_json ToJson(const SlamRun& run);

// The most important of it in two lines, the last one ended.
std::string ToText(const SlamRun& run);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_RUN_SUMMARY_H_
