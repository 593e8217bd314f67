// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_maxima.h"

#include <algorithm>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

std::vector<uint8_t> RandomCells(const int count, Random* const random) {
  std::vector<uint8_t> cells(count);
  for (uint8_t& cell : cells) {
    cell = static_cast<uint8_t>(random->UniformInt(0, 255));
  }
  return cells;
}

TEST(SearchMaximaTest, RectanglesByHand) {
  // 1 5
  // 7 2
  const RectangleMaxima cells = CellMaxima({1, 5, 7, 2}, 2, 2);
  EXPECT_EQ(cells.Value(0, 1), 7);
  EXPECT_EQ(cells.Value(2, 0), 0);
  const RectangleMaxima wide = Widen(cells, 1, 0);
  EXPECT_EQ(wide.width, 2);
  EXPECT_EQ(wide.height, 1);
  EXPECT_EQ(wide.values, (std::vector<uint8_t>{1, 5, 5, 7, 7, 2}));
  const RectangleMaxima square = Widen(wide, 0, 1);
  EXPECT_EQ(square.values, (std::vector<uint8_t>{1, 5, 5, 7, 7, 5, 7, 7, 2}));
  EXPECT_EQ(square.Value(-1, -1), 1);
  EXPECT_EQ(square.Value(0, 0), 7);
  EXPECT_EQ(square.Value(1, 1), 2);
  EXPECT_EQ(square.Value(-2, 0), 0);
}

TEST(SearchMaximaTest, MaximaOfEveryRectangle) {
  Random random(3);
  for (int i = 0; i != 30; ++i) {
    const int num_x = static_cast<int>(random.UniformInt(1, 40));
    const int num_y = static_cast<int>(random.UniformInt(1, 40));
    const RectangleMaxima cells =
        CellMaxima(RandomCells(num_x * num_y, &random), num_x, num_y);
    RectangleMaxima maxima = cells;
    for (int width = 1; width != kBlockSize; width *= 2) {
      maxima = Widen(maxima, width, width);
    }
    maxima = Widen(maxima, static_cast<int>(random.UniformInt(0, 8)),
                   static_cast<int>(random.UniformInt(0, 8)));
    for (int y = -20; y != num_y + 3; ++y) {
      for (int x = -20; x != num_x + 3; ++x) {
        int expected = 0;
        for (int k = 0; k != maxima.height; ++k) {
          for (int j = 0; j != maxima.width; ++j) {
            expected = std::max(expected, cells.Value(x + j, y + k));
          }
        }
        ASSERT_EQ(maxima.Value(x, y), expected);
      }
    }
  }
}

TEST(SearchMaximaTest, CoarseValuesAreUpperBounds) {
  std::vector<uint8_t> all(256);
  for (int i = 0; i != 256; ++i) all[i] = static_cast<uint8_t>(i);
  const RectangleMaxima coarse = ToCoarse(CellMaxima(all, 256, 1));
  EXPECT_EQ(coarse.Value(0, 0), 0);
  EXPECT_EQ(coarse.Value(1, 0), 1);
  EXPECT_EQ(coarse.Value(255, 0), 31);
  for (int i = 0; i != 256; ++i) {
    const int value = coarse.Value(i, 0);
    EXPECT_GE(value * 255, i * 31);
    EXPECT_LT((value - 1) * 255, i * 31);
  }
}

TEST(SearchMaximaTest, CoarseElementsAreWhereTheySay) {
  Random random(4);
  const RectangleMaxima cells =
      CellMaxima(RandomCells(37 * 21, &random), 37, 21);
  const RectangleMaxima maxima = ToCoarse(Widen(cells, 1, 0));
  for (const SearchKernels* const kernels : AllSearchKernels()) {
    const CoarseMaxima coarse(maxima, *kernels);
    EXPECT_EQ(coarse.width(), 2);
    EXPECT_EQ(coarse.height(), 1);
    EXPECT_EQ(coarse.num_columns(), 5);  // of 38 elements
    EXPECT_EQ(coarse.num_rows(), 3);
    for (int y = 0; y != 21; ++y) {
      for (int x = -1; x != 37; ++x) {
        const int column = x + 1;
        EXPECT_EQ(coarse.Plane(column, y)[(y / 8) * 5 + column / 8],
                  maxima.Value(x, y));
      }
    }
  }
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
