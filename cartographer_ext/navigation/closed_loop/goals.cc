// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/goals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/navigation/path_planner.h"
#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr uint64_t kStream = 103;
constexpr int kCandidates = 12;  // of which the farthest from others is taken
constexpr int kAttempts = 20000;
constexpr double kClearance = 0.5;  // metres to obstacles

}  // namespace

absl::StatusOr<std::vector<Eigen::Vector2d>> ParseGoals(
    const absl::string_view text) {
  std::vector<Eigen::Vector2d> goals;
  for (const absl::string_view pair : absl::StrSplit(text, ';')) {
    const std::vector<absl::string_view> words = absl::StrSplit(pair, ',');
    Eigen::Vector2d goal;
    if (words.size() != 2 || !absl::SimpleAtod(words[0], &goal.x()) ||
        !absl::SimpleAtod(words[1], &goal.y()) || !goal.allFinite()) {
      return absl::InvalidArgumentError(
          absl::StrCat("goal ", goals.size() + 1, " \"", pair,
                       "\" is not X,Y (metres); goals are X,Y;X,Y or auto"));
    }
    goals.push_back(goal);
  }
  return goals;
}

absl::StatusOr<std::vector<Eigen::Vector2d>> DrawGoals(
    const Costmap& costmap, const Eigen::Vector2d& start, const int count,
    const uint64_t seed) {
  Random random(simulation::MixBits(simulation::MixBits(seed) ^ kStream));
  const GridGeometry& geometry = costmap.geometry();
  PathPlanner planner(&costmap);
  std::vector<Eigen::Vector2d> goals, apart = {start};
  while (static_cast<int>(goals.size()) + 1 < count) {
    // The candidate that is farthest from the start and the goals so far.
    Eigen::Vector2d best = start;
    double farthest = -1.;
    int candidates = 0;
    for (int attempt = 0; attempt != kAttempts && candidates != kCandidates;
         ++attempt) {
      const Cell cell{
          static_cast<int>(random.UniformInt(0, geometry.width() - 1)),
          static_cast<int>(random.UniformInt(0, geometry.height() - 1))};
      const Eigen::Vector2d goal = geometry.Center(cell);
      if (costmap.ObstacleDistance(cell) <
              costmap.options().inscribed_radius + kClearance ||
          !planner.MakePlan(start, goal, nullptr).found()) {
        continue;
      }
      ++candidates;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector2d& other : apart) {
        nearest = std::min(nearest, (other - goal).norm());
      }
      if (nearest > farthest) {
        farthest = nearest;
        best = goal;
      }
    }
    if (candidates == 0) {
      return absl::InvalidArgumentError(
          "the map has no room for goals that the robot can reach");
    }
    goals.push_back(best);
    apart.push_back(best);
  }
  goals.push_back(start);
  return goals;
}

}  // namespace navigation
}  // namespace cartographer_ext
