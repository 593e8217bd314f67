// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Walks a straight line through the cells of a grid (Amanatides and Woo 1987).
#ifndef CARTOGRAPHER_EXT_NAVIGATION_GRID_RAY_H_
#define CARTOGRAPHER_EXT_NAVIGATION_GRID_RAY_H_

#include <algorithm>
#include <cmath>
#include <limits>

#include "Eigen/Core"
#include "cartographer_ext/navigation/grid_geometry.h"

namespace cartographer_ext {
namespace navigation {

// Calls visit(cell, length) for every cell that the line from `from` to `to`
// passes, in order, with the length inside it; both are in units of cells.
// Stops when visit returns false, and then returns false.
template <typename Visitor>
bool VisitLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               const Visitor& visit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d delta = to - from;
  const double length = delta.norm();
  Cell cell{static_cast<int>(std::floor(from.x())),
            static_cast<int>(std::floor(from.y()))};
  const Cell last{static_cast<int>(std::floor(to.x())),
                  static_cast<int>(std::floor(to.y()))};
  const int step_x = delta.x() > 0. ? 1 : -1, step_y = delta.y() > 0. ? 1 : -1;
  // Ratios of the line at which it crosses the next border in x and in y.
  const double width_x = delta.x() == 0. ? kInfinity : 1. / std::abs(delta.x());
  const double width_y = delta.y() == 0. ? kInfinity : 1. / std::abs(delta.y());
  double next_x = delta.x() == 0.
                      ? kInfinity
                      : (cell.x + (step_x > 0) - from.x()) / delta.x();
  double next_y = delta.y() == 0.
                      ? kInfinity
                      : (cell.y + (step_y > 0) - from.y()) / delta.y();
  double ratio = 0.;
  int steps = std::abs(last.x - cell.x) + std::abs(last.y - cell.y);
  while (true) {
    const double next =
        steps == 0 ? 1. : std::min(1., std::min(next_x, next_y));
    if (!visit(cell, length * std::max(0., next - ratio))) return false;
    if (steps-- == 0) return true;
    ratio = next;
    // Never beyond the last column or row, whatever rounding says.
    const bool along_x =
        cell.y == last.y || (cell.x != last.x && next_x < next_y);
    if (along_x) {
      cell.x += step_x;
      next_x += width_x;
    } else {
      cell.y += step_y;
      next_y += width_y;
    }
  }
}

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_GRID_RAY_H_
