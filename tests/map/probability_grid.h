// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Small probability grids.
#ifndef TESTS_MAP_PROBABILITY_GRID_H_
#define TESTS_MAP_PROBABILITY_GRID_H_

#include "cartographer/mapping/proto/grid_2d.pb.h"

namespace cartographer_ext {
namespace test {

// All cells with this value; the corner with the largest coordinates is at
// (max_x, max_y).
inline cartographer::mapping::proto::Grid2D ProbabilityGrid(
    const double resolution, const double max_x, const double max_y,
    const int num_x_cells, const int num_y_cells, const int value) {
  cartographer::mapping::proto::Grid2D grid;
  grid.mutable_limits()->set_resolution(resolution);
  grid.mutable_limits()->mutable_max()->set_x(max_x);
  grid.mutable_limits()->mutable_max()->set_y(max_y);
  auto* const cells = grid.mutable_limits()->mutable_cell_limits();
  cells->set_num_x_cells(num_x_cells);
  cells->set_num_y_cells(num_y_cells);
  grid.mutable_probability_grid_2d();
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  for (int i = 0; i < num_x_cells * num_y_cells; ++i) grid.add_cells(value);
  return grid;
}

// Ten by six free cells of 0.1 m in x and y, corner at (2, 3): x from 1 to 2, y
// from 2.4 to 3. Cell (ix, iy) is ix from the top and iy from the right.
inline cartographer::mapping::proto::Grid2D FreeGrid() {
  return ProbabilityGrid(0.1, 2., 3., 6, 10, 32767);
}

inline void SetCell(const int ix, const int iy, const int value,
                    cartographer::mapping::proto::Grid2D* const grid) {
  grid->set_cells(6 * iy + ix, value);
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_MAP_PROBABILITY_GRID_H_
