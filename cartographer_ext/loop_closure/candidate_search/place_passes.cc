// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/place_passes.h"

#include <algorithm>
#include <cmath>

#include "absl/types/optional.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kCell = 2.;  // metres
constexpr double kSector = 0.5 * kPi;

// Whether one of `passes` is within `length` metres of path of a node.
bool HasNear(const std::vector<uncertainty::VertexId>& passes,
             const uncertainty::VertexId& node, const double length,
             const uncertainty::PathUncertainty& paths) {
  return std::any_of(
      passes.begin(), passes.end(), [&](const uncertainty::VertexId& other) {
        const absl::optional<double> travelled = paths.Travelled(other, node);
        return travelled.has_value() && *travelled < length;
      });
}

}  // namespace

PlacePasses::Place PlacePasses::PlaceOf(const Pose2& pose) {
  return {
      static_cast<int>(std::floor(pose.x / kCell)),
      static_cast<int>(std::floor(pose.y / kCell)),
      static_cast<int>(std::round(NormalizeAngle(pose.theta) / kSector)) & 3};
}

void PlacePasses::Add(const uncertainty::VertexId& node, const Pose2& pose,
                      const PassLimits& limits,
                      const uncertainty::PathUncertainty& paths) {
  std::vector<uncertainty::VertexId>& passes = passes_[PlaceOf(pose)];
  if (static_cast<int>(passes.size()) < limits.most &&
      !HasNear(passes, node, limits.length, paths)) {
    passes.push_back(node);
  }
}

bool PlacePasses::Takes(const uncertainty::VertexId& node, const Pose2& pose,
                        const PassLimits& limits,
                        const uncertainty::PathUncertainty& paths) const {
  const auto found = passes_.find(PlaceOf(pose));
  return found == passes_.end() ||
         static_cast<int>(found->second.size()) < limits.most ||
         HasNear(found->second, node, limits.length, paths);
}

int PlacePasses::Count(const Pose2& pose) const {
  const auto found = passes_.find(PlaceOf(pose));
  return found == passes_.end() ? 0 : found->second.size();
}

void PlacePasses::Forget(const int trajectory_id, const int last_node_index) {
  for (auto& place : passes_) {
    std::vector<uncertainty::VertexId>& passes = place.second;
    passes.erase(std::remove_if(passes.begin(), passes.end(),
                                [&](const uncertainty::VertexId& node) {
                                  return node.IsNodeOf(trajectory_id) &&
                                         node.index() <= last_node_index;
                                }),
                 passes.end());
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
