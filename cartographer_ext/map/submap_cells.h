// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the grid of a submap says about a place: whether it is free or occupied,
// and how far the next wall is. Scans are held against it.
//
// Distances are numbers of cells along the axis in which they are more
// (chessboard distance). Where nothing is known and no wall is near, one lower
// bound stands for a whole tile.
#ifndef CARTOGRAPHER_EXT_MAP_SUBMAP_CELLS_H_
#define CARTOGRAPHER_EXT_MAP_SUBMAP_CELLS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/submap_grid.h"

namespace cartographer_ext {
namespace evaluation {

// State of a cell in a submap. Cells with intermediate probability, and those
// next to unknown cells, are unsure.
enum class CellEvidence : uint8_t { kUnsure, kFree, kOccupied };

// A cell on a ray.
struct CellView {
  CellEvidence evidence = CellEvidence::kUnsure;
  // No point that is at most so far away along each axis, in cells, lies in an
  // occupied cell; negative if this cannot be said of any.
  double reach = 0.;
  // Occupied, or within the margin of an occupied cell.
  bool near_occupied = false;
  bool is_outside = false;  // of the grid
};

class SubmapCells {
 public:
  // The largest tolerance of CountNearOccupied, metres.
  static constexpr double kReach = 0.25;

  // `margin`: metres around occupied or unknown cells in which a free cell does
  // not count as free. It and kReach are at most kFar - 1 cells, or count so.
  SubmapCells(SubmapGrid grid, double margin);

  const SubmapGrid& grid() const { return grid_; }
  SubmapGrid TakeGrid() && { return std::move(grid_); }
  double resolution() const { return grid_.resolution(); }
  // Corners of the grid in the local frame of the trajectory, metres.
  Eigen::Vector2d min_corner() const { return grid_.min_corner(); }
  Eigen::Vector2d max_corner() const { return grid_.max_corner(); }

  // `point`: in the local frame of the trajectory, metres.
  CellEvidence At(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d cell = Cell(point);
    return IsInside(cell) ? ToEvidence(Code(cell)) : CellEvidence::kUnsure;
  }
  // The same, and how far it is to the next wall.
  CellView View(const Eigen::Vector2d& point) const {
    return ViewOfCell(Cell(point));
  }
  // Continuous indices of a point, which rise by one per cell.
  Eigen::Vector2d Cell(const Eigen::Vector2d& point) const {
    return Eigen::Vector2d(
        (grid_.max_corner().y() - point.y()) / grid_.resolution(),
        (grid_.max_corner().x() - point.x()) / grid_.resolution());
  }
  CellView ViewOfCell(const Eigen::Vector2d& cell) const {
    CellView view;
    if (IsInside(cell)) {
      const uint8_t code = Code(cell);
      const int distance = code & kFar;
      view.evidence = ToEvidence(code);
      view.near_occupied = distance <= radius_;
      // The point may lie at the edge of its cell.
      view.reach = distance - 1 - kRounding;
    } else if (cell.allFinite()) {
      view.is_outside = true;
      view.reach =
          std::min((cell - Eigen::Vector2d(grid_.num_x(), grid_.num_y()))
                       .cwiseMax(-cell)
                       .maxCoeff(),
                   1e6) -
          kRounding;
    }
    return view;
  }
  bool NearOccupied(const Eigen::Vector2d& point) const {
    return View(point).near_occupied;
  }
  // For each shift, how many of the points come to lie at most `tolerance`
  // (metres, in whole cells, each axis) from an occupied cell. `points` and
  // `shifts` in the local frame.
  std::vector<int> CountNearOccupied(const std::vector<Eigen::Vector2d>& points,
                                     const std::vector<Eigen::Vector2d>& shifts,
                                     double tolerance) const;
  // Mean probability of occupancy under the points, as the loop search scores a
  // match (0.1 for unknown cells); accurate to a few thousandths. `points` in
  // the frame of a node, `local_from_node` places them in the local frame.
  double Score(const std::vector<Eigen::Vector2d>& points,
               const Pose2& local_from_node) const;
  // Centres of the occupied cells, in the local frame.
  std::vector<Eigen::Vector2d> OccupiedCells() const;

 private:
  // A code is the distance to the nearest occupied cell, at most kFar, and
  // whether the cell is free.
  static constexpr uint8_t kFar = 127;
  static constexpr uint8_t kFree = 128;
  // More than rounding moves a point, cells.
  static constexpr double kRounding = 1e-3;

  static CellEvidence ToEvidence(const uint8_t code) {
    return code == 0      ? CellEvidence::kOccupied
           : code < kFree ? CellEvidence::kUnsure
                          : CellEvidence::kFree;
  }
  class BoxBytes;
  // `codes` of all that is known, and of `reach` cells around it.
  void TakeTiles(BoxBytes* codes, int reach);
  int InCells(double metres) const;

  bool IsInside(const Eigen::Vector2d& cell) const {
    return cell.x() >= 0. && cell.y() >= 0. && cell.x() < grid_.num_x() &&
           cell.y() < grid_.num_y();
  }
  // The codes of the first `num` of many cells, by their continuous indices; kFar
  // outside. The vectors have room for so many, rounded up to a multiple of four.
  void FindCodes(const std::vector<double>& x, const std::vector<double>& y,
                 size_t num, std::vector<int32_t>* codes) const;
  // Of a cell inside.
  uint8_t Code(const Eigen::Vector2d& cell) const {
    return Code(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  }
  uint8_t Code(const int ix, const int iy) const {
    const int begin = begins_[grid_.tiles().TileOf(ix, iy)];
    return begin < 0 ? static_cast<uint8_t>(-begin)
                     : codes_[begin + TileLayout::CellInTile(ix, iy)];
  }

  SubmapGrid grid_;
  int radius_;  // the margin, cells
  // Where in `codes_` each tile begins; negative: less the distance of all its
  // cells, which are unsure.
  std::vector<int32_t> begins_;
  // With four bytes more, so that four can be read from any.
  std::vector<uint8_t> codes_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_SUBMAP_CELLS_H_
