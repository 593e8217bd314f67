// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_kernels_x86.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define CARTOGRAPHER_EXT_X86_KERNELS 1
#include <immintrin.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cartographer_ext/scan_matching/correlative_search/search_kernels_plain.h"
#endif

namespace cartographer_ext {
namespace scan_matching {

#ifdef CARTOGRAPHER_EXT_X86_KERNELS
namespace {

// A mask: read from position 32 - n, it gives n bytes of 0xff, then zeros.
alignas(64) constexpr uint8_t kMask[64] = {
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255};

inline __m128i Load16(const void* const from) {
  return _mm_loadu_si128(static_cast<const __m128i*>(from));
}
inline void Store16(const __m128i value, void* const to) {
  _mm_storeu_si128(static_cast<__m128i*>(to), value);
}
inline __m128i Load8(const void* const from) {
  return _mm_loadl_epi64(static_cast<const __m128i*>(from));
}

// SSE2 is part of every x86-64.
void AddRowsSse2(const uint8_t* rows, const int row_stride,
                 const int num_columns, const int num_rows, uint8_t* sums,
                 const int sums_stride) {
  const int full = num_columns & ~15;
  const __m128i mask = Load16(kMask + 32 - (num_columns - full));
  for (int j = 0; j != num_rows; ++j, rows += row_stride, sums += sums_stride) {
    for (int i = 0; i != full; i += 16) {
      Store16(_mm_add_epi8(Load16(sums + i), Load16(rows + i)), sums + i);
    }
    if (full != num_columns) {
      Store16(_mm_add_epi8(Load16(sums + full),
                           _mm_and_si128(mask, Load16(rows + full))),
              sums + full);
    }
  }
}

void MoveSumsSse2(const int count, uint8_t* const sums,
                  uint16_t* const totals) {
  const __m128i zero = _mm_setzero_si128();
  for (int i = 0; i != count; i += 16) {
    const __m128i values = Load16(sums + i);
    Store16(zero, sums + i);
    Store16(_mm_add_epi16(Load16(totals + i), _mm_unpacklo_epi8(values, zero)),
            totals + i);
    Store16(
        _mm_add_epi16(Load16(totals + i + 8), _mm_unpackhi_epi8(values, zero)),
        totals + i + 8);
  }
}

int AddSquaresSse2(const uint8_t* const cells, const int stride,
                   const int32_t* const offsets, const int count,
                   uint16_t* const sums) {
  const __m128i zero = _mm_setzero_si128();
  __m128i rows[8];
  for (int j = 0; j != 8; ++j) rows[j] = Load16(sums + 8 * j);
  for (int k = 0; k != count; ++k) {
    const uint8_t* const square = cells + offsets[k];
    for (int j = 0; j != 8; ++j) {
      rows[j] = _mm_add_epi16(
          rows[j], _mm_unpacklo_epi8(Load8(square + stride * j), zero));
    }
  }
  // The larger of unsigned numbers is a + max(0, b - a).
  __m128i largest = zero;
  for (int j = 0; j != 8; ++j) {
    Store16(rows[j], sums + 8 * j);
    largest = _mm_add_epi16(largest, _mm_subs_epu16(rows[j], largest));
  }
  uint16_t eight[8];
  Store16(largest, eight);
  return *std::max_element(eight, eight + 8);
}

// Four rounds of interleaving the first with the second half of 128 bytes make
// a transposed matrix of 16 x 8.
void SplitColumnsSse2(const uint8_t* const source, const int count,
                      const size_t plane, uint8_t* const target) {
  int i = 0;
  for (; i + 128 <= count; i += 128) {
    __m128i rows[8];
    __m128i next[8];
    for (int j = 0; j != 8; ++j) rows[j] = Load16(source + i + 16 * j);
    for (int round = 0; round != 4; ++round) {
      for (int j = 0; j != 4; ++j) {
        next[2 * j] = _mm_unpacklo_epi8(rows[j], rows[j + 4]);
        next[2 * j + 1] = _mm_unpackhi_epi8(rows[j], rows[j + 4]);
      }
      for (int j = 0; j != 8; ++j) rows[j] = next[j];
    }
    for (int j = 0; j != 8; ++j) Store16(rows[j], target + plane * j + i / 8);
  }
  plain::SplitColumns(source + i, count - i, plane, target + i / 8);
}

void RoundUpSse2(const float* const values, const float largest,
                 const float scale, const int count, uint8_t* const bytes) {
  const __m128 zero = _mm_setzero_ps();
  int i = 0;
  for (; i + 16 <= count; i += 16) {
    __m128i whole[4];
    for (int j = 0; j != 4; ++j) {
      const __m128 steps = _mm_mul_ps(
          _mm_sub_ps(_mm_set1_ps(largest), _mm_loadu_ps(values + i + 4 * j)),
          _mm_set1_ps(scale));
      // NaN becomes the second operand.
      whole[j] = _mm_cvttps_epi32(_mm_min_ps(
          _mm_add_ps(_mm_max_ps(steps, zero), _mm_set1_ps(plain::kAlmostOne)),
          _mm_set1_ps(255.f)));
    }
    Store16(_mm_packus_epi16(_mm_packs_epi32(whole[0], whole[1]),
                             _mm_packs_epi32(whole[2], whole[3])),
            bytes + i);
  }
  plain::RoundUp(values + i, largest, scale, count - i, bytes + i);
}

constexpr SearchKernels kSse2 = {"sse2",
                                 &plain::FindCells,
                                 &AddRowsSse2,
                                 &MoveSumsSse2,
                                 &plain::SumValues,
                                 &plain::FindPlaces,
                                 &SplitColumnsSse2,
                                 &AddSquaresSse2,
                                 &RoundUpSse2};

// round((max - world) / resolution - 0.5) of four.
__attribute__((target("avx2"))) inline __m128i FourIndices(
    const double max, const __m128 world, const double resolution) {
  const __m256d value = _mm256_sub_pd(
      _mm256_div_pd(_mm256_sub_pd(_mm256_set1_pd(max), _mm256_cvtps_pd(world)),
                    _mm256_set1_pd(resolution)),
      _mm256_set1_pd(0.5));
  // Of a NaN and a number, these instructions return the second operand.
  const __m256d bounded = _mm256_min_pd(
      _mm256_max_pd(value, _mm256_set1_pd(-1e8)), _mm256_set1_pd(1e8));
  const __m256d almost_half =
      _mm256_or_pd(_mm256_set1_pd(0.49999999999999994),
                   _mm256_and_pd(_mm256_set1_pd(-0.), bounded));
  return _mm256_cvttpd_epi32(_mm256_add_pd(bounded, almost_half));
}

__attribute__((target("avx2"))) void FindCellsAvx2(const CellFrame& frame,
                                                   const float* const point_x,
                                                   const float* const point_y,
                                                   const int count,
                                                   int32_t* const x,
                                                   int32_t* const y) {
  const __m128 w = _mm_set1_ps(frame.w);
  const __m128 z = _mm_set1_ps(frame.z);
  const __m128 translation_x = _mm_set1_ps(frame.translation_x);
  const __m128 translation_y = _mm_set1_ps(frame.translation_y);
  const __m128 sign = _mm_set1_ps(-0.f);
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const __m128 px = _mm_loadu_ps(point_x + i);
    const __m128 py = _mm_loadu_ps(point_y + i);
    const __m128 half_u = _mm_xor_ps(sign, _mm_mul_ps(z, py));
    const __m128 half_v = _mm_mul_ps(z, px);
    const __m128 u = _mm_add_ps(half_u, half_u);
    const __m128 v = _mm_add_ps(half_v, half_v);
    const __m128 world_x = _mm_add_ps(
        _mm_sub_ps(_mm_add_ps(px, _mm_mul_ps(w, u)), _mm_mul_ps(z, v)),
        translation_x);
    const __m128 world_y = _mm_add_ps(
        _mm_add_ps(_mm_add_ps(py, _mm_mul_ps(w, v)), _mm_mul_ps(z, u)),
        translation_y);
    Store16(FourIndices(frame.max_y, world_y, frame.resolution), x + i);
    Store16(FourIndices(frame.max_x, world_x, frame.resolution), y + i);
  }
  plain::FindCells(frame, point_x + i, point_y + i, count - i, x + i, y + i);
}

__attribute__((target("avx2"))) inline __m256i Load32(const void* const from) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}
__attribute__((target("avx2"))) inline void Store32(const __m256i value,
                                                    void* const to) {
  _mm256_storeu_si256(static_cast<__m256i*>(to), value);
}

__attribute__((target("avx2"))) void AddRowsAvx2(
    const uint8_t* rows, const int row_stride, const int num_columns,
    const int num_rows, uint8_t* sums, const int sums_stride) {
  const int full = num_columns & ~31;
  const int rest = num_columns - full;
  if (rest == 0) {
    for (int j = 0; j != num_rows;
         ++j, rows += row_stride, sums += sums_stride) {
      for (int i = 0; i != full; i += 32) {
        Store32(_mm256_add_epi8(Load32(sums + i), Load32(rows + i)), sums + i);
      }
    }
  } else if (rest <= 16) {
    const __m128i mask = Load16(kMask + 32 - rest);
    for (int j = 0; j != num_rows;
         ++j, rows += row_stride, sums += sums_stride) {
      for (int i = 0; i != full; i += 32) {
        Store32(_mm256_add_epi8(Load32(sums + i), Load32(rows + i)), sums + i);
      }
      Store16(_mm_add_epi8(Load16(sums + full),
                           _mm_and_si128(mask, Load16(rows + full))),
              sums + full);
    }
  } else {
    const __m256i mask = Load32(kMask + 32 - rest);
    for (int j = 0; j != num_rows;
         ++j, rows += row_stride, sums += sums_stride) {
      for (int i = 0; i != full; i += 32) {
        Store32(_mm256_add_epi8(Load32(sums + i), Load32(rows + i)), sums + i);
      }
      Store32(_mm256_add_epi8(Load32(sums + full),
                              _mm256_and_si256(mask, Load32(rows + full))),
              sums + full);
    }
  }
}

__attribute__((target("avx2"))) void MoveSumsAvx2(const int count,
                                                  uint8_t* const sums,
                                                  uint16_t* const totals) {
  for (int i = 0; i != count; i += 16) {
    const __m256i values = _mm256_cvtepu8_epi16(Load16(sums + i));
    Store16(_mm_setzero_si128(), sums + i);
    Store32(_mm256_add_epi16(Load32(totals + i), values), totals + i);
  }
}

__attribute__((target("avx2"))) int AddSquaresAvx2(const uint8_t* const cells,
                                                   const int stride,
                                                   const int32_t* const offsets,
                                                   const int count,
                                                   uint16_t* const sums) {
  __m256i* const target = reinterpret_cast<__m256i*>(sums);
  __m256i rows[4];
  for (int j = 0; j != 4; ++j) rows[j] = Load32(target + j);
  for (int k = 0; k != count; ++k) {
    const uint8_t* const square = cells + offsets[k];
    for (int j = 0; j != 4; ++j) {
      const __m128i pair =
          _mm_unpacklo_epi64(Load8(square + stride * (2 * j)),
                             Load8(square + stride * (2 * j + 1)));
      rows[j] = _mm256_add_epi16(rows[j], _mm256_cvtepu8_epi16(pair));
    }
  }
  for (int j = 0; j != 4; ++j) Store32(rows[j], target + j);
  const __m256i sixteen = _mm256_max_epu16(_mm256_max_epu16(rows[0], rows[1]),
                                           _mm256_max_epu16(rows[2], rows[3]));
  const __m128i eight = _mm_max_epu16(_mm256_castsi256_si128(sixteen),
                                      _mm256_extracti128_si256(sixteen, 1));
  // SSE4.1 has an instruction for the minimum only.
  const __m128i all = _mm_set1_epi16(-1);
  return 65535 -
         _mm_extract_epi16(_mm_minpos_epu16(_mm_xor_si128(eight, all)), 0);
}

// Places of eight points, and in the signs of `*inside` whether they are in the
// grid. Numbers are compared as unsigned by flipping their highest bits.
__attribute__((target("avx2"))) inline __m256i EightPlaces(
    const int32_t* const x, const int32_t* const y, const __m256i shift_x,
    const __m256i shift_y, const __m256i num_x, const __m256i num_y,
    const __m256i stride, __m256i* const inside) {
  const __m256i flip = _mm256_set1_epi32(static_cast<int>(0x80000000u));
  const __m256i column = _mm256_add_epi32(Load32(x), shift_x);
  const __m256i row = _mm256_add_epi32(Load32(y), shift_y);
  *inside = _mm256_and_si256(_mm256_cmpgt_epi32(_mm256_xor_si256(num_x, flip),
                                                _mm256_xor_si256(column, flip)),
                             _mm256_cmpgt_epi32(_mm256_xor_si256(num_y, flip),
                                                _mm256_xor_si256(row, flip)));
  return _mm256_add_epi32(_mm256_mullo_epi32(row, stride), column);
}

__attribute__((target("avx2"))) int SumValuesAvx2(
    const uint8_t* const values, const int num_x, const int num_y,
    const int32_t* const x, const int32_t* const y, const int shift_x,
    const int shift_y, const int count) {
  const __m256i all_num_x = _mm256_set1_epi32(num_x);
  const __m256i all_num_y = _mm256_set1_epi32(num_y);
  const __m256i all_shift_x = _mm256_set1_epi32(shift_x);
  const __m256i all_shift_y = _mm256_set1_epi32(shift_y);
  const __m256i low_byte = _mm256_set1_epi32(255);
  __m256i sums = _mm256_setzero_si256();
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    __m256i inside;
    const __m256i places =
        EightPlaces(x + i, y + i, all_shift_x, all_shift_y, all_num_x,
                    all_num_y, all_num_x, &inside);
    const __m256i four_bytes = _mm256_mask_i32gather_epi32(
        _mm256_setzero_si256(), reinterpret_cast<const int*>(values), places,
        inside, 1);
    sums = _mm256_add_epi32(sums, _mm256_and_si256(four_bytes, low_byte));
  }
  alignas(32) int32_t parts[8];
  Store32(sums, parts);
  return parts[0] + parts[1] + parts[2] + parts[3] + parts[4] + parts[5] +
         parts[6] + parts[7] +
         plain::SumValues(values, num_x, num_y, x + i, y + i, shift_x, shift_y,
                          count - i);
}

// For each set of eight bits, the positions of those that are 1.
struct BitPositions {
  BitPositions() {
    for (int set = 0; set != 256; ++set) {
      int count = 0;
      for (uint8_t bit = 0; bit != 8; ++bit) {
        if (set >> bit & 1) positions[set][count++] = bit;
      }
      while (count != 8) positions[set][count++] = 0;
    }
  }
  uint8_t positions[256][8];
};

__attribute__((target("avx2"))) int FindPlacesAvx2(
    const int num_x, const int num_y, const int stride, const int32_t* const x,
    const int32_t* const y, const int shift_x, const int shift_y,
    const int count, int32_t* const places) {
  static const BitPositions* const bits = new BitPositions;
  const __m256i all_num_x = _mm256_set1_epi32(num_x);
  const __m256i all_num_y = _mm256_set1_epi32(num_y);
  const __m256i all_stride = _mm256_set1_epi32(stride);
  const __m256i all_shift_x = _mm256_set1_epi32(shift_x);
  const __m256i all_shift_y = _mm256_set1_epi32(shift_y);
  int num_places = 0;
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    __m256i inside;
    const __m256i eight =
        EightPlaces(x + i, y + i, all_shift_x, all_shift_y, all_num_x,
                    all_num_y, all_stride, &inside);
    const int set = _mm256_movemask_ps(_mm256_castsi256_ps(inside));
    const __m256i order = _mm256_cvtepu8_epi32(Load8(bits->positions[set]));
    Store32(_mm256_permutevar8x32_epi32(eight, order), places + num_places);
    num_places += __builtin_popcount(set);
  }
  return num_places + plain::FindPlaces(num_x, num_y, stride, x + i, y + i,
                                        shift_x, shift_y, count - i,
                                        places + num_places);
}

constexpr SearchKernels kAvx2 = {
    "avx2",         &FindCellsAvx2,  &AddRowsAvx2,      &MoveSumsAvx2,
    &SumValuesAvx2, &FindPlacesAvx2, &SplitColumnsSse2, &AddSquaresAvx2,
    &RoundUpSse2};

}  // namespace
#endif  // CARTOGRAPHER_EXT_X86_KERNELS

std::vector<const SearchKernels*> X86SearchKernels() {
  std::vector<const SearchKernels*> kernels;
#ifdef CARTOGRAPHER_EXT_X86_KERNELS
  kernels.push_back(&kSse2);
  if (__builtin_cpu_supports("avx2")) kernels.push_back(&kAvx2);
#endif
  return kernels;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
