// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Sparse L D L' factorisation of a symmetric positive definite matrix made of
// 3 x 3 blocks, one block row per pose. L has identity blocks on its diagonal,
// D is block diagonal. The ordering comes from CAMD (BSD licence); the rest is
// our own, because the update routines of CHOLMOD are GPL and because whole
// blocks are faster than scalars at this size.
//
// Usage: Analyze once per pattern; then, repeatedly, SetZero, AddDiagonal,
// AddOffDiagonal, Factorize, Solve.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_LDLT_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_LDLT_H_

#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/optimization/solvers/large_pages.h"

namespace cartographer_ext {
namespace optimization {

// Makes a block symmetric from its lower triangle, which is all that InvertSpd
// reads.
void CopyLowerTriangle(Eigen::Matrix3d* block);

// Inverse of a symmetric positive definite block; false when it is not.
bool InvertSpd(const Eigen::Matrix3d& block, Eigen::Matrix3d* inverse);

// A fill-reducing order of `size` variables for the pattern of `pairs` (pairs
// of different variables, repetition allowed): result[position] = variable.
// `groups`, empty or one value in [0, size) per variable, forces variables of a
// higher group behind all of a lower one.
std::vector<int> FillReducingOrder(
    int size, const std::vector<std::pair<int, int>>& pairs,
    const std::vector<int>& groups);

// The factorisation, see above. Not thread-safe.
class BlockLdlt {
 public:
  // The lower triangle of a symmetric block.
  struct SymmetricBlock {
    double m00, m10, m20, m11, m21, m22;
  };
  // Any block, by columns.
  struct Block {
    double m00, m10, m20, m01, m11, m21, m02, m12, m22;
  };

  void Analyze(int size, const std::vector<std::pair<int, int>>& pairs,
               const std::vector<int>& groups);
  // The same for different pairs with the same number of variables and the
  // previous order, which saves most of the time at the cost of some fill.
  void AnalyzeInOrder(const std::vector<std::pair<int, int>>& pairs);
  // Appends pairs if all of them fit into the existing fill; otherwise returns
  // false without effect.
  bool Extend(const std::vector<std::pair<int, int>>& pairs);

  void SetZero();
  void AddDiagonal(const int variable, const Eigen::Matrix3d& block) {
    diagonal_[position_[variable]] += block;
  }
  // The same by value.
  void AddDiagonal(const int variable, const SymmetricBlock& block) {
    double* const sum = diagonal_[position_[variable]].data();
    sum[0] += block.m00, sum[1] += block.m10, sum[2] += block.m20;
    sum[3] += block.m10, sum[4] += block.m11, sum[5] += block.m21;
    sum[6] += block.m20, sum[7] += block.m21, sum[8] += block.m22;
  }
  // `block` is H(pairs[pair].first, pairs[pair].second).
  void AddOffDiagonal(const int pair, const Eigen::Matrix3d& block) {
    Eigen::Matrix3d& sum = matrix_[matrix_of_pair_[pair]];
    if (slots_[pair].transpose) {
      sum += block.transpose();
    } else {
      sum += block;
    }
  }
  // The same by value.
  void AddOffDiagonal(const int pair, const Block& block) {
    double* const sum = matrix_[matrix_of_pair_[pair]].data();
    if (slots_[pair].transpose) {
      sum[0] += block.m00, sum[1] += block.m01, sum[2] += block.m02;
      sum[3] += block.m10, sum[4] += block.m11, sum[5] += block.m12;
      sum[6] += block.m20, sum[7] += block.m21, sum[8] += block.m22;
    } else {
      sum[0] += block.m00, sum[1] += block.m10, sum[2] += block.m20;
      sum[3] += block.m01, sum[4] += block.m11, sum[5] += block.m21;
      sum[6] += block.m02, sum[7] += block.m12, sum[8] += block.m22;
    }
  }

  // Factors H + lambda * diag(H). False if that is not positive definite.
  bool Factorize(double lambda);

  // Replaces the right hand side, 3 * size values in the order of the
  // variables, by the solution.
  void Solve(Eigen::VectorXd* rhs) const;
  // The same for three right hand sides, the columns.
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  void Solve(Columns* rhs) const;

  int size() const { return order_.size(); }
  // Multiplications of one factorisation.
  double work() const { return work_; }
  // Blocks below the diagonal of L.
  size_t num_blocks() const { return rows_.size(); }
  const std::vector<int>& order() const { return order_; }
  const std::vector<int>& position() const { return position_; }
  // Column structure by position: rows [start(c), start(c + 1)), ascending.
  int start(int column) const { return starts_[column]; }
  int row(int index) const { return rows_[index]; }
  const int* rows(int index) const { return rows_.data() + index; }
  const Eigen::Matrix3d& block(int index) const { return blocks_[index]; }
  const Eigen::Matrix3d& pivot(int column) const { return pivots_[column]; }
  const Eigen::Matrix3d& pivot_inverse(int column) const {
    return pivot_inverses_[column];
  }

 private:
  struct Slot {
    int index = 0;  // into blocks_
    bool transpose = false;
  };

  void CountWork();
  // Of the factorisation by panels, block_ldlt_panels.cc.
  class PanelFactorization;
  void FindPanels();

  // `Row` holds the three rows of one variable.
  template <typename Row, typename Rhs>
  void SolveRows(Rhs* rhs) const;

  std::vector<int> order_;     // position -> variable
  std::vector<int> position_;  // variable -> position
  std::vector<int> starts_;
  std::vector<int> rows_;
  LargeVector<Eigen::Matrix3d> blocks_;  // H before, L after factorising
  LargeVector<Eigen::Matrix3d> pivots_;
  LargeVector<Eigen::Matrix3d> pivot_inverses_;
  std::vector<Slot> slots_;              // per pair
  std::vector<int> slot_of_matrix_;      // slots of H, repeated by Extend
  LargeVector<Eigen::Matrix3d> matrix_;  // their values
  std::vector<int> matrix_of_pair_;
  LargeVector<Eigen::Matrix3d> diagonal_;  // by position
  // Panels: neighbouring columns with the same rows below the last of them.
  std::vector<int> panel_starts_;  // first column of each, and the size
  std::vector<int> panel_of_column_;
  std::vector<size_t> packed_starts_;  // of each panel in packed_
  size_t packed_size_ = 0;
  // Scratch of the factorisation.
  std::unique_ptr<double[], void (*)(void*)> packed_{nullptr, &std::free};
  double work_ = 0.;
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_LDLT_H_
