// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/cell_storage.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace internal {
namespace {

// From here on memory comes from the system. Smaller memory is used again by
// the heap, which is faster than new pages.
constexpr size_t kLarge = size_t{1} << 22;

// Whole huge pages: the system aligns only those.
constexpr size_t kHugePage = size_t{1} << 21;
size_t MappedSize(const size_t bytes) {
  return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

}  // namespace

void* AllocateZeroed(const size_t bytes) {
  void* memory = nullptr;
  if (bytes < kLarge) {
    memory = std::calloc(bytes, 1);
  } else {
    memory = mmap(nullptr, MappedSize(bytes), PROT_READ | PROT_WRITE,
                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) memory = nullptr;
#ifdef MADV_HUGEPAGE
    // Touching a grid page by page takes longer than filling it.
    if (memory != nullptr) madvise(memory, MappedSize(bytes), MADV_HUGEPAGE);
#endif
  }
  CHECK(memory != nullptr || bytes == 0) << "no memory for a grid";
  return memory;
}

void FreeZeroed(void* const memory, const size_t bytes) {
  if (bytes < kLarge) {
    std::free(memory);
  } else {
    munmap(memory, MappedSize(bytes));
  }
}

}  // namespace internal

constexpr int CompactCells::kTileBits;
constexpr int CompactCells::kTileSize;
constexpr int CompactCells::kTileMask;

CompactCells::CompactCells(const FlatCells& cells, const CellLimits& size)
    : tiles_per_row_((size.num_x_cells + kTileSize - 1) / kTileSize) {
  const int tiles_per_column = (size.num_y_cells + kTileSize - 1) / kTileSize;
  tiles_.reserve(static_cast<size_t>(tiles_per_row_) * tiles_per_column);
  std::map<uint16, uint32> uniform;  // by value
  std::array<uint16, kTileSize * kTileSize> tile;
  for (int row = 0; row != tiles_per_column; ++row) {
    for (int column = 0; column != tiles_per_row_; ++column) {
      tile.fill(0);
      const int begin_x = column * kTileSize;
      const int count = std::min(kTileSize, size.num_x_cells - begin_x);
      const int end_y = std::min(size.num_y_cells, (row + 1) * kTileSize);
      for (int y = row * kTileSize; y != end_y; ++y) {
        std::copy_n(
            cells.data() + static_cast<size_t>(y) * size.num_x_cells + begin_x,
            count, tile.data() + (y & kTileMask) * kTileSize);
      }
      const bool is_uniform =
          std::all_of(tile.begin(), tile.end(),
                      [&tile](const uint16 cell) { return cell == tile[0]; });
      const uint32 next = static_cast<uint32>(values_.size());
      const uint32 begin =
          is_uniform ? uniform.emplace(tile[0], next).first->second : next;
      tiles_.push_back(begin);
      if (begin == next)
        values_.insert(values_.end(), tile.begin(), tile.end());
    }
  }
  values_.shrink_to_fit();
}

void CompactCells::CopyRun(int x, const int y, const int count,
                           uint16* cells) const {
  const int end = x + count;
  while (x != end) {
    const int next = std::min(end, (x | kTileMask) + 1);
    cells = std::copy_n(Cell(x, y), next - x, cells);
    x = next;
  }
}

}  // namespace mapping
}  // namespace cartographer
