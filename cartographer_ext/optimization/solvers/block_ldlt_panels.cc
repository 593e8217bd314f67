// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The numerical factorisation, by panels: neighbouring columns that have the same
// rows below the last of them, as those of a separator have (supernodes; Ng and
// Peyton 1993). What a panel subtracts from a later one are dense products, for
// which its columns are copied once, below each other. Most panels of a sparse graph
// are single columns, whose blocks are subtracted one by one.
//
// Left-looking: a finished panel waits in the list of the panel with the row that it
// reaches next.
#include <algorithm>
#include <numeric>

#include "cartographer_ext/optimization/solvers/block_kernels.h"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Columns of a panel. Within one, blocks are subtracted one by one.
constexpr int kMaxColumns = 8;
// Rows of a panel for which a copy pays.
constexpr int kMinRows = 4;
// Rows that are multiplied while they are in the nearest memory.
constexpr int kRowsAtOnce = 64;

}  // namespace

void BlockLdlt::FindPanels() {
  const int n = size();
  panel_starts_.clear();
  panel_of_column_.resize(n);
  packed_starts_.clear();
  size_t packed = 0;
  for (int begin = 0; begin != n;) {
    int end = begin + 1;
    // A column whose first row is the next column has at most one row more.
    while (end != n && end - begin != kMaxColumns &&
           starts_[end] != starts_[end - 1] && rows_[starts_[end - 1]] == end &&
           starts_[end] - starts_[end - 1] ==
               starts_[end + 1] - starts_[end] + 1) {
      ++end;
    }
    std::fill(panel_of_column_.begin() + begin, panel_of_column_.begin() + end,
              panel_starts_.size());
    panel_starts_.push_back(begin);
    packed_starts_.push_back(packed);
    const int rows = starts_[end] - starts_[end - 1];
    if (end - begin > 1 && rows >= kMinRows) {
      packed += static_cast<size_t>(9) * (end - begin) * rows;
    }
    begin = end;
  }
  panel_starts_.push_back(n);
  packed_starts_.push_back(packed);
  packed += kPanelPadding;
  if (packed_ != nullptr && packed <= packed_size_) return;
  // Without values: those that are not used take no memory.
  packed_size_ = 2 * packed;
  packed_.reset(static_cast<double*>(
      AllocateOnLargePages(packed_size_ * sizeof(double))));
}

// One factorisation. The blocks hold the matrix before and L after it.
class BlockLdlt::PanelFactorization {
 public:
  explicit PanelFactorization(BlockLdlt* const ldlt)
      : kernels_(BestBlockKernels()),
        ldlt_(*ldlt),
        starts_(ldlt->starts_),
        rows_(ldlt->rows_),
        blocks_(ldlt->blocks_),
        pivots_(ldlt->pivots_),
        place_of_row_(ldlt->size(), -1),
        same_place_(ldlt->size()) {
    std::iota(same_place_.begin(), same_place_.end(), 0);
  }

  bool Run() {
    const int panels = ldlt_.panel_starts_.size() - 1;
    std::vector<int> first(panels, -1), link(panels, -1), reached(panels, 0);
    const auto wait = [&](const int panel) {
      const Panel waiting = PanelOf(panel);
      if (reached[panel] == waiting.rows) return;
      const int next =
          ldlt_.panel_of_column_[rows_[waiting.first_row + reached[panel]]];
      link[panel] = first[next];
      first[next] = panel;
    };
    for (int j = 0; j != panels; ++j) {
      const Panel target = PanelOf(j);
      SetPlaces(target);
      for (int k = first[j]; k != -1;) {
        const int next_in_list = link[k];
        reached[k] = Subtract(PanelOf(k), reached[k], target);
        wait(k);
        k = next_in_list;
      }
      if (!Eliminate(target)) return false;
      if (target.packed != nullptr) Pack(target);
      wait(j);
    }
    return true;
  }

 private:
  struct Panel {
    int begin, end;       // columns
    int first_row, rows;  // below the last column: place in rows_, number
    double* packed;       // null if there is no copy
    int columns() const { return end - begin; }
  };

  Panel PanelOf(const int number) const {
    Panel result;
    result.begin = ldlt_.panel_starts_[number];
    result.end = ldlt_.panel_starts_[number + 1];
    result.first_row = starts_[result.end - 1];
    result.rows = starts_[result.end] - result.first_row;
    const size_t start = ldlt_.packed_starts_[number];
    result.packed = ldlt_.packed_starts_[number + 1] == start
                        ? nullptr
                        : ldlt_.packed_.get() + start;
    return result;
  }

  // Row `row` of the panel in a column of it.
  int IndexOf(const Panel& panel, const int column, const int row) const {
    return starts_[column] + panel.end - 1 - column + row;
  }

  // Places of the rows of a panel: its columns first.
  void SetPlaces(const Panel& panel) {
    for (int j = panel.begin; j != panel.end; ++j) {
      place_of_row_[j] = j - panel.begin;
    }
    for (int r = 0; r != panel.rows; ++r) {
      place_of_row_[rows_[panel.first_row + r]] = panel.columns() + r;
    }
  }

  // The product with a block of row `column` of what an earlier column subtracts
  // from that one; subtracts it from the pivot.
  void FactorOf(const int earlier, const int index, const int column,
                Eigen::Matrix3d* const factor) {
    kernels_.subtract_from_pivot(pivots_[earlier], blocks_[index], factor,
                                 &pivots_[column]);
  }

  // Subtracts from a panel what an earlier one, from a row on, has to; returns the
  // first row behind it.
  int Subtract(const Panel& source, const int from, const Panel& target) {
    const int* const rows = &rows_[source.first_row];
    int end = from + 1;
    while (end != source.rows && rows[end] < target.end) ++end;
    if (source.packed != nullptr) {
      SubtractPacked(source, from, end, target);
      return end;
    }
    Eigen::Matrix3d factor;
    for (int r = from; r != end; ++r) {
      for (int k = source.begin; k != source.end; ++k) {
        const int index = IndexOf(source, k, r);
        FactorOf(k, index, rows[r], &factor);
        kernels_.subtract_products(factor, &blocks_[index] + 1, rows + r + 1,
                                   source.rows - r - 1, place_of_row_.data(),
                                   Column(target, rows[r]));
      }
    }
    return end;
  }

  // The blocks of a column by the place of their row.
  Eigen::Matrix3d* Column(const Panel& panel, const int column) {
    return blocks_.data() + starts_[column] - (column - panel.begin) - 1;
  }

  void SubtractPacked(const Panel& source, const int from, const int end,
                      const Panel& target) {
    const int inner = 3 * source.columns(), stride = 3 * source.rows;
    factors_.resize(3 * inner * (end - from));
    places_.clear();
    for (int r = from; r != source.rows; ++r) {
      places_.push_back(place_of_row_[rows_[source.first_row + r]]);
    }
    Eigen::Matrix3d factor;
    for (int r = from; r != end; ++r) {
      double* values = factors_.data() + 3 * inner * (r - from);
      for (int k = source.begin; k != source.end; ++k, values += 9) {
        FactorOf(k, IndexOf(source, k, r), rows_[source.first_row + r],
                 &factor);
        for (int i = 0; i != 9; ++i) values[i] = factor(i / 3, i % 3);
      }
    }
    for (int low = from; low < source.rows; low += kRowsAtOnce) {
      const int high = std::min(source.rows, low + kRowsAtOnce);
      for (int r = from; r != std::min(end, high - 1); ++r) {
        const int begin = std::max(low, r + 1);
        kernels_.subtract_panel(source.packed + 3 * begin, stride, inner,
                                factors_.data() + 3 * inner * (r - from),
                                places_.data() + begin - from, high - begin,
                                Column(target, rows_[source.first_row + r]));
      }
    }
  }

  bool Eliminate(const Panel& panel) {
    Eigen::Matrix3d factor;
    for (int j = panel.begin; j != panel.end; ++j) {
      Eigen::Matrix3d* const column = blocks_.data() + starts_[j];
      const int count = starts_[j + 1] - starts_[j];
      for (int k = panel.begin; k != j; ++k) {
        const int index = starts_[k] + j - k - 1;
        FactorOf(k, index, j, &factor);
        kernels_.subtract_products(factor, &blocks_[index] + 1,
                                   same_place_.data(), count, nullptr, column);
      }
      // What is asymmetric by rounding would grow from column to column.
      CopyLowerTriangle(&pivots_[j]);
      Eigen::Matrix3d& inverse = ldlt_.pivot_inverses_[j];
      if (!InvertSpd(pivots_[j], &inverse)) return false;
      kernels_.scale(inverse, count, column);
    }
    return true;
  }

  void Pack(const Panel& panel) {
    double* values = panel.packed;
    for (int k = panel.begin; k != panel.end; ++k) {
      const Eigen::Matrix3d* const column = &blocks_[IndexOf(panel, k, 0)];
      for (int c = 0; c != 3; ++c) {
        for (int r = 0; r != panel.rows; ++r, values += 3) {
          std::copy_n(column[r].data() + 3 * c, 3, values);
        }
      }
    }
  }

  const BlockKernels& kernels_;
  BlockLdlt& ldlt_;
  const std::vector<int>& starts_;
  const std::vector<int>& rows_;
  LargeVector<Eigen::Matrix3d>& blocks_;
  LargeVector<Eigen::Matrix3d>& pivots_;
  std::vector<int> place_of_row_;  // in the present panel
  std::vector<int> places_;
  std::vector<double> factors_;
  std::vector<int> same_place_;
};

bool BlockLdlt::Factorize(const double lambda) {
  for (Eigen::Matrix3d& block : blocks_) block.setZero();
  for (size_t k = 0; k != matrix_.size(); ++k) {
    blocks_[slot_of_matrix_[k]] += matrix_[k];
  }
  pivots_ = diagonal_;
  for (Eigen::Matrix3d& pivot : pivots_) pivot.diagonal() *= 1. + lambda;
  return PanelFactorization(this).Run();
}

}  // namespace optimization
}  // namespace cartographer_ext
