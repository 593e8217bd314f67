// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A probability grid of the host in the form that OccupiedSpaceCost expects.
// Host indices are (column, row).
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_CELLS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_CELLS_H_

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer_ext/scan_matching/dropin/grid_rows.h"

namespace cartographer_ext {
namespace scan_matching {

// The `Cells` of OccupiedSpaceCost for a grid of the host.
class GridCells {
 public:
  // The grid must outlive it.
  explicit GridCells(const cartographer::mapping::Grid2D* const grid)
      : grid_(*grid) {}

  double resolution() const { return grid_.limits().resolution(); }
  double max_x() const { return grid_.limits().max().x(); }
  double max_y() const { return grid_.limits().max().y(); }
  int num_rows() const { return grid_.limits().cell_limits().num_y_cells; }
  int num_columns() const { return grid_.limits().cell_limits().num_x_cells; }
  void CopyCosts(const int row, const int column, const int count,
                 float* const costs) const {
    CopyFewCosts(grid_, column, row, count, costs);
  }
  bool IsKnown(const int row, const int column) const {
    return grid_.IsKnown(Eigen::Array2i(column, row));
  }

 private:
  const cartographer::mapping::Grid2D& grid_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_GRID_CELLS_H_
