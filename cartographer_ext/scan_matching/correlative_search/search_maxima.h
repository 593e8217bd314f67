// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What FastCorrelativeSearch2D prepares of a grid: its cells and the largest
// values of squares of cells, each in the order in which they will be read.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_MAXIMA_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_MAXIMA_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

namespace cartographer_ext {
namespace scan_matching {

// Offsets are searched in blocks of this many in x and in y.
constexpr int kBlockSize = 8;

// Element (x, y), at row-major place, is the largest value of the `width` x
// `height` cells that begin at (x, y). There are elements for all rectangles
// that touch the grid, x >= 1 - width, y >= 1 - height; all others would be 0.
struct RectangleMaxima {
  int width = 1;
  int height = 1;
  int num_x = 0;  // elements per row
  int num_y = 0;
  std::vector<uint8_t> values;

  // 0 outside.
  int Value(const int x, const int y) const {
    const int column = x + width - 1;
    const int row = y + height - 1;
    if (static_cast<unsigned>(column) >= static_cast<unsigned>(num_x) ||
        static_cast<unsigned>(row) >= static_cast<unsigned>(num_y)) {
      return 0;
    }
    return values[static_cast<size_t>(row) * num_x + column];
  }
};

// Of `num_x` x `num_y` cells, row by row, rectangles of one cell.
RectangleMaxima CellMaxima(const std::vector<uint8_t>& cells, int num_x,
                           int num_y);

// Rectangles larger by `more_x` <= width and `more_y` <= height cells.
RectangleMaxima Widen(const RectangleMaxima& maxima, int more_x, int more_y);
// The same; reuses the memory of `*wide`, another object, where it suffices.
void WidenInto(const RectangleMaxima& maxima, int more_x, int more_y,
               RectangleMaxima* wide);

// The values in steps of 255 / 31, rounded up.
RectangleMaxima ToCoarse(const RectangleMaxima& maxima);

// RectangleMaxima of ToCoarse in another order:
// elements kBlockSize apart are neighbours. Element (x, y) with column c = x +
// width - 1 and row r = y + height - 1 is found in plane (c % 8, r % 8), which
// is a row-major picture, at (c / 8, r / 8).
class CoarseMaxima {
 public:
  // This many values sum to at most 255.
  static constexpr int kNumPerByte = 8;
  static constexpr int kMaxValue = 31;

  CoarseMaxima() = default;
  // The values of `maxima` must be those of ToCoarse.
  CoarseMaxima(const RectangleMaxima& maxima, const SearchKernels& kernels);

  int width() const { return width_; }
  int height() const { return height_; }
  int num_columns() const { return num_columns_; }  // of a plane
  int num_rows() const { return num_rows_; }
  // Of plane (c % 8, r % 8); 31 bytes beyond its end may be read.
  const uint8_t* Plane(const int column, const int row) const {
    return values_.data() +
           static_cast<size_t>((row & 7) * kBlockSize + (column & 7)) *
               num_columns_ * num_rows_;
  }
  size_t MemoryBytes() const { return values_.capacity(); }

 private:
  int width_ = 1;
  int height_ = 1;
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<uint8_t> values_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_MAXIMA_H_
