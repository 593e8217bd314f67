// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_kernels.h"

#include "cartographer_ext/optimization/solvers/block_product.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define CARTOGRAPHER_EXT_X86_KERNELS 1
#include <immintrin.h>
#endif

namespace cartographer_ext {
namespace optimization {
namespace {

void SubtractProducts(const Eigen::Matrix3d& factor,
                      const Eigen::Matrix3d* const sources,
                      const int* const rows, const int count,
                      const int* const places, Eigen::Matrix3d* const targets) {
  const RightFactor right(factor);
  for (int k = 0; k < count; ++k) {
    Eigen::Matrix3d& target =
        targets[places == nullptr ? rows[k] : places[rows[k]]];
    right.SubtractedFrom(PackedBlock(target), PackedBlock(sources[k]))
        .CopyTo(&target);
  }
}

void UpdateColumn(const Eigen::Matrix3d& head, const Eigen::Matrix3d& gain,
                  const int* const rows, const int count,
                  Eigen::Matrix3d* const blocks, Eigen::Matrix3d* const work) {
  const RightFactor of_head(head), of_gain(gain);
  for (int k = 0; k < count; ++k) {
    const PackedBlock block(blocks[k]);
    const PackedBlock below =
        of_head.SubtractedFrom(PackedBlock(work[rows[k]]), block);
    below.CopyTo(&work[rows[k]]);
    of_gain.AddedTo(block, below).CopyTo(&blocks[k]);
  }
}

void PredictColumn(const Eigen::Matrix3d& head, const Eigen::Matrix3d& middle,
                   const int* const rows, const int count,
                   const Eigen::Matrix3d* const blocks,
                   Eigen::Matrix3d* const sum, Eigen::Matrix3d* const work) {
  const RightFactor of_head(head);
  const Eigen::Matrix3d product = middle * head;
  of_head.AddedTo(PackedBlock(*sum), PackedBlock(product.transpose()))
      .CopyTo(sum);
  for (int k = 0; k < count; ++k) {
    Eigen::Matrix3d& below = work[rows[k]];
    of_head.SubtractedFrom(PackedBlock(below), PackedBlock(blocks[k]))
        .CopyTo(&below);
  }
}

constexpr BlockKernels kPlain = {"plain", &SubtractProducts, &UpdateColumn,
                                 &PredictColumn};

#ifdef CARTOGRAPHER_EXT_X86_KERNELS

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

constexpr BlockKernels kAvx = {"avx", &SubtractProductsAvx, &UpdateColumnAvx,
                               &PredictColumnAvx};

#endif

}  // namespace

const BlockKernels& BestBlockKernels() {
  static const BlockKernels* const best = AllBlockKernels().back();
  return *best;
}

std::vector<const BlockKernels*> AllBlockKernels() {
  std::vector<const BlockKernels*> all = {&kPlain};
#ifdef CARTOGRAPHER_EXT_X86_KERNELS
  if (__builtin_cpu_supports("avx")) all.push_back(&kAvx);
#endif
  return all;
}

}  // namespace optimization
}  // namespace cartographer_ext
