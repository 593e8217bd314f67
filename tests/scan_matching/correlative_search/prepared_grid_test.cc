// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/prepared_grid.h"

#include <algorithm>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// 20 x 12 cells, known from (3, 2) to (9, 7).
SearchGrid2D Grid() {
  Random random(5);
  SearchGrid2D grid;
  grid.num_x = 20;
  grid.num_y = 12;
  grid.resolution = 0.05;
  grid.min_score = 0.1f;
  grid.max_score = 0.9f;
  grid.values.assign(20 * 12, 0);
  for (int y = 2; y <= 7; ++y) {
    for (int x = 3; x <= 9; ++x) {
      grid.values[20 * y + x] = static_cast<uint8_t>(random.UniformInt(1, 255));
    }
  }
  return grid;
}

TEST(PreparedGridTest, KnowsTheRectangleOfKnownCells) {
  const PreparedGrid prepared(Grid(), 7, BestSearchKernels());
  EXPECT_EQ(prepared.known.min_x, 3);
  EXPECT_EQ(prepared.known.max_x, 9);
  EXPECT_EQ(prepared.known.min_y, 2);
  EXPECT_EQ(prepared.known.max_y, 7);
  SearchGrid2D unknown = Grid();
  std::fill(unknown.values.begin(), unknown.values.end(), uint8_t{0});
  const PreparedGrid empty(unknown, 7, BestSearchKernels());
  EXPECT_LT(empty.known.max_x, empty.known.min_x);
}

TEST(PreparedGridTest, CellsKeepTheirValuesWithinTheMargin) {
  const SearchGrid2D grid = Grid();
  const PreparedGrid prepared(grid, 7, BestSearchKernels());
  EXPECT_EQ(prepared.padded_stride, 20 + 2 * kGridMargin);
  const RectangleMaxima cells = prepared.Cells();
  for (int y = 0; y != grid.num_y; ++y) {
    for (int x = 0; x != grid.num_x; ++x) {
      const uint8_t value = grid.values[grid.num_x * y + x];
      EXPECT_EQ(cells.Value(x, y), value);
      EXPECT_EQ(prepared.padded[prepared.padded_stride * (y + kGridMargin) + x +
                                kGridMargin],
                value);
    }
  }
  EXPECT_EQ(prepared.padded.front(), 0);
  EXPECT_EQ(prepared.padded.back(), 0);
  EXPECT_GT(prepared.MemoryBytes(), prepared.padded.size());
}

TEST(PreparedGridTest, BlocksAreMaximaOfEightByEight) {
  const SearchGrid2D grid = Grid();
  const PreparedGrid prepared(grid, 7, BestSearchKernels());
  for (int y = 0; y != grid.num_y; ++y) {
    for (int x = 0; x != grid.num_x; ++x) {
      int expected = 0;
      for (int j = y; j != std::min(y + kBlockSize, grid.num_y); ++j) {
        for (int i = x; i != std::min(x + kBlockSize, grid.num_x); ++i) {
          expected = std::max<int>(expected, grid.values[grid.num_x * j + i]);
        }
      }
      EXPECT_EQ(prepared.blocks.Value(x, y), expected);
    }
  }
}

TEST(PreparedGridTest, ScoresAreLinearInTheValue) {
  const PreparedGrid prepared(Grid(), 7, BestSearchKernels());
  EXPECT_FLOAT_EQ(prepared.ToScore(0.f), 0.1f);
  EXPECT_FLOAT_EQ(prepared.ToScore(255.f), 0.9f);
  EXPECT_FLOAT_EQ(prepared.ToScore(127.5f), 0.5f);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
