// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_kernels_plain.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace scan_matching {
namespace {

// As lround, but without a function call and defined for every number.
inline int32_t RoundIndex(const double value) {
  constexpr double kFarAway = 1e8;
  // The largest number below 0.5: so 0.49999999999999994 does not become 1.
  constexpr double kAlmostHalf = 0.49999999999999994;
  // In this order NaN becomes the lower bound.
  const double bounded = std::min(kFarAway, std::max(-kFarAway, value));
  return static_cast<int32_t>(bounded + std::copysign(kAlmostHalf, bounded));
}

void AddRows(const uint8_t* rows, const int row_stride, const int num_columns,
             const int num_rows, uint8_t* sums, const int sums_stride) {
  for (int j = 0; j != num_rows; ++j, rows += row_stride, sums += sums_stride) {
    for (int i = 0; i != num_columns; ++i) {
      sums[i] = static_cast<uint8_t>(sums[i] + rows[i]);
    }
  }
}

void MoveSums(const int count, uint8_t* const sums, uint16_t* const totals) {
  for (int i = 0; i != count; ++i) {
    totals[i] = static_cast<uint16_t>(totals[i] + sums[i]);
    sums[i] = 0;
  }
}

int AddSquares(const uint8_t* const cells, const int stride,
               const int32_t* const offsets, const int count,
               uint16_t* const sums) {
  for (int k = 0; k != count; ++k) {
    const uint8_t* row = cells + offsets[k];
    for (int j = 0; j != 8; ++j, row += stride) {
      for (int i = 0; i != 8; ++i) {
        sums[8 * j + i] = static_cast<uint16_t>(sums[8 * j + i] + row[i]);
      }
    }
  }
  return *std::max_element(sums, sums + 64);
}

}  // namespace

namespace plain {

// The operations of a quaternion-vector product that do not vanish, in Eigen's
// order: with u = 2 q x p, the result is p + w u + q x u.
void FindCells(const CellFrame& frame, const float* __restrict const point_x,
               const float* __restrict const point_y, const int count,
               int32_t* __restrict const x, int32_t* __restrict const y) {
  const float w = frame.w;
  const float z = frame.z;
  const float translation_x = frame.translation_x;
  const float translation_y = frame.translation_y;
  const double max_x = frame.max_x;
  const double max_y = frame.max_y;
  const double resolution = frame.resolution;
  for (int i = 0; i < count; ++i) {
    const float half_u = -(z * point_y[i]);
    const float half_v = z * point_x[i];
    const float u = half_u + half_u;
    const float v = half_v + half_v;
    const float world_x = ((point_x[i] + w * u) - z * v) + translation_x;
    const float world_y = ((point_y[i] + w * v) + z * u) + translation_y;
    x[i] = RoundIndex((max_y - world_y) / resolution - 0.5);
    y[i] = RoundIndex((max_x - world_x) / resolution - 0.5);
  }
}

int SumValues(const uint8_t* const values, const int num_x, const int num_y,
              const int32_t* const x, const int32_t* const y, const int shift_x,
              const int shift_y, const int count) {
  int sum = 0;
  for (int i = 0; i != count; ++i) {
    const unsigned column = x[i] + shift_x;
    const unsigned row = y[i] + shift_y;
    if (column < static_cast<unsigned>(num_x) &&
        row < static_cast<unsigned>(num_y)) {
      sum += values[row * num_x + column];
    }
  }
  return sum;
}

int FindPlaces(const int num_x, const int num_y, const int stride,
               const int32_t* const x, const int32_t* const y,
               const int shift_x, const int shift_y, const int count,
               int32_t* const places) {
  int num_places = 0;
  for (int i = 0; i != count; ++i) {
    const unsigned column = x[i] + shift_x;
    const unsigned row = y[i] + shift_y;
    places[num_places] = static_cast<int32_t>(row * stride + column);
    num_places += column < static_cast<unsigned>(num_x) &&
                  row < static_cast<unsigned>(num_y);
  }
  return num_places;
}

void SplitColumns(const uint8_t* const source, const int count,
                  const size_t plane, uint8_t* const target) {
  for (int i = 0; i != count; ++i) target[plane * (i % 8) + i / 8] = source[i];
}

void RoundUp(const float* const values, const float largest, const float scale,
             const int count, uint8_t* const bytes) {
  for (int i = 0; i != count; ++i) {
    const float steps = (largest - values[i]) * scale;
    bytes[i] = static_cast<uint8_t>(
        std::min(255.f, std::max(0.f, steps) + kAlmostOne));
  }
}

}  // namespace plain

const SearchKernels& PlainSearchKernels() {
  static constexpr SearchKernels kKernels = {"plain",
                                             &plain::FindCells,
                                             &AddRows,
                                             &MoveSums,
                                             &plain::SumValues,
                                             &plain::FindPlaces,
                                             &plain::SplitColumns,
                                             &AddSquares,
                                             &plain::RoundUp};
  return kKernels;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
