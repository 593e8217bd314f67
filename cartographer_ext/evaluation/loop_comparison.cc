// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/loop_comparison.h"

#include <algorithm>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using Key = std::pair<GraphId, GraphId>;  // submap, node

std::map<Key, const GraphConstraint*> LoopsByPair(const MapGraph& graph) {
  std::map<Key, const GraphConstraint*> loops;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop) {
      loops[{constraint.submap_id, constraint.node_id}] = &constraint;
    }
  }
  return loops;
}

bool HasNeighbour(const std::map<Key, const GraphConstraint*>& loops,
                  const Key& key, const int tolerance) {
  GraphId from = key.second;
  from.index -= tolerance;
  const auto it = loops.lower_bound({key.first, from});
  return it != loops.end() && it->first.first == key.first &&
         it->first.second.trajectory_id == key.second.trajectory_id &&
         it->first.second.index <= key.second.index + tolerance;
}

bool IsTooFar(const MapGraph& graph, const Key& key, const double distance) {
  const auto submap = graph.submaps.find(key.first);
  const auto node = graph.nodes.find(key.second);
  return submap == graph.submaps.end() || node == graph.nodes.end() ||
         Between(submap->second.global_pose, node->second.global_pose)
                 .translation()
                 .norm() > distance;
}

}  // namespace

LoopComparison CompareLoops(const MapGraph& first, const MapGraph& second,
                            const LoopComparisonOptions& options) {
  const auto first_loops = LoopsByPair(first);
  const auto second_loops = LoopsByPair(second);
  LoopComparison result;
  result.first = static_cast<int64_t>(first_loops.size());
  result.second = static_cast<int64_t>(second_loops.size());
  for (const GraphConstraint& constraint : first.constraints) {
    if (!constraint.is_loop) continue;
    const Key key{constraint.submap_id, constraint.node_id};
    LoopAbsence absence = LoopAbsence::kOtherVisit;
    const auto other = second_loops.find(key);
    if (other != second_loops.end()) {
      absence = LoopAbsence::kPresent;
    } else if (HasNeighbour(second_loops, key, options.node_tolerance)) {
      absence = LoopAbsence::kNeighbourInstead;
    } else if (IsTooFar(second, key, options.max_constraint_distance)) {
      absence = LoopAbsence::kTooFar;
    }
    result.absences.push_back(absence);
  }
  for (const auto& entry : first_loops) {
    const auto other = second_loops.find(entry.first);
    if (other != second_loops.end()) {
      ++result.common;
      const double difference =
          Between(entry.second->relative_pose, other->second->relative_pose)
              .translation()
              .norm();
      result.max_pose_difference =
          std::max(result.max_pose_difference, difference);
      if (difference <= options.pose_tolerance) ++result.common_same_pose;
    } else if (HasNeighbour(second_loops, entry.first,
                            options.node_tolerance)) {
      ++result.neighbour_instead;
    } else if (IsTooFar(second, entry.first, options.max_constraint_distance)) {
      ++result.too_far;
    } else {
      ++result.other_visit;
    }
  }
  const auto fraction = [&result](const int64_t count) {
    return count == 0 ? 1.
                      : static_cast<double>(result.common) /
                            static_cast<double>(count);
  };
  result.fraction_of_first = fraction(result.first);
  result.fraction_of_second = fraction(result.second);
  return result;
}

std::string ExplainMissing(const LoopComparison& comparison) {
  std::vector<std::string> parts;
  if (comparison.neighbour_instead > 0) {
    parts.push_back(absl::StrCat(
        comparison.neighbour_instead,
        " have a node of the same visit tied to the same submap instead"));
  }
  if (comparison.too_far > 0) {
    parts.push_back(absl::StrCat(comparison.too_far,
                                 " lie too far apart in the other map to be "
                                 "searched"));
  }
  if (comparison.other_visit > 0) {
    parts.push_back(absl::StrCat(
        comparison.other_visit,
        " were not tried, or found no match good enough, though near enough"));
  }
  return absl::StrJoin(parts, "; ");
}

}  // namespace evaluation
}  // namespace cartographer_ext
