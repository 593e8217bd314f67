// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/loop_comparison.h"

#include <algorithm>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using Key = LoopPair;

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

LoopAbsence AbsenceOf(const Key& key, const MapGraph& second,
                      const std::map<Key, const GraphConstraint*>& second_loops,
                      const LoopComparisonOptions& options) {
  if (second_loops.count(key) > 0) return LoopAbsence::kPresent;
  if (options.outcomes != nullptr) {
    const auto outcome = options.outcomes->find(key);
    if (outcome != options.outcomes->end()) {
      switch (outcome->second.kind) {
        case LoopOutcome::Kind::kTooFar:
          return LoopAbsence::kTooFar;
        case LoopOutcome::Kind::kNotSampled:
          return LoopAbsence::kNotSampled;
        case LoopOutcome::Kind::kSearched:
          return LoopAbsence::kNoMatch;
      }
    }
  }
  if (HasNeighbour(second_loops, key, options.node_tolerance)) {
    return LoopAbsence::kNeighbourInstead;
  }
  return IsTooFar(second, key, options.max_constraint_distance)
             ? LoopAbsence::kTooFar
             : LoopAbsence::kOtherVisit;
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
    result.absences.push_back(
        AbsenceOf({constraint.submap_id, constraint.node_id}, second,
                  second_loops, options));
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
      continue;
    }
    const bool has_neighbour =
        HasNeighbour(second_loops, entry.first, options.node_tolerance);
    if (has_neighbour) ++result.neighbour_instead;
    switch (AbsenceOf(entry.first, second, second_loops, options)) {
      case LoopAbsence::kTooFar:
        ++result.too_far;
        break;
      case LoopAbsence::kNotSampled:
        ++result.not_sampled;
        break;
      case LoopAbsence::kNoMatch:
        ++result.no_match;
        break;
      case LoopAbsence::kOtherVisit:
        ++result.other_visit;
        break;
      case LoopAbsence::kNeighbourInstead:
      case LoopAbsence::kPresent:
        break;
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
  const auto add = [&parts](const int64_t count, const char* const text) {
    if (count > 0) parts.push_back(absl::StrCat(count, text));
  };
  add(comparison.not_sampled,
      " within the distance limit, but skipped by the sampler, which counts "
      "the candidates of a submap");
  add(comparison.too_far, " beyond the distance limit in the other map");
  add(comparison.no_match, " searched without a match");
  add(comparison.other_visit,
      " skipped or without a match, within the distance limit");
  add(comparison.neighbour_instead,
      " of the missing ones have a node of the same visit constrained to the "
      "same submap instead");
  return absl::StrJoin(parts, "; ");
}

}  // namespace evaluation
}  // namespace cartographer_ext
