// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_maxima.h"

#include <algorithm>

namespace cartographer_ext {
namespace scan_matching {
namespace {

// target[i] = max(a[i], b[i]); compilers vectorise it.
void Larger(const uint8_t* const a, const uint8_t* const b, const int count,
            uint8_t* const target) {
  for (int i = 0; i < count; ++i) target[i] = a[i] > b[i] ? a[i] : b[i];
}

}  // namespace

RectangleMaxima CellMaxima(const std::vector<uint8_t>& cells, const int num_x,
                           const int num_y) {
  RectangleMaxima maxima;
  maxima.num_x = num_x;
  maxima.num_y = num_y;
  maxima.values = cells;
  return maxima;
}

RectangleMaxima Widen(const RectangleMaxima& maxima, const int more_x,
                      const int more_y) {
  RectangleMaxima wide;
  WidenInto(maxima, more_x, more_y, &wide);
  return wide;
}

void WidenInto(const RectangleMaxima& maxima, const int more_x,
               const int more_y, RectangleMaxima* const result) {
  RectangleMaxima& wide = *result;
  wide.width = maxima.width + more_x;
  wide.height = maxima.height + more_y;
  wide.num_x = maxima.num_x + more_x;
  wide.num_y = maxima.num_y + more_y;
  const int num_x = maxima.num_x;
  wide.values.resize(static_cast<size_t>(wide.num_x) * wide.num_y);
  std::fill_n(wide.values.begin(), static_cast<size_t>(wide.num_x) * more_y,
              uint8_t{0});
  // A wide rectangle is two narrow ones, the second `more_x` cells on; in
  // memory the first of them is `more_x` places behind, as the wide picture
  // begins earlier. No picture is narrower than its rectangles.
  for (int y = 0; y != maxima.num_y; ++y) {
    const uint8_t* const narrow =
        maxima.values.data() + static_cast<size_t>(y) * num_x;
    uint8_t* const target =
        wide.values.data() + static_cast<size_t>(y + more_y) * wide.num_x;
    std::copy(narrow, narrow + more_x, target);
    Larger(narrow + more_x, narrow, num_x - more_x, target + more_x);
    std::copy(narrow + num_x - more_x, narrow + num_x, target + num_x);
  }
  // Rows likewise, from the first on: row y still holds the narrow ones at
  // y - more_y when it is needed.
  for (int y = 0; more_y != 0 && y != maxima.num_y; ++y) {
    uint8_t* const target =
        wide.values.data() + static_cast<size_t>(y) * wide.num_x;
    Larger(target, target + static_cast<size_t>(more_y) * wide.num_x,
           wide.num_x, target);
  }
}

RectangleMaxima ToCoarse(const RectangleMaxima& maxima) {
  uint8_t steps[256];
  for (int i = 0; i != 256; ++i) {
    steps[i] = static_cast<uint8_t>((i * CoarseMaxima::kMaxValue + 254) / 255);
  }
  RectangleMaxima coarse = maxima;
  for (uint8_t& value : coarse.values) value = steps[value];
  return coarse;
}

CoarseMaxima::CoarseMaxima(const RectangleMaxima& maxima,
                           const SearchKernels& kernels)
    : width_(maxima.width),
      height_(maxima.height),
      num_columns_((maxima.num_x + kBlockSize - 1) / kBlockSize),
      num_rows_((maxima.num_y + kBlockSize - 1) / kBlockSize) {
  const size_t plane = static_cast<size_t>(num_columns_) * num_rows_;
  values_.resize(plane * kBlockSize * kBlockSize + 31);
  for (int y = 0; y != maxima.num_y; ++y) {
    kernels.split_columns(
        maxima.values.data() + static_cast<size_t>(y) * maxima.num_x,
        maxima.num_x, plane,
        values_.data() + (y % kBlockSize) * kBlockSize * plane +
            static_cast<size_t>(y / kBlockSize) * num_columns_);
  }
}

}  // namespace scan_matching
}  // namespace cartographer_ext
