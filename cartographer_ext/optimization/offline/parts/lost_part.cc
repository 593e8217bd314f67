// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/parts/lost_part.h"

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

// Stretches that loops join, and whether one of these is in force.
struct Join {
  int early = 0;
  int late = 0;
  bool in_force = false;
};

std::vector<Join> JoinStretches(const std::vector<WhitenedEdge>& edges,
                                const std::vector<double>& weights) {
  std::map<std::pair<int, int>, bool> joined;
  for (size_t i = 0; i != edges.size(); ++i) {
    const WhitenedEdge& edge = edges[i];
    if (!edge.is_loop) continue;
    const int early = std::min(edge.from, edge.to) / kStretchOfPath;
    const int late = std::max(edge.from, edge.to) / kStretchOfPath;
    if (late - early > 1) joined[{early, late}] |= weights[i] > 0.5;
  }
  std::vector<Join> result;
  for (const auto& entry : joined) {
    result.push_back({entry.first.first, entry.first.second, entry.second});
  }
  return result;
}

void Count(const Join& join, Acceptance* const acceptance) {
  ++acceptance->stretches;
  acceptance->accepted += join.in_force;
}

// What leads out of each part of `1 << level` stretches.
std::map<int, Acceptance> CountLeaving(const std::vector<Join>& joined,
                                       const int level) {
  std::map<int, Acceptance> result;
  for (const Join& join : joined) {
    const int early = join.early >> level, late = join.late >> level;
    if (early == late) continue;
    Count(join, &result[early]);
    Count(join, &result[late]);
  }
  return result;
}

// The chance of so few in force of those that leave a part, compared with the rest.
double ChanceOfPart(const Acceptance& all, const Acceptance& leaving) {
  Acceptance rest = all;
  rest.accepted -= leaving.accepted;
  rest.stretches -= leaving.stretches;
  return ChanceOfSoFew(rest, leaving);
}

// The same of the stretches from `begin` to before `end`.
double ChanceOfStretches(const std::vector<Join>& joined, const Acceptance& all,
                         const int begin, const int end) {
  const auto contains = [&](const int k) { return begin <= k && k < end; };
  Acceptance leaving;
  for (const Join& join : joined) {
    if (contains(join.early) != contains(join.late)) Count(join, &leaving);
  }
  return leaving.stretches == 0 ? 1. : ChanceOfPart(all, leaving);
}

// Moves the ends, in stretches, as long as the part becomes less a matter of chance.
void MoveEnds(const std::vector<Join>& joined, const Acceptance& all,
              double smallest, int* const begin, int* const end) {
  int last = 0;
  for (const Join& join : joined) last = std::max(last, join.late + 1);
  *end = std::min(*end, last);
  for (bool moved = true; moved;) {
    moved = false;
    const int first_begin = *begin, first_end = *end;
    for (const int step : {-1, 1}) {
      for (const bool at_end : {false, true}) {
        const int b = first_begin + (at_end ? 0 : step);
        const int e = first_end + (at_end ? step : 0);
        if (b < 0 || e > last || b >= e) continue;
        const double chance = ChanceOfStretches(joined, all, b, e);
        if (chance >= smallest) continue;
        smallest = chance;
        *begin = b;
        *end = e;
        moved = true;
      }
    }
  }
}

}  // namespace

absl::optional<PartOfPath> FindLostPart(const std::vector<WhitenedEdge>& edges,
                                        const std::vector<double>& weights) {
  const std::vector<Join> joined = JoinStretches(edges, weights);
  Acceptance all;
  for (const Join& join : joined) Count(join, &all);
  int begin = 0, end = 0, parts = 0;
  double smallest = 1.;
  for (int level = 0;; ++level) {
    const std::map<int, Acceptance> leaving = CountLeaving(joined, level);
    if (leaving.empty()) break;
    for (const auto& entry : leaving) {
      ++parts;
      const Acceptance& now = entry.second;
      if (now.accepted * (all.stretches - now.stretches) >=
          kFew * (all.accepted - now.accepted) * now.stretches) {
        continue;
      }
      const double chance = ChanceOfPart(all, now);
      if (chance >= smallest) continue;
      smallest = chance;
      begin = entry.first << level;
      end = (entry.first + 1) << level;
    }
  }
  if (parts == 0 || smallest * parts >= kNotByChance) return absl::nullopt;
  MoveEnds(joined, all, smallest, &begin, &end);
  PartOfPath part;
  part.begin = begin * kStretchOfPath;
  part.end = end * kStretchOfPath;
  return part;
}

}  // namespace optimization
}  // namespace cartographer_ext
