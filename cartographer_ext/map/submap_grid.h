// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells of a submap as a state holds them, in a fraction of the memory. A
// grid that is long or has grown by doubling is mostly unknown, and a message
// takes four bytes for each cell: of seven robot maps 7 to 28 % of the cells
// are known. Here the grid is in square tiles, of which only those with a known
// cell are kept, with two bytes for each cell.
//
// Cell ix runs against the y axis, iy against the x axis, from the corner with
// the largest coordinates.
#ifndef CARTOGRAPHER_EXT_MAP_SUBMAP_GRID_H_
#define CARTOGRAPHER_EXT_MAP_SUBMAP_GRID_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/grid_2d.pb.h"

namespace cartographer_ext {
namespace evaluation {

// A box of cells, both corners included; empty as made.
struct CellBox {
  int min_x = 0, max_x = -1, min_y = 0, max_y = -1;

  bool empty() const { return max_x < min_x || max_y < min_y; }
  bool operator==(const CellBox& other) const {
    return min_x == other.min_x && max_x == other.max_x &&
           min_y == other.min_y && max_y == other.max_y;
  }
  CellBox Intersection(const CellBox& other) const {
    return {std::max(min_x, other.min_x), std::min(max_x, other.max_x),
            std::max(min_y, other.min_y), std::min(max_y, other.max_y)};
  }
  // Columns or rows between the boxes, whichever are more; 0 if they touch.
  int Gap(const CellBox& other) const {
    return std::max({0, other.min_x - max_x - 1, min_x - other.max_x - 1,
                     other.min_y - max_y - 1, min_y - other.max_y - 1});
  }
};

// How a grid is divided into square tiles. They are numbered row by row, as are
// the cells of each.
class TileLayout {
 public:
  static constexpr int kBits = 3;
  static constexpr int kSide = 1 << kBits;  // cells
  static constexpr int kArea = kSide * kSide;

  TileLayout(const int num_x, const int num_y)
      : num_x_(num_x), num_y_(num_y), per_row_((num_x + kSide - 1) / kSide) {}

  size_t size() const {
    return static_cast<size_t>(per_row_) * ((num_y_ + kSide - 1) / kSide);
  }
  size_t TileOf(const int ix, const int iy) const {
    return static_cast<size_t>(iy >> kBits) * per_row_ + (ix >> kBits);
  }
  static int CellInTile(const int ix, const int iy) {
    return (iy & (kSide - 1)) << kBits | (ix & (kSide - 1));
  }
  int per_row() const { return per_row_; }
  // The cells of a tile that are in the grid.
  CellBox CellsOf(const size_t tile) const {
    const int x = kSide * static_cast<int>(tile % per_row_);
    const int y = kSide * static_cast<int>(tile / per_row_);
    return {x, std::min(num_x_, x + kSide) - 1, y,
            std::min(num_y_, y + kSide) - 1};
  }

 private:
  int num_x_, num_y_;
  int per_row_;
};

class SubmapGrid {
 public:
  // An error where io::CheckGridLayout has one.
  static absl::StatusOr<SubmapGrid> Make(
      const cartographer::mapping::proto::Grid2D& grid);

  double resolution() const { return resolution_; }  // metres
  int num_x() const { return num_x_; }
  int num_y() const { return num_y_; }
  // Corners in the local frame of the trajectory, metres.
  const Eigen::Vector2d& max_corner() const { return max_; }
  Eigen::Vector2d min_corner() const {
    return max_ - resolution_ * Eigen::Vector2d(num_y_, num_x_);
  }
  // The smallest box with all known cells.
  const CellBox& known_box() const { return known_box_; }
  int64_t num_known() const { return num_known_; }
  const TileLayout& tiles() const { return tiles_; }
  // Whether the tile has a known cell.
  bool HasTile(const size_t tile) const { return begins_[tile] != kUnknown; }

  // Probability of occupancy of a cell inside the grid, NaN where unknown. In
  // TSDF grids, a cell is occupied within half a cell of a surface and free
  // elsewhere.
  float Occupancy(const int ix, const int iy) const {
    return OccupancyOf(Value(ix, iy));
  }
  // The values that cells have, 0 if unknown, and what they stand for.
  static constexpr int kNumValues = 32768;
  int Value(const int ix, const int iy) const {
    return values_[begins_[tiles_.TileOf(ix, iy)] +
                   TileLayout::CellInTile(ix, iy)];
  }
  float OccupancyOf(int value) const;

 private:
  static constexpr uint32_t kUnknown = 0;  // the first tile is an unknown one

  explicit SubmapGrid(const cartographer::mapping::proto::Grid2D& grid);
  void TakeCells(const cartographer::mapping::proto::Grid2D& grid);

  double resolution_;
  Eigen::Vector2d max_;
  int num_x_, num_y_;
  bool is_tsdf_;
  // Of the costs or distances that the values stand for.
  double lower_, upper_;
  CellBox known_box_;
  int64_t num_known_ = 0;
  TileLayout tiles_;
  std::vector<uint32_t> begins_;  // where in `values_` each tile begins
  std::vector<uint16_t> values_;  // 0: unknown
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_SUBMAP_GRID_H_
