// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads cells of the host's grids along rows.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_ROWS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_ROWS_H_

#include "Eigen/Core"

namespace cartographer_ext {
namespace scan_matching {
namespace internal {

// The bundled host copies runs of cells at once; Cartographer does not.
template <typename Grid>
auto CopyCosts(const Grid& grid, const int x, const int y, const int count,
               float* const costs, int)
    -> decltype(grid.CopyCorrespondenceCosts(x, y, count, costs)) {
  grid.CopyCorrespondenceCosts(x, y, count, costs);
}
template <typename Grid>
void CopyCosts(const Grid& grid, const int x, const int y, const int count,
               float* const costs, long) {  // NOLINT
  for (int i = 0; i != count; ++i) {
    costs[i] = grid.GetCorrespondenceCost(Eigen::Array2i(x + i, y));
  }
}

}  // namespace internal

// GetCorrespondenceCost of `count` cells from (x, y) on with x growing, inside
// the grid or not.
template <typename Grid>
void CopyCosts(const Grid& grid, const int x, const int y, const int count,
               float* const costs) {
  internal::CopyCosts(grid, x, y, count, costs, 0);
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_ROWS_H_
