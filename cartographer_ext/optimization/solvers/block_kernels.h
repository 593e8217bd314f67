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

// The loops for one instruction set.
struct BlockKernels {
  const char* name;
  // targets[k'] -= sources[k] * factor for all k in [0, count), where k' is
  // places[rows[k]], or rows[k] if `places` is null. No target is a source.
  void (*subtract_products)(const Eigen::Matrix3d& factor,
                            const Eigen::Matrix3d* sources, const int* rows,
                            int count, const int* places,
                            Eigen::Matrix3d* targets);
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
};

// The fastest that this processor has.
const BlockKernels& BestBlockKernels();

// All that it has, for tests.
std::vector<const BlockKernels*> AllBlockKernels();

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_KERNELS_H_
