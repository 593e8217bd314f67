// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a submap says about many cells: with AVX2 about four at a time.
#include <cstddef>
#include <cstdint>

#include "cartographer_ext/map/submap_cells.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define CARTOGRAPHER_EXT_HAS_AVX2_KERNEL
#include <immintrin.h>
#endif

namespace cartographer_ext {
namespace evaluation {
namespace {

// Where the codes are, see SubmapCells.
struct CodeTable {
  const int32_t* begins;
  const uint8_t* codes;
  int num_x, num_y;
  int tiles_per_row;
  int32_t outside;  // instead of a code
};

#ifdef CARTOGRAPHER_EXT_HAS_AVX2_KERNEL
// Of `num` cells, rounded up to a multiple of four.
__attribute__((target("avx2"))) void FindCodesAvx2(const CodeTable& table,
                                                   const double* const x,
                                                   const double* const y,
                                                   const size_t num,
                                                   int32_t* const codes) {
  const __m256d zero = _mm256_setzero_pd();
  const __m256d num_x = _mm256_set1_pd(table.num_x);
  const __m256d num_y = _mm256_set1_pd(table.num_y);
  const __m128i per_row = _mm_set1_epi32(table.tiles_per_row);
  const __m128i in_tile = _mm_set1_epi32(TileLayout::kSide - 1);
  const __m128i byte = _mm_set1_epi32(255);
  const __m128i outside = _mm_set1_epi32(table.outside);
  // The lower half of each of four comparisons of eight bytes.
  const __m256i halves = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  for (size_t i = 0; i < num; i += 4) {
    const __m256d xs = _mm256_loadu_pd(x + i), ys = _mm256_loadu_pd(y + i);
    // False for what is not a number.
    const __m256d inside =
        _mm256_and_pd(_mm256_and_pd(_mm256_cmp_pd(xs, zero, _CMP_GE_OQ),
                                    _mm256_cmp_pd(ys, zero, _CMP_GE_OQ)),
                      _mm256_and_pd(_mm256_cmp_pd(xs, num_x, _CMP_LT_OQ),
                                    _mm256_cmp_pd(ys, num_y, _CMP_LT_OQ)));
    const __m128i mask = _mm256_castsi256_si128(
        _mm256_permutevar8x32_epi32(_mm256_castpd_si256(inside), halves));
    // Cells outside are taken for the first one.
    const __m128i ix = _mm_and_si128(_mm256_cvttpd_epi32(xs), mask);
    const __m128i iy = _mm_and_si128(_mm256_cvttpd_epi32(ys), mask);
    const __m128i tile = _mm_add_epi32(
        _mm_mullo_epi32(_mm_srli_epi32(iy, TileLayout::kBits), per_row),
        _mm_srli_epi32(ix, TileLayout::kBits));
    const __m128i begin = _mm_i32gather_epi32(table.begins, tile, 4);
    const __m128i cell = _mm_or_si128(
        _mm_slli_epi32(_mm_and_si128(iy, in_tile), TileLayout::kBits),
        _mm_and_si128(ix, in_tile));
    const __m128i is_one = _mm_srai_epi32(begin, 31);  // code for the tile
    const __m128i at = _mm_andnot_si128(is_one, _mm_add_epi32(begin, cell));
    const __m128i own = _mm_and_si128(
        _mm_i32gather_epi32(reinterpret_cast<const int*>(table.codes), at, 1),
        byte);
    const __m128i known =
        _mm_blendv_epi8(own, _mm_sub_epi32(_mm_setzero_si128(), begin), is_one);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(codes + i),
                     _mm_blendv_epi8(outside, known, mask));
  }
}
#endif

}  // namespace

void SubmapCells::FindCodes(const std::vector<double>& x,
                            const std::vector<double>& y, const size_t num,
                            std::vector<int32_t>* const codes) const {
#ifdef CARTOGRAPHER_EXT_HAS_AVX2_KERNEL
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  if (has_avx2 && !begins_.empty()) {
    FindCodesAvx2({begins_.data(), codes_.data(), grid_.num_x(), grid_.num_y(),
                   grid_.tiles().per_row(), kFar},
                  x.data(), y.data(), num, codes->data());
    return;
  }
#endif
  for (size_t i = 0; i != num; ++i) {
    const Eigen::Vector2d cell(x[i], y[i]);
    (*codes)[i] = IsInside(cell) ? Code(cell) : kFar;
  }
}

}  // namespace evaluation
}  // namespace cartographer_ext
