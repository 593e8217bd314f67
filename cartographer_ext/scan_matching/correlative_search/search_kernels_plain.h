// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernels of search_kernels.h in plain C++; the other instruction sets use
// them for what does not fill a vector.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_PLAIN_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_PLAIN_H_

#include <cstddef>
#include <cstdint>

#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

namespace cartographer_ext {
namespace scan_matching {
namespace plain {

// Added by `round_up` before cutting off the fraction.
constexpr float kAlmostOne = 0.999f;

// Plain C++ versions of the kernels of the same names in search_kernels.h.
void FindCells(const CellFrame& frame, const float* point_x,
               const float* point_y, int count, int32_t* x, int32_t* y);
int SumValues(const uint8_t* values, int num_x, int num_y, const int32_t* x,
              const int32_t* y, int shift_x, int shift_y, int count);
int FindPlaces(int num_x, int num_y, int stride, const int32_t* x,
               const int32_t* y, int shift_x, int shift_y, int count,
               int32_t* places);
void SplitColumns(const uint8_t* source, int count, size_t plane,
                  uint8_t* target);
void RoundUp(const float* values, float largest, float scale, int count,
             uint8_t* bytes);

}  // namespace plain

// All of them.
const SearchKernels& PlainSearchKernels();

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_SEARCH_KERNELS_PLAIN_H_
