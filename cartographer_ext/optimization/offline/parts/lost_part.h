// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a map has lost a part of the path. Wrong loops that agree put a part of the
// path in a wrong place; then the map refuses the right loops between that part and
// the rest, while those within either hold. Wrong loops alone are refused everywhere
// alike, where they may be anywhere. So of each part of the path - of 15 poses, and of
// twice, four times, ... as many - the loops that lead out of it are compared with all
// others.
//
// All loops between the same two stretches of the path are one piece of evidence, in
// force if one of them is. Loops within a stretch and between neighbouring ones say
// nothing, as odometry alone explains them.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOST_PARTS_LOST_PART_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOST_PARTS_LOST_PART_H_

#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Poses from `begin` to before `end`.
struct PartOfPath {
  int begin = 0;
  int end = 0;

  // Whether exactly one end of the loop is in the part.
  bool IsLeftBy(const WhitenedEdge& loop) const {
    const auto contains = [this](const int pose) {
      return begin <= pose && pose < end;
    };
    return contains(loop.from) != contains(loop.to);
  }
};

// The part whose loops to the rest are so few in force (weight 1; refused ones have
// weight 0) as is the least a matter of chance: less than half as often as elsewhere,
// and as would come about by chance in one of a thousand graphs at most. Its ends are
// exact to a few poses as far as loops tell.
absl::optional<PartOfPath> FindLostPart(const std::vector<WhitenedEdge>& edges,
                                        const std::vector<double>& weights);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOST_PARTS_LOST_PART_H_
