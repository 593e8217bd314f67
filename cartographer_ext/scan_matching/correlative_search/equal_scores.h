// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Selects among several poses with the same best score the one that
// Cartographer's depth-first branch and bound finds first. It starts from all
// squares of 2^(depth - 1) x 2^(depth - 1) offsets, counted from the smallest
// offsets of each rotation, the highest bound first; each square is divided
// into four, again the highest bound first. Squares with equal bounds keep the
// order rotation, x, y.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_EQUAL_SCORES_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_EQUAL_SCORES_H_

#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"
#include "cartographer_ext/scan_matching/correlative_search/search_maxima.h"

namespace cartographer_ext {
namespace scan_matching {

// A rotation and an offset in cells.
struct DiscretePose {
  int rotation = 0;
  int x = 0;
  int y = 0;
};

// Resolves ties, see above. Not thread-safe.
class EqualScores {
 public:
  // All arguments must outlive this object. `cells` has squares of one cell,
  // `blocks` of kBlockSize.
  EqualScores(const RectangleMaxima& cells, const RectangleMaxima& blocks,
              int depth, RotatedScans* scans);

  // The first of some poses with equal sums, not empty.
  DiscretePose First(const std::vector<DiscretePose>& poses) const;

  // The first of all poses with a sum of `sum` or more; at least one exists.
  // Used if there are too many to list.
  DiscretePose FirstOfAll(int sum) const;

 private:
  struct Square {
    DiscretePose pose;  // of its smallest offsets
    int sum;
  };

  static bool Before(const Square& a, const Square& b);
  bool MeetsFirst(const DiscretePose& a, const DiscretePose& b) const;
  Square Ancestor(const DiscretePose& pose, int level) const;
  // Upper bound of the poses in a square of 2^level x 2^level offsets.
  int Bound(const DiscretePose& pose, int level) const;
  bool Descend(const std::vector<RectangleMaxima>& levels, const Square& square,
               int level, int sum, DiscretePose* found) const;
  int Sum(const RectangleMaxima& maxima, const DiscretePose& pose) const;

  const RectangleMaxima& cells_;
  const RectangleMaxima& blocks_;
  const int top_level_;
  RotatedScans* const scans_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_EQUAL_SCORES_H_
