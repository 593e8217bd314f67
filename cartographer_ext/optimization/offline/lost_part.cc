// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/lost_part.h"

#include <algorithm>
#include <map>
#include <utility>

#include "cartographer_ext/optimization/solvers/refused_loops.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// So few loops in force, in any of the parts, are no matter of chance.
constexpr double kNotByChance = 0.001;
// Of as many as elsewhere. A part that is lost has lost most of its loops, while small
// differences are found in any graph.
constexpr double kFew = 0.5;

// Pairs of stretches that loops join, and whether one of these is in force.
using JoinedStretches = std::map<std::pair<int, int>, bool>;

JoinedStretches JoinStretches(const std::vector<WhitenedEdge>& edges,
                              const std::vector<double>& weights) {
  JoinedStretches result;
  for (size_t i = 0; i != edges.size(); ++i) {
    const WhitenedEdge& edge = edges[i];
    if (!edge.is_loop) continue;
    const int early = std::min(edge.from, edge.to) / kStretchOfPath;
    const int late = std::max(edge.from, edge.to) / kStretchOfPath;
    if (late - early > 1) result[{early, late}] |= weights[i] > 0.5;
  }
  return result;
}

// What leads out of each part of `1 << level` stretches.
std::map<int, Acceptance> CountLeaving(const JoinedStretches& joined,
                                       const int level) {
  std::map<int, Acceptance> result;
  for (const auto& entry : joined) {
    const int early = entry.first.first >> level;
    const int late = entry.first.second >> level;
    if (early == late) continue;
    for (const int part : {early, late}) {
      ++result[part].stretches;
      result[part].accepted += entry.second;
    }
  }
  return result;
}

}  // namespace

absl::optional<PartOfPath> FindLostPart(const std::vector<WhitenedEdge>& edges,
                                        const std::vector<double>& weights) {
  const JoinedStretches joined = JoinStretches(edges, weights);
  Acceptance all;
  for (const auto& entry : joined) {
    ++all.stretches;
    all.accepted += entry.second;
  }
  PartOfPath part;
  double smallest = 1.;
  int parts = 0;
  for (int level = 0;; ++level) {
    const std::map<int, Acceptance> leaving = CountLeaving(joined, level);
    if (leaving.empty()) break;
    for (const auto& entry : leaving) {
      ++parts;
      const Acceptance& now = entry.second;
      Acceptance rest = all;
      rest.accepted -= now.accepted;
      rest.stretches -= now.stretches;
      if (now.accepted * rest.stretches >=
          kFew * rest.accepted * now.stretches) {
        continue;
      }
      const double chance = ChanceOfSoFew(rest, now);
      if (chance >= smallest) continue;
      smallest = chance;
      const int length = kStretchOfPath << level;
      part = {entry.first * length, (entry.first + 1) * length};
    }
  }
  if (parts == 0 || smallest * parts >= kNotByChance) return absl::nullopt;
  return part;
}

}  // namespace optimization
}  // namespace cartographer_ext
