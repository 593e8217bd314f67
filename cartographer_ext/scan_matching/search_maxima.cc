// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/search_maxima.h"

#include <algorithm>

namespace cartographer_ext {
namespace scan_matching {
namespace {

// target[i] = max(a[i], b[i]); compilers make vector instructions of it.
void Larger(const uint8_t* const a, const uint8_t* const b, const int count,
            uint8_t* const target) {
  for (int i = 0; i < count; ++i) target[i] = a[i] > b[i] ? a[i] : b[i];
}

}  // namespace

SquareMaxima CellMaxima(const std::vector<uint8_t>& cells, const int num_x,
                        const int num_y) {
  SquareMaxima maxima;
  maxima.num_x = num_x;
  maxima.num_y = num_y;
  maxima.values = cells;
  return maxima;
}

SquareMaxima Widen(const SquareMaxima& maxima, const int more) {
  SquareMaxima wide;
  wide.width = maxima.width + more;
  wide.num_x = maxima.num_x + more;
  wide.num_y = maxima.num_y + more;
  const int num_x = maxima.num_x;
  wide.values.resize(static_cast<size_t>(wide.num_x) * wide.num_y);
  // A wide square is two narrow ones, the second `more` cells on; in memory the
  // first of them is `more` places behind, as the wide picture begins earlier.
  for (int y = 0; y != maxima.num_y; ++y) {
    const uint8_t* const narrow =
        maxima.values.data() + static_cast<size_t>(y) * num_x;
    uint8_t* const target =
        wide.values.data() + static_cast<size_t>(y + more) * wide.num_x;
    const int apart = std::min(more, num_x);
    std::copy(narrow, narrow + apart, target);
    std::fill(target + apart, target + more, uint8_t{0});
    Larger(narrow + more, narrow, num_x - more, target + more);
    std::copy(narrow + std::max(0, num_x - more), narrow + num_x,
              target + std::max(more, num_x));
  }
  // Rows likewise, from the first on: row y still holds the narrow squares at
  // y - more when it is needed.
  for (int y = 0; y != maxima.num_y; ++y) {
    uint8_t* const target =
        wide.values.data() + static_cast<size_t>(y) * wide.num_x;
    const uint8_t* const later =
        target + static_cast<size_t>(more) * wide.num_x;
    Larger(target, later, wide.num_x, target);
  }
  return wide;
}

CoarseMaxima::CoarseMaxima(const SquareMaxima& maxima)
    : width_(maxima.width),
      num_columns_((maxima.num_x + kBlockSize - 1) / kBlockSize),
      num_rows_((maxima.num_y + kBlockSize - 1) / kBlockSize) {
  const size_t plane = static_cast<size_t>(num_columns_) * num_rows_;
  values_.resize(plane * kBlockSize * kBlockSize + 31);
  uint8_t steps[256];
  for (int i = 0; i != 256; ++i) {
    steps[i] = static_cast<uint8_t>((i * kMaxValue + 254) / 255);
  }
  for (int y = 0; y != maxima.num_y; ++y) {
    const uint8_t* const source =
        maxima.values.data() + static_cast<size_t>(y) * maxima.num_x;
    uint8_t* const target = values_.data() +
                            (y % kBlockSize) * kBlockSize * plane +
                            static_cast<size_t>(y / kBlockSize) * num_columns_;
    for (int first = 0; first != kBlockSize; ++first) {
      uint8_t* place = target + first * plane;
      for (int x = first; x < maxima.num_x; x += kBlockSize) {
        *place++ = steps[source[x]];
      }
    }
  }
}

}  // namespace scan_matching
}  // namespace cartographer_ext
