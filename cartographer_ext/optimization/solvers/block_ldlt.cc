// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/block_ldlt.h"

#include <algorithm>
#include <cmath>

#include "camd.h"
#include "cartographer_ext/optimization/solvers/block_kernels.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Compressed rows of a symmetric pattern, without repetition.
struct Adjacency {
  std::vector<int> starts;
  std::vector<int> neighbours;
};

Adjacency FullAdjacency(const int size,
                        const std::vector<std::pair<int, int>>& pairs) {
  Adjacency raw;
  raw.starts.assign(size + 1, 0);
  for (const std::pair<int, int>& pair : pairs) {
    ++raw.starts[pair.first + 1];
    ++raw.starts[pair.second + 1];
  }
  for (int i = 0; i != size; ++i) raw.starts[i + 1] += raw.starts[i];
  raw.neighbours.resize(2 * pairs.size());
  std::vector<int> next(raw.starts.begin(), raw.starts.end() - 1);
  for (const std::pair<int, int>& pair : pairs) {
    raw.neighbours[next[pair.first]++] = pair.second;
    raw.neighbours[next[pair.second]++] = pair.first;
  }
  Adjacency result;
  result.starts.reserve(size + 1);
  result.starts.push_back(0);
  result.neighbours.reserve(raw.neighbours.size());
  for (int i = 0; i != size; ++i) {
    const auto begin = raw.neighbours.begin() + raw.starts[i];
    const auto end = raw.neighbours.begin() + raw.starts[i + 1];
    std::sort(begin, end);
    for (auto it = begin; it != end; ++it) {
      if (it == begin || *it != *(it - 1)) result.neighbours.push_back(*it);
    }
    result.starts.push_back(result.neighbours.size());
  }
  return result;
}

// The substitutions with a column below its pivot: x[rows[k]] -= blocks[k] * value,
// and the sum of blocks[k]' * x[rows[k]].
void Substitute(const Eigen::Vector3d& value,
                const Eigen::Matrix3d* const blocks, const int* const rows,
                const int count, std::vector<Eigen::Vector3d>* const x) {
  BestBlockKernels().substitute(value, blocks, rows, count, x->data());
}

void Substitute(const Eigen::Matrix3d& value,
                const Eigen::Matrix3d* const blocks, const int* const rows,
                const int count, std::vector<Eigen::Matrix3d>* const x) {
  BestBlockKernels().subtract_products(value, blocks, rows, count, nullptr,
                                       x->data());
}

Eigen::Vector3d TransposedSum(const Eigen::Matrix3d* const blocks,
                              const int* const rows, const int count,
                              const std::vector<Eigen::Vector3d>& x) {
  return BestBlockKernels().substitute_back(blocks, rows, count, x.data());
}

Eigen::Matrix3d TransposedSum(const Eigen::Matrix3d* const blocks,
                              const int* const rows, const int count,
                              const std::vector<Eigen::Matrix3d>& x) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (int k = 0; k != count; ++k) {
    result.noalias() += blocks[k].transpose() * x[rows[k]];
  }
  return result;
}

// Room for the next, larger pattern, without copies of old values. What is not
// used takes no memory.
void ReserveForMore(const size_t size,
                    LargeVector<Eigen::Matrix3d>* const blocks) {
  if (size <= blocks->capacity()) return;
  blocks->clear();
  blocks->reserve(2 * size);
}

}  // namespace

void CopyLowerTriangle(Eigen::Matrix3d* const block) {
  (*block)(0, 1) = (*block)(1, 0);
  (*block)(0, 2) = (*block)(2, 0);
  (*block)(1, 2) = (*block)(2, 1);
}

bool InvertSpd(const Eigen::Matrix3d& block, Eigen::Matrix3d* const inverse) {
  const double a = block(0, 0), b = block(1, 0), c = block(2, 0);
  const double d = block(1, 1), e = block(2, 1), f = block(2, 2);
  const double m00 = d * f - e * e, m01 = c * e - b * f, m02 = b * e - c * d;
  const double determinant = a * m00 + b * m01 + c * m02;
  const double minor = a * d - b * b;
  if (!(a > 0.) || !(minor > 0.) || !(determinant > 0.) ||
      !std::isfinite(determinant)) {
    return false;
  }
  const double scale = 1. / determinant;
  const double m12 = b * c - a * e;
  *inverse << m00 * scale, m01 * scale, m02 * scale,      //
      m01 * scale, (a * f - c * c) * scale, m12 * scale,  //
      m02 * scale, m12 * scale, minor * scale;
  return true;
}

std::vector<int> FillReducingOrder(
    const int size, const std::vector<std::pair<int, int>>& pairs,
    const std::vector<int>& groups) {
  std::vector<int> order(size);
  if (size == 0) return order;
  if (pairs.empty()) {
    for (int i = 0; i != size; ++i) order[i] = i;
    if (!groups.empty()) {
      std::stable_sort(
          order.begin(), order.end(),
          [&](const int a, const int b) { return groups[a] < groups[b]; });
    }
    return order;
  }
  const Adjacency pattern = FullAdjacency(size, pairs);
  std::vector<double> control(CAMD_CONTROL);
  camd_defaults(control.data());
  const int result = camd_order(
      size, pattern.starts.data(), pattern.neighbours.data(), order.data(),
      control.data(), nullptr, groups.empty() ? nullptr : groups.data());
  CHECK_EQ(result, CAMD_OK);
  return order;
}

void BlockLdlt::Analyze(const int size,
                        const std::vector<std::pair<int, int>>& pairs,
                        const std::vector<int>& groups) {
  order_ = FillReducingOrder(size, pairs, groups);
  position_.resize(size);
  for (int i = 0; i != size; ++i) position_[order_[i]] = i;
  AnalyzeInOrder(pairs);
}

void BlockLdlt::AnalyzeInOrder(const std::vector<std::pair<int, int>>& pairs) {
  const int size = order_.size();
  // Rows of the strict lower triangle by position: columns left of each row.
  std::vector<int> row_starts(size + 1, 0);
  for (const std::pair<int, int>& pair : pairs) {
    ++row_starts[std::max(position_[pair.first], position_[pair.second]) + 1];
  }
  for (int i = 0; i != size; ++i) row_starts[i + 1] += row_starts[i];
  std::vector<std::pair<int, int>> entries(pairs.size());  // (column, pair)
  std::vector<int> next(row_starts.begin(), row_starts.end() - 1);
  for (size_t k = 0; k != pairs.size(); ++k) {
    const int a = position_[pairs[k].first], b = position_[pairs[k].second];
    entries[next[std::max(a, b)]++] = {std::min(a, b), static_cast<int>(k)};
  }

  // Elimination tree with path compression, then the rows by walking each
  // row's subtree; ascending rows come out sorted.
  std::vector<int> parent(size, -1), ancestor(size, -1);
  for (int i = 0; i != size; ++i) {
    for (int e = row_starts[i]; e != row_starts[i + 1]; ++e) {
      int k = entries[e].first;
      while (k != -1 && k < i) {
        const int up = ancestor[k];
        ancestor[k] = i;
        if (up == -1) parent[k] = i;
        k = up;
      }
    }
  }
  // Columns of each row of L, row after row.
  starts_.assign(size + 1, 0);
  std::vector<int> mark(size, -1), columns, row_ends(size);
  columns.reserve(rows_.capacity());
  for (int i = 0; i != size; ++i) {
    mark[i] = i;
    for (int e = row_starts[i]; e != row_starts[i + 1]; ++e) {
      for (int k = entries[e].first; mark[k] != i; k = parent[k]) {
        mark[k] = i;
        columns.push_back(k);
        ++starts_[k + 1];
      }
    }
    row_ends[i] = columns.size();
  }
  for (int i = 0; i != size; ++i) starts_[i + 1] += starts_[i];
  rows_.resize(columns.size());
  next.assign(starts_.begin(), starts_.end() - 1);
  slots_.assign(pairs.size(), Slot());
  slot_of_matrix_.clear();
  matrix_of_pair_.assign(pairs.size(), 0);
  std::vector<int> matrix_of_column(size, -1);
  for (int i = 0, c = 0; i != size; ++i) {
    for (; c != row_ends[i]; ++c) rows_[next[columns[c]]++] = i;
    for (int e = row_starts[i]; e != row_starts[i + 1]; ++e) {
      const int column = entries[e].first, pair = entries[e].second;
      // The row just written is the last one of its column.
      Slot& slot = slots_[pair];
      slot.index = next[column] - 1;
      slot.transpose = position_[pairs[pair].first] != i;
      if (matrix_of_column[column] < 0 ||
          slot_of_matrix_[matrix_of_column[column]] != slot.index) {
        matrix_of_column[column] = slot_of_matrix_.size();
        slot_of_matrix_.push_back(slot.index);
      }
      matrix_of_pair_[pair] = matrix_of_column[column];
    }
  }
  ReserveForMore(rows_.size(), &blocks_);
  blocks_.resize(rows_.size());
  pivots_.resize(size);
  pivot_inverses_.resize(size);
  ReserveForMore(slot_of_matrix_.size(), &matrix_);
  matrix_.resize(slot_of_matrix_.size());
  diagonal_.resize(size);
  CountWork();
  FindPanels();
}

void BlockLdlt::CountWork() {
  work_ = 0.;
  for (int j = 0; j != size(); ++j) {
    const double rows = starts_[j + 1] - starts_[j];
    work_ += 27. * (0.5 * rows * rows + rows + 1.);
  }
}

bool BlockLdlt::Extend(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Slot> slots;
  for (const std::pair<int, int>& pair : pairs) {
    const int a = position_[pair.first], b = position_[pair.second];
    const auto begin = rows_.begin() + starts_[std::min(a, b)];
    const auto end = rows_.begin() + starts_[std::min(a, b) + 1];
    const auto it = std::lower_bound(begin, end, std::max(a, b));
    if (it == end || *it != std::max(a, b)) return false;
    Slot slot;
    slot.index = it - rows_.begin();
    slot.transpose = a < b;
    slots.push_back(slot);
  }
  for (const Slot& slot : slots) {
    matrix_of_pair_.push_back(slot_of_matrix_.size());
    slot_of_matrix_.push_back(slot.index);
    slots_.push_back(slot);
  }
  matrix_.resize(slot_of_matrix_.size());
  return true;
}

void BlockLdlt::SetZero() {
  for (Eigen::Matrix3d& block : matrix_) block.setZero();
  for (Eigen::Matrix3d& block : diagonal_) block.setZero();
}

template <typename Row, typename Rhs>
void BlockLdlt::SolveRows(Rhs* const rhs) const {
  const int n = size();
  std::vector<Row> x(n);
  for (int j = 0; j != n; ++j)
    x[j] = rhs->template middleRows<3>(3 * order_[j]);
  for (int j = 0; j != n; ++j) {
    const Row value = x[j];
    Substitute(value, blocks_.data() + starts_[j], rows_.data() + starts_[j],
               starts_[j + 1] - starts_[j], &x);
  }
  for (int j = n - 1; j >= 0; --j) {
    const Row value = pivot_inverses_[j] * x[j];
    x[j] = value - TransposedSum(blocks_.data() + starts_[j],
                                 rows_.data() + starts_[j],
                                 starts_[j + 1] - starts_[j], x);
  }
  for (int j = 0; j != n; ++j)
    rhs->template middleRows<3>(3 * order_[j]) = x[j];
}

void BlockLdlt::Solve(Eigen::VectorXd* const rhs) const {
  SolveRows<Eigen::Vector3d>(rhs);
}

void BlockLdlt::Solve(Columns* const rhs) const {
  SolveRows<Eigen::Matrix3d>(rhs);
}

}  // namespace optimization
}  // namespace cartographer_ext
