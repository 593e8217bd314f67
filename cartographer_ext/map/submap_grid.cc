// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/submap_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cartographer_ext/io/pbstream/grid_validation.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;

constexpr int kMaxCellValue = SubmapGrid::kNumValues - 1;
// Marks a cell that was touched in the current update; never meant for files.
constexpr int kUpdateMarker = 1 << 15;
constexpr float kSurface = 0.9f;
constexpr float kFree = 0.1f;

// 1 to kMaxCellValue; 0 for an unknown cell.
uint16_t ToValue(const int cell) {
  const int number = cell >= kUpdateMarker ? cell - kUpdateMarker : cell;
  return static_cast<uint16_t>(number <= 0 || number > kMaxCellValue ? 0
                                                                     : number);
}

}  // namespace

constexpr int TileLayout::kBits;
constexpr int TileLayout::kSide;
constexpr int TileLayout::kArea;
constexpr uint32_t SubmapGrid::kUnknown;
constexpr int SubmapGrid::kNumValues;

absl::StatusOr<SubmapGrid> SubmapGrid::Make(const Grid2D& grid) {
  const absl::Status status = io::CheckGridLayout(grid);
  if (!status.ok()) return status;
  return SubmapGrid(grid);
}

SubmapGrid::SubmapGrid(const Grid2D& grid)
    : resolution_(grid.limits().resolution()),
      max_(grid.limits().max().x(), grid.limits().max().y()),
      num_x_(grid.limits().cell_limits().num_x_cells()),
      num_y_(grid.limits().cell_limits().num_y_cells()),
      is_tsdf_(grid.has_tsdf_2d()),
      tiles_(num_x_, num_y_),
      begins_(tiles_.size(), kUnknown) {
  if (is_tsdf_) {
    upper_ = grid.tsdf_2d().truncation_distance();
    lower_ = -upper_;
  } else {
    // Older files do not name their bounds.
    const bool named = grid.max_correspondence_cost() > 0.f;
    lower_ = named ? grid.min_correspondence_cost() : 0.1;
    upper_ = named ? grid.max_correspondence_cost() : 0.9;
  }
  TakeCells(grid);
}

void SubmapGrid::TakeCells(const Grid2D& grid) {
  values_.resize(TileLayout::kArea, 0);
  CellBox known{num_x_, -1, num_y_, -1};
  std::array<uint16_t, TileLayout::kArea> values;
  for (size_t tile = 0; tile != tiles_.size(); ++tile) {
    const CellBox cells = tiles_.CellsOf(tile);
    const int64_t known_before = num_known_;
    values.fill(0);
    for (int iy = cells.min_y; iy <= cells.max_y; ++iy) {
      const int* const row =
          grid.cells().data() + static_cast<int64_t>(num_x_) * iy;
      for (int ix = cells.min_x; ix <= cells.max_x; ++ix) {
        const uint16_t value = ToValue(row[ix]);
        if (value == 0) continue;
        values[TileLayout::CellInTile(ix, iy)] = value;
        ++num_known_;
        known = {std::min(known.min_x, ix), std::max(known.max_x, ix),
                 std::min(known.min_y, iy), std::max(known.max_y, iy)};
      }
    }
    if (num_known_ == known_before) continue;
    begins_[tile] = static_cast<uint32_t>(values_.size());
    values_.insert(values_.end(), values.begin(), values.end());
  }
  values_.shrink_to_fit();
  if (num_known_ > 0) known_box_ = known;
}

float SubmapGrid::OccupancyOf(const int value) const {
  if (value == 0) return std::numeric_limits<float>::quiet_NaN();
  const double cost =
      lower_ + (value - 1) * (upper_ - lower_) / (kMaxCellValue - 1);
  if (is_tsdf_) return std::abs(cost) <= 0.5 * resolution_ ? kSurface : kFree;
  return static_cast<float>(1. - cost);
}

}  // namespace evaluation
}  // namespace cartographer_ext
