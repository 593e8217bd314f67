// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/prepared_grid.h"

#include <algorithm>
#include <utility>

namespace cartographer_ext {
namespace scan_matching {

PreparedGrid::PreparedGrid(const SearchGrid2D& grid, const int depth_in,
                           const SearchKernels& search_kernels)
    : kernels(search_kernels),
      min_score(grid.min_score),
      max_score(grid.max_score),
      depth(depth_in) {
  geometry.num_x = grid.num_x;
  geometry.num_y = grid.num_y;
  geometry.resolution = grid.resolution;
  geometry.max_x = grid.max_x;
  geometry.max_y = grid.max_y;
  blocks = CellMaxima(grid.values, grid.num_x, grid.num_y);
  // The memory of these two serves all steps.
  RectangleMaxima wide;
  const Reach& widest = kReaches[kNumReaches - 1];
  const size_t largest =
      static_cast<size_t>(grid.num_x + kBlockSize + 2 * widest.x) *
      (grid.num_y + kBlockSize + 2 * widest.y);
  blocks.values.reserve(largest);
  wide.values.reserve(largest);
  for (int width = 1; width != kBlockSize; width *= 2) {
    WidenInto(blocks, width, width, &wide);
    std::swap(blocks, wide);
  }
  const RectangleMaxima coarse_blocks = ToCoarse(blocks);
  for (int i = 0; i != kNumReaches; ++i) {
    WidenInto(coarse_blocks, 2 * kReaches[i].x, 2 * kReaches[i].y, &wide);
    coarse[i] = CoarseMaxima(wide, kernels);
  }
  // The instructions that gather bytes read three more.
  blocks.values.reserve(blocks.values.size() + 3);
  blocks.values.resize(blocks.values.size() + 3);
  padded_stride = grid.num_x + 2 * kGridMargin;
  padded.resize(static_cast<size_t>(padded_stride) *
                (grid.num_y + 2 * kGridMargin));
  known = OffsetBounds{grid.num_x, -1, grid.num_y, -1};
  for (int y = 0; y != grid.num_y; ++y) {
    const auto row = grid.values.begin() + static_cast<size_t>(y) * grid.num_x;
    std::copy(row, row + grid.num_x,
              padded.begin() +
                  static_cast<size_t>(y + kGridMargin) * padded_stride +
                  kGridMargin);
    const auto end = row + grid.num_x;
    const auto not_zero = [](const uint8_t value) { return value != 0; };
    const auto first = std::find_if(row, end, not_zero);
    if (first == end) continue;
    auto last = end - 1;
    while (*last == 0) --last;
    known.min_x = std::min(known.min_x, static_cast<int>(first - row));
    known.max_x = std::max(known.max_x, static_cast<int>(last - row));
    known.min_y = std::min(known.min_y, y);
    known.max_y = y;
  }
}

RectangleMaxima PreparedGrid::Cells() const {
  std::vector<uint8_t> values;
  values.reserve(static_cast<size_t>(geometry.num_x) * geometry.num_y);
  for (int y = 0; y != geometry.num_y; ++y) {
    const auto row = padded.begin() +
                     static_cast<size_t>(y + kGridMargin) * padded_stride +
                     kGridMargin;
    values.insert(values.end(), row, row + geometry.num_x);
  }
  return CellMaxima(values, geometry.num_x, geometry.num_y);
}

size_t PreparedGrid::MemoryBytes() const {
  size_t bytes = sizeof(*this) + blocks.values.capacity() + padded.capacity();
  for (const CoarseMaxima& maxima : coarse) bytes += maxima.MemoryBytes();
  return bytes;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
