// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/incremental_factor.h"

#include <algorithm>
#include <limits>

#include "cartographer_ext/optimization/solvers/block_kernels.h"
#include "cartographer_ext/optimization/solvers/block_product.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kEnd = std::numeric_limits<int>::max();

}  // namespace

void IncrementalFactor::Reset(const BlockLdlt& factor,
                              const Eigen::VectorXd& rhs) {
  const int n = factor.size();
  CHECK_EQ(rhs.size(), 3 * n);
  position_ = factor.position();
  variable_ = factor.order();
  columns_.resize(n);
  work_.assign(n, Eigen::Matrix3d::Zero());
  work_solution_.assign(n, Eigen::Vector3d::Zero());
  solution_version_.assign(n, -1);
  ++version_;
  std::vector<Eigen::Vector3d> y(n);
  for (int j = 0; j != n; ++j) y[j] = rhs.segment<3>(3 * variable_[j]);
  for (int j = 0; j != n; ++j) {
    Column& column = columns_[j];
    const int start = factor.start(j), end = factor.start(j + 1);
    column.rows.resize(end - start);
    column.blocks.resize(end - start);
    column.pivot = factor.pivot(j);
    column.pivot_inverse = factor.pivot_inverse(j);
    column.rhs = column.pivot_inverse * y[j];
    for (int p = start; p != end; ++p) {
      column.rows[p - start] = factor.row(p);
      column.blocks[p - start] = factor.block(p);
      y[factor.row(p)].noalias() -= factor.block(p) * y[j];
    }
  }
}

bool IncrementalFactor::Column::Include(const int row) {
  const auto place = std::lower_bound(rows.begin(), rows.end(), row);
  if (place != rows.end() && *place == row) return false;
  blocks.insert(blocks.begin() + (place - rows.begin()),
                Eigen::Matrix3d::Zero());
  rows.insert(place, row);
  return true;
}

int IncrementalFactor::Append() {
  Column column;
  column.pivot.setZero();
  column.pivot_inverse.setZero();
  column.rhs.setZero();
  columns_.push_back(std::move(column));
  work_.push_back(Eigen::Matrix3d::Zero());
  work_solution_.push_back(Eigen::Vector3d::Zero());
  solution_version_.push_back(-1);
  const int variable = position_.size();
  position_.push_back(columns_.size() - 1);
  variable_.push_back(variable);
  return variable;
}

bool IncrementalFactor::Update(const LinearFactor& factor,
                               const double weight) {
  const BlockKernels& kernels = BestBlockKernels();
  last_update_blocks_ = 0;
  if (weight == 0. || (factor.a < 0 && factor.b < 0)) return true;
  ++version_;
  // W holds J' by blocks. Its rows below the current column are those of the
  // column: a parent has the rows of its children, and at most `last`, the later
  // end of the measurement, is missing.
  int j = kEnd, last = -1;
  const auto start_at = [&](const int position,
                            const Eigen::Matrix3d& jacobian) {
    work_[position] = jacobian.transpose();
    j = std::min(j, position);
    last = std::max(last, position);
  };
  if (factor.a >= 0) start_at(position_[factor.a], factor.jacobian_a);
  if (factor.b >= 0) start_at(position_[factor.b], factor.jacobian_b);
  Eigen::RowVector3d work_rhs = factor.target.transpose();
  Eigen::Matrix3d middle = weight * Eigen::Matrix3d::Identity();
  bool ok = true;
  while (true) {
    Column& column = columns_[j];
    if (j < last && !column.Include(last)) last = -1;
    const Eigen::Matrix3d head = work_[j];
    work_[j].setZero();
    const Eigen::Matrix3d middle_head = middle * head.transpose();
    column.pivot.noalias() += head * middle_head;
    CopyLowerTriangle(&column.pivot);
    if (!InvertSpd(column.pivot, &column.pivot_inverse)) {
      ok = false;
      for (const int row : column.rows) work_[row].setZero();
      break;
    }
    const Eigen::Matrix3d gain = middle_head * column.pivot_inverse;
    kernels.update_column(head, gain, column.rows.data(), column.rows.size(),
                          column.blocks.data(), work_.data());
    work_rhs.noalias() -= column.rhs.transpose() * head;
    column.rhs.noalias() += gain.transpose() * work_rhs.transpose();
    middle.noalias() -= gain * middle_head.transpose();
    CopyLowerTriangle(&middle);
    last_update_blocks_ += column.rows.size();
    if (column.rows.empty()) break;
    j = column.rows.front();
  }
  return ok;
}

bool IncrementalFactor::Attach(const LinearFactor& factor) {
  const int64_t version = version_;
  const bool ok = Update(factor, 1.);
  version_ = version;
  return ok;
}

Eigen::Matrix3d IncrementalFactor::PredictedCovariance(
    const LinearFactor& factor) const {
  const BlockKernels& kernels = BestBlockKernels();
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  last_prediction_blocks_ = 0;
  // Two paths to the root, walked together in ascending order.
  int a = kEnd, b = kEnd;
  if (factor.a >= 0) {
    a = position_[factor.a];
    work_[a] = factor.jacobian_a.transpose();
  }
  if (factor.b >= 0) {
    b = position_[factor.b];
    work_[b] = factor.jacobian_b.transpose();
  }
  while (a != kEnd || b != kEnd) {
    const int j = std::min(a, b);
    const Column& column = columns_[j];
    const Eigen::Matrix3d head = work_[j];
    work_[j].setZero();
    kernels.predict_column(head, column.pivot_inverse, column.rows.data(),
                           column.rows.size(), column.blocks.data(), &result,
                           work_.data());
    last_prediction_blocks_ += column.rows.size() + 1;
    const int parent = column.rows.empty() ? kEnd : column.rows.front();
    if (a == j) a = parent;
    if (b == j) b = parent;
    if (a == b) b = kEnd;
  }
  return result;
}

Eigen::Vector3d IncrementalFactor::SolveFor(const int variable) const {
  if (variable < 0) return Eigen::Vector3d::Zero();
  // The path to the root holds all rows of its columns, and so does the part of
  // it that is known already.
  std::vector<int> path;
  for (int j = position_[variable]; solution_version_[j] != version_;) {
    path.push_back(j);
    if (columns_[j].rows.empty()) break;
    j = columns_[j].rows.front();
  }
  for (auto it = path.rbegin(); it != path.rend(); ++it) {
    const Column& column = columns_[*it];
    TransposedProducts products;
    for (size_t k = 0; k != column.rows.size(); ++k) {
      products.Add(column.blocks[k], work_solution_[column.rows[k]]);
    }
    work_solution_[*it] = column.rhs - products.Sum();
    solution_version_[*it] = version_;
  }
  return work_solution_[position_[variable]];
}

void IncrementalFactor::Solve(Eigen::VectorXd* const solution) const {
  solution->resize(3 * columns_.size());
  for (int j = static_cast<int>(columns_.size()) - 1; j >= 0; --j) {
    const Column& column = columns_[j];
    TransposedProducts products;
    for (size_t k = 0; k != column.rows.size(); ++k) {
      products.Add(column.blocks[k], work_solution_[column.rows[k]]);
    }
    work_solution_[j] = column.rhs - products.Sum();
    solution->segment<3>(3 * variable_[j]) = work_solution_[j];
  }
}

void IncrementalFactor::SolveSystem(Eigen::VectorXd* const rhs) const {
  const int n = columns_.size();
  std::vector<Eigen::Vector3d> x(n);
  for (int j = 0; j != n; ++j) x[j] = rhs->segment<3>(3 * variable_[j]);
  for (int j = 0; j != n; ++j) {
    const Column& column = columns_[j];
    for (size_t k = 0; k != column.rows.size(); ++k) {
      x[column.rows[k]].noalias() -= column.blocks[k] * x[j];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    const Column& column = columns_[j];
    TransposedProducts products;
    for (size_t k = 0; k != column.rows.size(); ++k) {
      products.Add(column.blocks[k], x[column.rows[k]]);
    }
    x[j] = column.pivot_inverse * x[j] - products.Sum();
    rhs->segment<3>(3 * variable_[j]) = x[j];
  }
}

size_t IncrementalFactor::num_blocks() const {
  size_t result = 0;
  for (const Column& column : columns_) result += column.rows.size();
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
