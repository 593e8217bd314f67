// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The loops with AVX.
#include "cartographer_ext/optimization/solvers/block_kernels.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#include <immintrin.h>

namespace cartographer_ext {
namespace optimization {
namespace {

// A column in the lower three of four values. Loads and stores cover it exactly:
// what is stored is soon loaded again, which waits where they overlap.
__attribute__((target("avx"))) inline __m256d LoadColumn(
    const double* const values) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(values)),
                              _mm_load_sd(values + 2), 1);
}

__attribute__((target("avx"))) inline void StoreColumn(const __m256d column,
                                                       double* const values) {
  _mm_storeu_pd(values, _mm256_castpd256_pd128(column));
  _mm_store_sd(values + 2, _mm256_extractf128_pd(column, 1));
}

struct BlockAvx {
  __m256d columns[3];
};

__attribute__((target("avx"))) inline BlockAvx LoadBlock(
    const Eigen::Matrix3d& block) {
  const double* const values = block.data();
  return {{LoadColumn(values), LoadColumn(values + 3), LoadColumn(values + 6)}};
}

// The right factor of products, each value four times.
struct FactorAvx {
  __m256d values[3][3];  // by column and row
};

__attribute__((target("avx"))) inline FactorAvx Broadcast(
    const Eigen::Matrix3d& factor) {
  FactorAvx result;
  for (int c = 0; c != 3; ++c) {
    for (int r = 0; r != 3; ++r) {
      result.values[c][r] = _mm256_set1_pd(factor(r, c));
    }
  }
  return result;
}

// A column of the product of a block and a factor.
__attribute__((target("avx"))) inline __m256d ColumnOfProduct(
    const BlockAvx& block, const FactorAvx& factor, const int column) {
  const __m256d* const values = factor.values[column];
  return _mm256_add_pd(
      _mm256_add_pd(_mm256_mul_pd(block.columns[0], values[0]),
                    _mm256_mul_pd(block.columns[1], values[1])),
      _mm256_mul_pd(block.columns[2], values[2]));
}

__attribute__((target("avx"))) void SubtractProductsAvx(
    const Eigen::Matrix3d& factor, const Eigen::Matrix3d* const sources,
    const int* const rows, const int count, const int* const places,
    Eigen::Matrix3d* const targets) {
  const FactorAvx right = Broadcast(factor);
  for (int k = 0; k < count; ++k) {
    double* const target =
        targets[places == nullptr ? rows[k] : places[rows[k]]].data();
    const BlockAvx source = LoadBlock(sources[k]);
    for (int c = 0; c != 3; ++c) {
      StoreColumn(_mm256_sub_pd(LoadColumn(target + 3 * c),
                                ColumnOfProduct(source, right, c)),
                  target + 3 * c);
    }
  }
}

// Subtracts a column of four blocks, three times four values below each other, from
// theirs, or of the first `count` of these.
__attribute__((target("avx"))) inline void SubtractColumns(
    const __m256d first, const __m256d second, const __m256d third,
    const int column, const int* const places, const int count,
    Eigen::Matrix3d* const targets) {
  const __m256d between = _mm256_permute2f128_pd(first, second, 0x21);
  const __m256d columns[4] = {
      first,
      _mm256_shuffle_pd(between, _mm256_permute2f128_pd(between, between, 0x01),
                        0x5),
      _mm256_permute2f128_pd(second, third, 0x21),
      _mm256_shuffle_pd(third, _mm256_permute2f128_pd(third, third, 0x01),
                        0x5)};
  for (int k = 0; k < 4 && k < count; ++k) {
    double* const target = targets[places[k]].data() + 3 * column;
    StoreColumn(_mm256_sub_pd(LoadColumn(target), columns[k]), target);
  }
}

__attribute__((target("avx"))) void SubtractPanelAvx(
    const double* const sources, const int stride, const int inner,
    const double* const factor, const int* const places, const int count,
    Eigen::Matrix3d* const targets) {
  for (int k = 0; k < count; k += 4) {
    // Twelve values of each column; an array would be kept in memory.
    __m256d a0 = _mm256_setzero_pd(), a1 = a0, a2 = a0;
    __m256d b0 = a0, b1 = a0, b2 = a0, c0 = a0, c1 = a0, c2 = a0;
    const double* source = sources + 3 * k;
    const double* values = factor;
    for (int i = 0; i != inner; ++i, source += stride, values += 3) {
      const __m256d s0 = _mm256_loadu_pd(source);
      const __m256d s1 = _mm256_loadu_pd(source + 4);
      const __m256d s2 = _mm256_loadu_pd(source + 8);
      __m256d value = _mm256_broadcast_sd(values);
      a0 = _mm256_add_pd(a0, _mm256_mul_pd(s0, value));
      a1 = _mm256_add_pd(a1, _mm256_mul_pd(s1, value));
      a2 = _mm256_add_pd(a2, _mm256_mul_pd(s2, value));
      value = _mm256_broadcast_sd(values + 1);
      b0 = _mm256_add_pd(b0, _mm256_mul_pd(s0, value));
      b1 = _mm256_add_pd(b1, _mm256_mul_pd(s1, value));
      b2 = _mm256_add_pd(b2, _mm256_mul_pd(s2, value));
      value = _mm256_broadcast_sd(values + 2);
      c0 = _mm256_add_pd(c0, _mm256_mul_pd(s0, value));
      c1 = _mm256_add_pd(c1, _mm256_mul_pd(s1, value));
      c2 = _mm256_add_pd(c2, _mm256_mul_pd(s2, value));
    }
    SubtractColumns(a0, a1, a2, 0, places + k, count - k, targets);
    SubtractColumns(b0, b1, b2, 1, places + k, count - k, targets);
    SubtractColumns(c0, c1, c2, 2, places + k, count - k, targets);
  }
}

__attribute__((target("avx"))) void SubtractFromPivotAvx(
    const Eigen::Matrix3d& pivot, const Eigen::Matrix3d& block,
    Eigen::Matrix3d* const factor, Eigen::Matrix3d* const target) {
  const BlockAvx left = LoadBlock(pivot), source = LoadBlock(block);
  const double* const values = block.data();
  for (int c = 0; c != 3; ++c) {
    StoreColumn(
        _mm256_add_pd(
            _mm256_add_pd(
                _mm256_mul_pd(left.columns[0], _mm256_broadcast_sd(values + c)),
                _mm256_mul_pd(left.columns[1],
                              _mm256_broadcast_sd(values + 3 + c))),
            _mm256_mul_pd(left.columns[2],
                          _mm256_broadcast_sd(values + 6 + c))),
        factor->data() + 3 * c);
  }
  const FactorAvx right = Broadcast(*factor);
  for (int c = 0; c != 3; ++c) {
    double* const column = target->data() + 3 * c;
    StoreColumn(
        _mm256_sub_pd(LoadColumn(column), ColumnOfProduct(source, right, c)),
        column);
  }
}

__attribute__((target("avx"))) void ScaleAvx(const Eigen::Matrix3d& factor,
                                             const int count,
                                             Eigen::Matrix3d* const blocks) {
  const FactorAvx right = Broadcast(factor);
  for (int k = 0; k < count; ++k) {
    const BlockAvx block = LoadBlock(blocks[k]);
    for (int c = 0; c != 3; ++c) {
      StoreColumn(ColumnOfProduct(block, right, c), blocks[k].data() + 3 * c);
    }
  }
}

__attribute__((target("avx"))) void SubstituteAvx(
    const Eigen::Vector3d& value, const Eigen::Matrix3d* const blocks,
    const int* const rows, const int count, Eigen::Vector3d* const x) {
  const __m256d a = _mm256_set1_pd(value.x()), b = _mm256_set1_pd(value.y()),
                c = _mm256_set1_pd(value.z());
  for (int k = 0; k < count; ++k) {
    const BlockAvx block = LoadBlock(blocks[k]);
    double* const target = x[rows[k]].data();
    StoreColumn(
        _mm256_sub_pd(
            LoadColumn(target),
            _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(block.columns[0], a),
                                        _mm256_mul_pd(block.columns[1], b)),
                          _mm256_mul_pd(block.columns[2], c))),
        target);
  }
}

__attribute__((target("avx"))) Eigen::Vector3d SubstituteBackAvx(
    const Eigen::Matrix3d* const blocks, const int* const rows, const int count,
    const Eigen::Vector3d* const x) {
  __m256d a = _mm256_setzero_pd(), b = a, c = a;
  for (int k = 0; k < count; ++k) {
    const BlockAvx block = LoadBlock(blocks[k]);
    const __m256d value = LoadColumn(x[rows[k]].data());
    a = _mm256_add_pd(a, _mm256_mul_pd(block.columns[0], value));
    b = _mm256_add_pd(b, _mm256_mul_pd(block.columns[1], value));
    c = _mm256_add_pd(c, _mm256_mul_pd(block.columns[2], value));
  }
  Eigen::Matrix3d sums;
  StoreColumn(a, sums.data());
  StoreColumn(b, sums.data() + 3);
  StoreColumn(c, sums.data() + 6);
  return sums.colwise().sum();
}

__attribute__((target("avx"))) void UpdateColumnAvx(
    const Eigen::Matrix3d& head, const Eigen::Matrix3d& gain,
    const int* const rows, const int count, Eigen::Matrix3d* const blocks,
    Eigen::Matrix3d* const work) {
  const FactorAvx of_head = Broadcast(head), of_gain = Broadcast(gain);
  for (int k = 0; k < count; ++k) {
    double* const values = blocks[k].data();
    double* const target = work[rows[k]].data();
    const BlockAvx block = LoadBlock(blocks[k]);
    BlockAvx below;
    for (int c = 0; c != 3; ++c) {
      below.columns[c] = _mm256_sub_pd(LoadColumn(target + 3 * c),
                                       ColumnOfProduct(block, of_head, c));
      StoreColumn(below.columns[c], target + 3 * c);
    }
    for (int c = 0; c != 3; ++c) {
      StoreColumn(
          _mm256_add_pd(block.columns[c], ColumnOfProduct(below, of_gain, c)),
          values + 3 * c);
    }
  }
}

// The fourth value of each column is of no meaning.
__attribute__((target("avx"))) inline BlockAvx Transposed(
    const BlockAvx& block) {
  const __m256d *const c = block.columns, even = _mm256_unpacklo_pd(c[0], c[1]),
                       odd = _mm256_unpackhi_pd(c[0], c[1]);
  return {{_mm256_permute2f128_pd(even, c[2], 0x20),
           _mm256_permute2f128_pd(odd, _mm256_permute_pd(c[2], 0x5), 0x20),
           _mm256_permute2f128_pd(even, c[2], 0x31)}};
}

__attribute__((target("avx"))) void PredictColumnAvx(
    const Eigen::Matrix3d& head, const Eigen::Matrix3d& middle,
    const int* const rows, const int count, const Eigen::Matrix3d* const blocks,
    Eigen::Matrix3d* const sum, Eigen::Matrix3d* const work) {
  const FactorAvx of_head = Broadcast(head);
  const BlockAvx left = LoadBlock(middle);
  BlockAvx product;
  for (int c = 0; c != 3; ++c) {
    product.columns[c] = ColumnOfProduct(left, of_head, c);
  }
  product = Transposed(product);
  for (int c = 0; c != 3; ++c) {
    double* const values = sum->data() + 3 * c;
    StoreColumn(
        _mm256_add_pd(LoadColumn(values), ColumnOfProduct(product, of_head, c)),
        values);
  }
  for (int k = 0; k < count; ++k) {
    double* const below = work[rows[k]].data();
    const BlockAvx block = LoadBlock(blocks[k]);
    for (int c = 0; c != 3; ++c) {
      StoreColumn(_mm256_sub_pd(LoadColumn(below + 3 * c),
                                ColumnOfProduct(block, of_head, c)),
                  below + 3 * c);
    }
  }
}

// Four of the values of a row, from a row of the block and a column of the head.
__attribute__((target("avx"))) inline void PredictFour(
    const __m256d a, const __m256d b, const __m256d c, const __m256d first,
    const __m256d second, const __m256d third, double* const values) {
  const __m256d product = _mm256_add_pd(
      _mm256_add_pd(_mm256_mul_pd(a, first), _mm256_mul_pd(b, second)),
      _mm256_mul_pd(c, third));
  _mm256_storeu_pd(values, _mm256_sub_pd(_mm256_loadu_pd(values), product));
}

__attribute__((target("avx"))) void PredictRowsAvx(
    const double* const head, const Eigen::Matrix3d* const blocks,
    const int* const rows, const int count, double* const values) {
  const __m256d a0 = _mm256_loadu_pd(head), a1 = _mm256_loadu_pd(head + 4),
                a2 = _mm256_loadu_pd(head + 8);
  const __m256d b0 = _mm256_loadu_pd(head + 12),
                b1 = _mm256_loadu_pd(head + 16),
                b2 = _mm256_loadu_pd(head + 20);
  const __m256d c0 = _mm256_loadu_pd(head + 24),
                c1 = _mm256_loadu_pd(head + 28),
                c2 = _mm256_loadu_pd(head + 32);
  for (int k = 0; k < count; ++k) {
    const double* const block = blocks[k].data();
    double* below = values + 3 * kPathWidth * rows[k];
    for (int r = 0; r != 3; ++r, below += kPathWidth) {
      const __m256d a = _mm256_broadcast_sd(block + r);
      const __m256d b = _mm256_broadcast_sd(block + 3 + r);
      const __m256d c = _mm256_broadcast_sd(block + 6 + r);
      PredictFour(a, b, c, a0, b0, c0, below);
      PredictFour(a, b, c, a1, b1, c1, below + 4);
      PredictFour(a, b, c, a2, b2, c2, below + 8);
    }
  }
}

constexpr BlockKernels kAvx = {"avx",
                               &SubtractProductsAvx,
                               &SubtractPanelAvx,
                               &SubtractFromPivotAvx,
                               &ScaleAvx,
                               &SubstituteAvx,
                               &SubstituteBackAvx,
                               &UpdateColumnAvx,
                               &PredictColumnAvx,
                               &PredictRowsAvx};

}  // namespace

const BlockKernels* AvxBlockKernels() {
  return __builtin_cpu_supports("avx") ? &kAvx : nullptr;
}

}  // namespace optimization
}  // namespace cartographer_ext

#else

namespace cartographer_ext {
namespace optimization {

const BlockKernels* AvxBlockKernels() { return nullptr; }

}  // namespace optimization
}  // namespace cartographer_ext

#endif
