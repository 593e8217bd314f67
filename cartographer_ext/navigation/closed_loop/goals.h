// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_GOALS_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_GOALS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/navigation/costmap.h"

namespace cartographer_ext {
namespace navigation {

// "x,y;x,y": metres in the map frame.
absl::StatusOr<std::vector<Eigen::Vector2d>> ParseGoals(absl::string_view text);

// `count` goals that cover different parts of what can be reached from the
// start; the last one is the start itself. Drawn from the seed.
absl::StatusOr<std::vector<Eigen::Vector2d>> DrawGoals(
    const Costmap& costmap, const Eigen::Vector2d& start, int count,
    uint64_t seed);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_GOALS_H_
