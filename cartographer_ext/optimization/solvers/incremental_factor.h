// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A factor L D L' of 3 x 3 blocks that is updated with its graph: poses are
// appended and measurements added or removed without refactorisation. This is
// what iSAM does with Givens rotations on R (R-iSAM eq. 9-11), written as an
// update of rank 3 by blocks, after the rank-1 method of Davis and Hager: for H
// + W M W',
//
//   D'  = D + W_j M W_j',  K = M W_j' D'^-1,
//   W_i <- W_i - L_ij W_j, L_ij <- L_ij + W_i K,  M <- M - M W_j' K'
//
// for j along the elimination tree from the lowest pose touched to the root;
// other columns do not change. The right hand side is kept as one more row of
// L, so that solving H x = b needs only the backward substitution.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_INCREMENTAL_FACTOR_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_INCREMENTAL_FACTOR_H_

#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"

namespace cartographer_ext {
namespace optimization {

// One linearised measurement J_a x_a + J_b x_b = target with unit covariance. A
// variable of -1 is fixed and its Jacobian not used.
struct LinearFactor {
  int a = -1;
  int b = -1;
  Eigen::Matrix3d jacobian_a = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d jacobian_b = Eigen::Matrix3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
};

// The factor, see above. Not thread-safe.
class IncrementalFactor {
 public:
  // Initialises from a factorised matrix; `rhs` is b in the order of the
  // variables.
  void Reset(const BlockLdlt& factor, const Eigen::VectorXd& rhs);

  // Adds a variable without information, last in the order, and returns its
  // number. It must be reached by an Update before any other call uses it.
  int Append();

  // H += weight * J'J, b += weight * J' target. A negative weight removes the
  // measurement again. Returns false if H is no longer positive definite; the
  // factor is then invalid.
  bool Update(const LinearFactor& factor, double weight);

  // The same with weight one for the first measurement of the variable appended
  // last, where that gives the variable its value: the solution of all others
  // stays as it is, and what is known of it.
  bool Attach(const LinearFactor& factor);

  // J H^-1 J' (3 x 3): covariance of the measurement's prediction.
  Eigen::Matrix3d PredictedCovariance(const LinearFactor& factor) const;

  // Covariance (3 x 3) of the variable that is last in the order.
  const Eigen::Matrix3d& LastCovariance() const {
    return columns_.back().pivot_inverse;
  }

  // Solution of H x = b for one variable, 0 for -1. Intermediate results are
  // reused by later calls until the factor changes.
  Eigen::Vector3d SolveFor(int variable) const;
  // Solution for all variables, 3 values per variable.
  void Solve(Eigen::VectorXd* solution) const;

  // Replaces a given right hand side, 3 values per variable, by the solution.
  void SolveSystem(Eigen::VectorXd* rhs) const;

  int size() const { return columns_.size(); }
  size_t num_blocks() const;
  // Length of the path of the last update, in blocks, at most size().
  size_t last_update_blocks() const { return last_update_blocks_; }
  // The same of the last predicted covariance.
  size_t last_prediction_blocks() const { return last_prediction_blocks_; }

 private:
  struct Column {
    // Adds a row of zeros unless there is that row; returns whether it did.
    bool Include(int row);

    std::vector<int> rows;  // positions, ascending
    std::vector<Eigen::Matrix3d> blocks;
    Eigen::Matrix3d pivot;
    Eigen::Matrix3d pivot_inverse;
    Eigen::Vector3d rhs;  // (D^-1 L^-1 b) of this column
  };

  std::vector<Column> columns_;  // by position
  std::vector<int> position_;    // variable -> position
  std::vector<int> variable_;    // position -> variable
  // Dense work space by position, zero between calls.
  mutable std::vector<Eigen::Matrix3d> work_;
  // Solution by position, valid if its version is that of the factor.
  mutable std::vector<Eigen::Vector3d> work_solution_;
  mutable std::vector<int64_t> solution_version_;
  int64_t version_ = 0;
  size_t last_update_blocks_ = 0;
  mutable size_t last_prediction_blocks_ = 0;
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_INCREMENTAL_FACTOR_H_
