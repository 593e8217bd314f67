// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes and indices of grids. An index is (ix, iy); ix runs along -y of the
// world, iy along -x.
#ifndef CARTOGRAPHER_MAPPING_2D_XY_INDEX_H_
#define CARTOGRAPHER_MAPPING_2D_XY_INDEX_H_

#include <cstddef>
#include <iterator>

#include "Eigen/Core"
#include "cartographer/mapping/proto/cell_limits_2d.pb.h"

namespace cartographer {
namespace mapping {

struct CellLimits {
  CellLimits() = default;
  CellLimits(int init_num_x_cells, int init_num_y_cells)
      : num_x_cells(init_num_x_cells), num_y_cells(init_num_y_cells) {}
  explicit CellLimits(const proto::CellLimits& cell_limits)
      : CellLimits(cell_limits.num_x_cells(), cell_limits.num_y_cells()) {}

  int num_x_cells = 0;
  int num_y_cells = 0;
};

inline proto::CellLimits ToProto(const CellLimits& cell_limits) {
  proto::CellLimits result;
  result.set_num_x_cells(cell_limits.num_x_cells);
  result.set_num_y_cells(cell_limits.num_y_cells);
  return result;
}

// All indices of a rectangle, both corners included, row by row (ix fastest):
//   for (const Eigen::Array2i& xy_index : XYIndexRangeIterator(limits)) ...
// It is its own range and its own iterator.
class XYIndexRangeIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = Eigen::Array2i;
  using difference_type = std::ptrdiff_t;
  using pointer = const Eigen::Array2i*;
  using reference = const Eigen::Array2i&;

  XYIndexRangeIterator(const Eigen::Array2i& min_xy_index,
                       const Eigen::Array2i& max_xy_index)
      : min_(min_xy_index), max_(max_xy_index), current_(min_xy_index) {}
  explicit XYIndexRangeIterator(const CellLimits& cell_limits)
      : XYIndexRangeIterator(Eigen::Array2i::Zero(),
                             Eigen::Array2i(cell_limits.num_x_cells - 1,
                                            cell_limits.num_y_cells - 1)) {}

  XYIndexRangeIterator& operator++() {
    if (++current_.x() > max_.x()) {
      current_ = {min_.x(), current_.y() + 1};
    }
    return *this;
  }
  const Eigen::Array2i& operator*() const { return current_; }

  bool operator==(const XYIndexRangeIterator& other) const {
    return current_.x() == other.current_.x() &&
           current_.y() == other.current_.y();
  }
  bool operator!=(const XYIndexRangeIterator& other) const {
    return !(*this == other);
  }

  XYIndexRangeIterator begin() const { return {min_, max_}; }
  XYIndexRangeIterator end() const {
    XYIndexRangeIterator past_the_last = begin();
    const bool empty = (max_ < min_).any();
    past_the_last.current_ = {min_.x(), empty ? min_.y() : max_.y() + 1};
    return past_the_last;
  }

 private:
  Eigen::Array2i min_;
  Eigen::Array2i max_;
  Eigen::Array2i current_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_XY_INDEX_H_
