// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A grid prepared for the correlative search: maxima over blocks of cells, from
// which upper bounds of scores follow.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_PREPARED_GRID_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_PREPARED_GRID_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"
#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"
#include "cartographer_ext/scan_matching/correlative_search/search_maxima.h"

namespace cartographer_ext {
namespace scan_matching {

// Width of the margin of zeros around the cells.
constexpr int kGridMargin = kBlockSize - 1;

// Maximum displacement of a point within a coarse node, in cells, to either
// side of its position in the middle rotation. A point moves perpendicular to
// its ray, so a point on one axis of the grid needs room along the other axis
// only.
struct Reach {
  int x;
  int y;
};
constexpr int kNumReaches = 5;
// Each point uses the first that is sufficient; the last is sufficient for all.
constexpr Reach kReaches[kNumReaches] = {
    {1, 1}, {1, 4}, {4, 1}, {2, 2}, {4, 4}};

// Search structures of one grid. Immutable after construction.
struct PreparedGrid {
  PreparedGrid(const SearchGrid2D& grid, int depth,
               const SearchKernels& search_kernels);

  float ToScore(const float value) const {
    return min_score + value * ((max_score - min_score) / 255.f);
  }

  const SearchKernels& kernels;
  GridGeometry geometry;
  float min_score;
  float max_score;
  int depth;               // of Cartographer's search
  RectangleMaxima blocks;  // of kBlockSize
  // The cells with kGridMargin zeros on every side.
  std::vector<uint8_t> padded;
  int padded_stride = 0;
  CoarseMaxima coarse[kNumReaches];
  // The smallest rectangle with all cells that are not 0; empty when max < min.
  OffsetBounds known;

  RectangleMaxima Cells() const;  // a copy without the margin
  size_t MemoryBytes() const;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_PREPARED_GRID_H_
