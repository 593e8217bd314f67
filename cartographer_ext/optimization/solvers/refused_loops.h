// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a map refuses more of the loops that arrive than it did before: after
// wrong loops have bent it, it contradicts the right ones that follow.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_REFUSED_LOOPS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_REFUSED_LOOPS_H_

#include <cstddef>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Stretches of the path with loops, and those with some in force. Loops of one
// stretch are one piece of evidence.
struct Acceptance {
  int accepted = 0;
  int stretches = 0;
};

// Poses of a stretch.
constexpr int kStretchOfPath = 15;

// The stretch in which a loop arrives.
inline int StretchOf(const WhitenedEdge& loop) {
  return (loop.from > loop.to ? loop.from : loop.to) / kStretchOfPath;
}

// Of the loops from edge `begin` to before edge `end`, in the order of arrival.
Acceptance CountAccepted(const std::vector<WhitenedEdge>& edges,
                         const std::vector<bool>& accepted, size_t begin,
                         size_t end);

// The probability of as few accepted stretches as `now`, if each is accepted with
// the same, unknown probability as those `before`: beta-binomial, all probabilities
// being equally likely beforehand (Laplace's rule of succession).
double ChanceOfSoFew(const Acceptance& before, const Acceptance& now);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_REFUSED_LOOPS_H_
