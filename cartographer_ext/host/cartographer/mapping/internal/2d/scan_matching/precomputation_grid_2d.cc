// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The grids of FastCorrelativeScanMatcher2D: maxima over ever larger squares.
#include <algorithm>
#include <cmath>

#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

// target[i] = max(target[i], source[i])
void RaiseTo(const uint8* __restrict const source, const int count,
             uint8* __restrict const target) {
  for (int i = 0; i < count; ++i) {
    target[i] = source[i] > target[i] ? source[i] : target[i];
  }
}

}  // namespace

PrecomputationGrid2D::PrecomputationGrid2D(const Grid2D& grid,
                                           const CellLimits& limits,
                                           const int width, std::vector<float>*)
    : num_x_cells_(limits.num_x_cells),
      num_y_cells_(limits.num_y_cells),
      min_score_(1.f - grid.GetMaxCorrespondenceCost()),
      max_score_(1.f - grid.GetMinCorrespondenceCost()) {
  CHECK_GE(width, 1);
  CHECK_GE(limits.num_x_cells, 1);
  CHECK_GE(limits.num_y_cells, 1);
  const float steps_per_score = 255.f / (max_score_ - min_score_);
  cells_.reserve(static_cast<size_t>(num_x_cells_) * num_y_cells_);
  for (const Eigen::Array2i& xy_index : XYIndexRangeIterator(limits)) {
    const float score = 1.f - std::abs(grid.GetCorrespondenceCost(xy_index));
    const int value =
        common::RoundToInt((score - min_score_) * steps_per_score);
    cells_.push_back(static_cast<uint8>(common::Clamp(value, 0, 255)));
  }
  // Rounding keeps the order of scores, so maxima may be taken of the rounded.
  while (2 * width_ <= width) *this = Widened(width_);
  if (width_ != width) *this = Widened(width - width_);
}

PrecomputationGrid2D PrecomputationGrid2D::Widened(const int more) const {
  CHECK_LE(more, width_);
  PrecomputationGrid2D wide;
  wide.width_ = width_ + more;
  wide.num_x_cells_ = num_x_cells_ + more;
  wide.num_y_cells_ = num_y_cells_ + more;
  wide.min_score_ = min_score_;
  wide.max_score_ = max_score_;
  wide.cells_.resize(static_cast<size_t>(wide.num_x_cells_) *
                     wide.num_y_cells_);
  // A wide square is two overlapping or touching narrow ones side by side. In
  // memory the one that begins earlier is `more` cells behind, as the wide grid
  // begins that much farther out.
  for (int y = 0; y != num_y_cells_; ++y) {
    const uint8* const narrow_row = cells_.data() + y * num_x_cells_;
    uint8* const wide_row = wide.cells_.data() + y * wide.num_x_cells_;
    std::copy_n(narrow_row, num_x_cells_, wide_row);
    RaiseTo(narrow_row, num_x_cells_, wide_row + more);
  }
  // The same for rows, from the last on, so that each still holds its old
  // content when it is needed.
  for (int y = wide.num_y_cells_ - 1; y >= more; --y) {
    uint8* const row = wide.cells_.data() + y * wide.num_x_cells_;
    RaiseTo(row - more * wide.num_x_cells_, wide.num_x_cells_, row);
  }
  return wide;
}

PrecomputationGridStack2D::PrecomputationGridStack2D(
    const Grid2D& grid,
    const proto::FastCorrelativeScanMatcherOptions2D& options) {
  const int depth = options.branch_and_bound_depth();
  CHECK_GE(depth, 1);
  CHECK_LE(depth, 16);
  precomputation_grids_.reserve(depth);
  precomputation_grids_.emplace_back(grid, grid.limits().cell_limits(), 1,
                                     nullptr);
  while (static_cast<int>(precomputation_grids_.size()) != depth) {
    const PrecomputationGrid2D& last = precomputation_grids_.back();
    precomputation_grids_.push_back(last.Widened(last.width()));
  }
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
