// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/occupancy_view.h"

#include <algorithm>
#include <limits>

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One axis of the walk from cell border to cell border.
struct Axis {
  int cell;
  int step;
  double next;   // distance along the ray to the next border
  double delta;  // distance along the ray from border to border
};

Axis MakeAxis(double position, double direction, double resolution) {
  Axis axis;
  axis.cell = static_cast<int>(std::floor(position / resolution));
  if (std::abs(direction) < 1e-12) {
    axis.step = 0;
    axis.next = kInfinity;
    axis.delta = kInfinity;
    return axis;
  }
  axis.step = direction > 0. ? 1 : -1;
  const double border =
      (axis.cell + (direction > 0. ? 1 : 0)) * resolution - position;
  axis.next = border / direction;
  axis.delta = resolution / std::abs(direction);
  return axis;
}

}  // namespace

double CastRay(const OccupancyView& view, const Eigen::Vector2d& start,
               double angle, const RayOptions& options) {
  const Eigen::Vector2d local = start - view.origin();
  const double extent =
      view.resolution() * std::max(view.num_x(), view.num_y());
  // Starts far outside would overflow the cell index; they are unknown anyway.
  if (!local.allFinite() || !std::isfinite(angle) ||
      local.cwiseAbs().maxCoeff() > extent) {
    return kNaN;
  }
  Axis x = MakeAxis(local.x(), std::cos(angle), view.resolution());
  Axis y = MakeAxis(local.y(), std::sin(angle), view.resolution());
  if (view.At(x.cell, y.cell) != CellState::kFree) return kNaN;
  double range = 0.;
  double unknown = 0.;
  bool in_unknown = false;
  while (true) {
    const bool along_x = x.next <= y.next;
    Axis& axis = along_x ? x : y;
    const double border = axis.next;
    if (in_unknown) {
      unknown += std::min(border, options.max_range) - range;
      if (unknown > options.max_unknown) return kNaN;
    }
    if (border >= options.max_range) return options.max_range;
    range = border;
    axis.cell += axis.step;
    axis.next += axis.delta;
    if (!view.Contains(x.cell, y.cell)) {
      // All further cells are unknown.
      unknown += options.max_range - range;
      return unknown > options.max_unknown ? kNaN : options.max_range;
    }
    const CellState state = view.At(x.cell, y.cell);
    if (state == CellState::kOccupied) return range;
    in_unknown = state == CellState::kUnknown;
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
