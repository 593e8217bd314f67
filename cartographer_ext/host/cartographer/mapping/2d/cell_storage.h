// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Not part of Cartographer: how this host keeps the 16-bit cells of its grids.
// A grid grows by doubling, so most of it is never touched, and of a finished
// one most is unknown or of one value.
#ifndef CARTOGRAPHER_MAPPING_2D_CELL_STORAGE_H_
#define CARTOGRAPHER_MAPPING_2D_CELL_STORAGE_H_

#include <cstddef>
#include <vector>

#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/xy_index.h"

namespace cartographer {
namespace mapping {
namespace internal {

// Memory that is zero and, where it is large, takes no room until it is
// written.
void* AllocateZeroed(size_t bytes);
void FreeZeroed(void* memory, size_t bytes);

template <typename T>
class ZeroedAllocator {
 public:
  using value_type = T;

  ZeroedAllocator() = default;
  template <typename U>
  ZeroedAllocator(const ZeroedAllocator<U>&) {}  // NOLINT

  T* allocate(const size_t count) {
    return static_cast<T*>(AllocateZeroed(count * sizeof(T)));
  }
  void deallocate(T* const memory, const size_t count) {
    FreeZeroed(memory, count * sizeof(T));
  }
  // Elements without a value are 0 already.
  void construct(T*) {}
  void construct(T* const element, const T& value) { *element = value; }

  bool operator==(const ZeroedAllocator&) const { return true; }
  bool operator!=(const ZeroedAllocator&) const { return false; }
};

}  // namespace internal

// Row by row. Only a vector that was made with its size is zero: elements that
// are added later are whatever was there.
using FlatCells = std::vector<uint16, internal::ZeroedAllocator<uint16>>;

// Cells that do not change any more, in tiles; tiles of one value share their
// memory.
class CompactCells {
 public:
  CompactCells() = default;  // none
  CompactCells(const FlatCells& cells, const CellLimits& size);

  bool empty() const { return values_.empty(); }
  uint16 At(const int x, const int y) const { return *Cell(x, y); }
  // `count` cells from (x, y) on along the row: where they are, or copied to
  // `buffer` where they are in several tiles.
  const uint16* Run(const int x, const int y, const int count,
                    uint16* const buffer) const {
    if ((x & kTileMask) + count <= kTileSize) return Cell(x, y);
    CopyRun(x, y, count, buffer);
    return buffer;
  }
  size_t MemoryBytes() const {
    return sizeof(uint32) * tiles_.capacity() +
           sizeof(uint16) * values_.capacity();
  }

 private:
  const uint16* Cell(const int x, const int y) const {
    return values_.data() +
           tiles_[(y >> kTileBits) * tiles_per_row_ + (x >> kTileBits)] +
           ((y & kTileMask) << kTileBits) + (x & kTileMask);
  }
  void CopyRun(int x, int y, int count, uint16* cells) const;

  static constexpr int kTileBits = 4;
  static constexpr int kTileSize = 1 << kTileBits;
  static constexpr int kTileMask = kTileSize - 1;

  int tiles_per_row_ = 0;
  std::vector<uint32> tiles_;  // where in `values_` each begins
  std::vector<uint16> values_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_CELL_STORAGE_H_
