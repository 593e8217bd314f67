// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The inner loops of the correlative matchers, for several instruction sets.
// All sets give the same results, bit for bit: sums are of integers, and the
// floating point operations are the same ones in the same order, without fused
// multiply-add.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cartographer_ext {
namespace scan_matching {

// A rotation about z as a unit quaternion (w, 0, 0, z), a translation, and a
// grid: cell indices are
//   x = round((max_y - world_y) / resolution - 0.5),  y likewise with max_x,
// halves away from zero, bounded to +-1e8; NaN becomes the lower bound.
struct CellFrame {
  float w = 1.f;
  float z = 0.f;
  float translation_x = 0.f;
  float translation_y = 0.f;
  double max_x = 0.;
  double max_y = 0.;
  double resolution = 1.;
};

// Function pointers of one instruction set.
struct SearchKernels {
  const char* name;

  // Cells of `count` points.
  void (*find_cells)(const CellFrame& frame, const float* point_x,
                     const float* point_y, int count, int32_t* x, int32_t* y);

  // sums[j * sums_stride + i] += rows[j * row_stride + i], modulo 256, for
  // i < num_columns and j < num_rows. Up to 31 bytes to the right of both are
  // accessed, but not changed.
  void (*add_rows)(const uint8_t* rows, int row_stride, int num_columns,
                   int num_rows, uint8_t* sums, int sums_stride);

  // totals[i] += sums[i], sums[i] = 0 for i < count, a multiple of 16.
  void (*move_sums)(int count, uint8_t* sums, uint16_t* totals);

  // The sum of values[num_x * (y[i] + shift_y) + x[i] + shift_x] over those i <
  // count for which column and row are in [0, num_x) and [0, num_y). Up to 3
  // bytes beyond the last value are accessed.
  int (*sum_values)(const uint8_t* values, int num_x, int num_y,
                    const int32_t* x, const int32_t* y, int shift_x,
                    int shift_y, int count);

  // Writes stride * row + column of the same points to `places`, which must
  // have room for count + 8, and returns their number.
  int (*find_places)(int num_x, int num_y, int stride, const int32_t* x,
                     const int32_t* y, int shift_x, int shift_y, int count,
                     int32_t* places);

  // target[plane * (i % 8) + i / 8] = source[i] for i < count.
  void (*split_columns)(const uint8_t* source, int count, size_t plane,
                        uint8_t* target);

  // sums[8 * j + i] += cells[offsets[k] + stride * j + i] for all k < count and
  // i, j < 8, modulo 65536. Returns the largest sum.
  int (*add_squares)(const uint8_t* cells, int stride, const int32_t* offsets,
                     int count, uint16_t* sums);

  // bytes[i] = min(255, max(0, scale * (largest - values[i])) + 0.999),
  // truncated to an integer, for i < count. NaN becomes 0.
  void (*round_up)(const float* values, float largest, float scale, int count,
                   uint8_t* bytes);
};

// The fastest set that this machine supports.
const SearchKernels& BestSearchKernels();

// All sets that this machine supports, the plain C++ one first. For tests.
std::vector<const SearchKernels*> AllSearchKernels();

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_H_
