// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A grid of larger cells, to find places roughly. A whole submap has as many
// offsets as cells and as many rotations as the range of the scan has cells, so
// that cells k times as large leave one pose of k^3.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_COARSE_GRID_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_COARSE_GRID_H_

#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"

namespace cartographer_ext {
namespace scan_matching {

// Each cell has the largest value of `factor` x `factor` cells, `factor` > 0;
// at the far borders of fewer. A grid whose dimensions do not match its values
// becomes empty.
SearchGrid2D CoarseGrid(const SearchGrid2D& grid, int factor);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_COARSE_GRID_H_
