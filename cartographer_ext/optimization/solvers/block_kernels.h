// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The innermost loops of factorisations: products of many 3 x 3 blocks, stored by
// columns, with one factor. All instruction sets compute the same sums in the
// same order, so results are identical.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_KERNELS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_KERNELS_H_

#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace optimization {

// Values that may be read behind the sources of subtract_panel.
constexpr int kPanelPadding = 24;
// Values of a row of predict_rows.
constexpr int kPathWidth = 12;

// The loops for one instruction set.
struct BlockKernels {
  const char* name;
  // targets[k'] -= sources[k] * factor for all k in [0, count), where k' is
  // places[rows[k]], or rows[k] if `places` is null. No target is a source.
  void (*subtract_products)(const Eigen::Matrix3d& factor,
                            const Eigen::Matrix3d* sources, const int* rows,
                            int count, const int* places,
                            Eigen::Matrix3d* targets);
  // The same with the products of several neighbouring columns at once. The
  // sources are dense: `inner` columns of values, three to a block, the columns
  // `stride` values apart. The factor is `inner` rows of three values. For all k in
  // [0, count) targets[places[k]] -= the product with block k. What follows the last
  // block may be read up to kPanelPadding values behind it.
  void (*subtract_panel)(const double* sources, int stride, int inner,
                         const double* factor, const int* places, int count,
                         Eigen::Matrix3d* targets);
  // factor = pivot * block'; target -= block * factor.
  void (*subtract_from_pivot)(const Eigen::Matrix3d& pivot,
                              const Eigen::Matrix3d& block,
                              Eigen::Matrix3d* factor, Eigen::Matrix3d* target);
  // blocks[k] = blocks[k] * factor for all k in [0, count).
  void (*scale)(const Eigen::Matrix3d& factor, int count,
                Eigen::Matrix3d* blocks);
  // x[rows[k]] -= blocks[k] * value for all k in [0, count), and the sum of
  // blocks[k]' * x[rows[k]]: of a substitution forward and backward.
  void (*substitute)(const Eigen::Vector3d& value,
                     const Eigen::Matrix3d* blocks, const int* rows, int count,
                     Eigen::Vector3d* x);
  Eigen::Vector3d (*substitute_back)(const Eigen::Matrix3d* blocks,
                                     const int* rows, int count,
                                     const Eigen::Vector3d* x);
  // work[rows[k]] -= blocks[k] * head; blocks[k] += work[rows[k]] * gain.
  void (*update_column)(const Eigen::Matrix3d& head,
                        const Eigen::Matrix3d& gain, const int* rows, int count,
                        Eigen::Matrix3d* blocks, Eigen::Matrix3d* work);
  // sum += head' * middle * head with a symmetric `middle`; work[rows[k]] -=
  // blocks[k] * head.
  void (*predict_column)(const Eigen::Matrix3d& head,
                         const Eigen::Matrix3d& middle, const int* rows,
                         int count, const Eigen::Matrix3d* blocks,
                         Eigen::Matrix3d* sum, Eigen::Matrix3d* work);
  // values[rows[k]] -= blocks[k] * head for all k in [0, count). Head and values are
  // three rows of kPathWidth values each.
  void (*predict_rows)(const double* head, const Eigen::Matrix3d* blocks,
                       const int* rows, int count, double* values);
};

// The fastest that this processor has.
const BlockKernels& BestBlockKernels();

// Those with AVX; null where the processor has none.
const BlockKernels* AvxBlockKernels();

// All that it has, for tests.
std::vector<const BlockKernels*> AllBlockKernels();

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_KERNELS_H_
