// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/coarse_grid.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "glog/logging.h"

namespace cartographer_ext {
namespace scan_matching {

SearchGrid2D CoarseGrid(const SearchGrid2D& grid, const int factor) {
  CHECK_GT(factor, 0);
  SearchGrid2D coarse;
  coarse.resolution = factor * grid.resolution;
  coarse.max_x = grid.max_x;
  coarse.max_y = grid.max_y;
  coarse.min_score = grid.min_score;
  coarse.max_score = grid.max_score;
  if (grid.num_x < 1 || grid.num_y < 1 ||
      grid.values.size() != static_cast<size_t>(grid.num_x) * grid.num_y) {
    return coarse;
  }
  coarse.num_x = (grid.num_x - 1) / factor + 1;
  coarse.num_y = (grid.num_y - 1) / factor + 1;
  coarse.values.resize(static_cast<size_t>(coarse.num_x) * coarse.num_y);
  const uint8_t* value = grid.values.data();
  for (int y = 0; y < grid.num_y; ++y) {
    uint8_t* const row =
        coarse.values.data() + static_cast<size_t>(y / factor) * coarse.num_x;
    for (int x = 0; x < grid.num_x; ++x, ++value) {
      row[x / factor] = std::max(row[x / factor], *value);
    }
  }
  return coarse;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
