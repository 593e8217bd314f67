// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_kernels.h"

#include "cartographer_ext/optimization/solvers/block_product.h"

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

void SubtractPanel(const double* const sources, const int stride,
                   const int inner, const double* const factor,
                   const int* const places, const int count,
                   Eigen::Matrix3d* const targets) {
  for (int k = 0; k < count; ++k) {
    PackedColumn sums[3] = {PackedColumn(0.), PackedColumn(0.),
                            PackedColumn(0.)};
    for (int i = 0; i != inner; ++i) {
      const PackedColumn source(sources + 3 * k + i * stride);
      for (int c = 0; c != 3; ++c) {
        sums[c] = sums[c] + source * PackedColumn(factor[3 * i + c]);
      }
    }
    double* const target = targets[places[k]].data();
    for (int c = 0; c != 3; ++c) {
      (PackedColumn(target + 3 * c) - sums[c]).CopyTo(target + 3 * c);
    }
  }
}

void SubtractFromPivot(const Eigen::Matrix3d& pivot,
                       const Eigen::Matrix3d& block,
                       Eigen::Matrix3d* const factor,
                       Eigen::Matrix3d* const target) {
  RightFactor(block.transpose()).ProductWith(PackedBlock(pivot)).CopyTo(factor);
  RightFactor(*factor)
      .SubtractedFrom(PackedBlock(*target), PackedBlock(block))
      .CopyTo(target);
}

void Scale(const Eigen::Matrix3d& factor, const int count,
           Eigen::Matrix3d* const blocks) {
  const RightFactor right(factor);
  for (int k = 0; k < count; ++k) {
    right.ProductWith(PackedBlock(blocks[k])).CopyTo(&blocks[k]);
  }
}

void Substitute(const Eigen::Vector3d& value,
                const Eigen::Matrix3d* const blocks, const int* const rows,
                const int count, Eigen::Vector3d* const x) {
  for (int k = 0; k < count; ++k) x[rows[k]].noalias() -= blocks[k] * value;
}

Eigen::Vector3d SubstituteBack(const Eigen::Matrix3d* const blocks,
                               const int* const rows, const int count,
                               const Eigen::Vector3d* const x) {
  TransposedProducts products;
  for (int k = 0; k < count; ++k) products.Add(blocks[k], x[rows[k]]);
  return products.Sum();
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

void PredictRows(const double* const head, const Eigen::Matrix3d* const blocks,
                 const int* const rows, const int count, double* const values) {
  for (int k = 0; k < count; ++k) {
    double* const below = values + 3 * kPathWidth * rows[k];
    for (int r = 0; r != 3; ++r) {
      const double a = blocks[k](r, 0), b = blocks[k](r, 1),
                   c = blocks[k](r, 2);
      for (int i = 0; i != kPathWidth; ++i) {
        below[kPathWidth * r + i] -= a * head[i] + b * head[kPathWidth + i] +
                                     c * head[2 * kPathWidth + i];
      }
    }
  }
}

constexpr BlockKernels kPlain = {
    "plain",        &SubtractProducts, &SubtractPanel,  &SubtractFromPivot,
    &Scale,         &Substitute,       &SubstituteBack, &UpdateColumn,
    &PredictColumn, &PredictRows};

}  // namespace

const BlockKernels& BestBlockKernels() {
  static const BlockKernels* const best = AllBlockKernels().back();
  return *best;
}

std::vector<const BlockKernels*> AllBlockKernels() {
  std::vector<const BlockKernels*> all = {&kPlain};
  if (AvxBlockKernels() != nullptr) all.push_back(AvxBlockKernels());
  return all;
}

}  // namespace optimization
}  // namespace cartographer_ext
