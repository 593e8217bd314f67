// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"

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

constexpr int OccupancyView::kMaxReach;
constexpr uint8_t OccupancyView::kFar;
constexpr uint8_t OccupancyView::kKnown;

void OccupancyView::FindDistances(const int reach) {
  CHECK_GE(reach, 0);
  const int radius = std::min(reach, kMaxReach);
  const size_t num_x = static_cast<size_t>(num_x_);
  // Squared distance along the row, then the nearest over the rows around.
  std::vector<uint8_t> along(cells_.size(), kFar);
  for (int j = 0; j < num_y_; ++j) {
    const uint8_t* const row = cells_.data() + Offset(0, j);
    uint8_t* const squares = along.data() + Offset(0, j);
    for (const bool backwards : {false, true}) {
      int since = radius + 1;
      for (int k = 0; k < num_x_; ++k) {
        const int i = backwards ? num_x_ - 1 - k : k;
        since = row[i] == kKnown ? 0 : since + 1;
        if (since <= radius) {
          squares[i] =
              std::min(squares[i], static_cast<uint8_t>(since * since));
        }
      }
    }
  }
  std::vector<uint8_t> nearest(num_x);
  for (int j = 0; j < num_y_; ++j) {
    std::fill(nearest.begin(), nearest.end(), kFar);
    for (int k = std::max(0, j - radius); k <= std::min(num_y_ - 1, j + radius);
         ++k) {
      const uint8_t apart = static_cast<uint8_t>((j - k) * (j - k));
      const uint8_t* const squares = along.data() + Offset(0, k);
      for (size_t i = 0; i < num_x; ++i) {
        // At most 127 + 121, which a byte holds.
        const uint8_t square = static_cast<uint8_t>(squares[i] + apart);
        nearest[i] = std::min(nearest[i], square);
      }
    }
    uint8_t* const row = cells_.data() + Offset(0, j);
    const uint8_t most = static_cast<uint8_t>(radius * radius);
    for (size_t i = 0; i < num_x; ++i) {
      row[i] = static_cast<uint8_t>((row[i] & kKnown) |
                                    (nearest[i] <= most ? nearest[i] : kFar));
    }
  }
}

double CastRay(const OccupancyView& view, const Eigen::Vector2d& start,
               const double angle, const RayOptions& options) {
  if (!std::isfinite(angle)) return kNaN;
  return CastRay(view, start, Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                 options);
}

double CastRay(const OccupancyView& view, const Eigen::Vector2d& start,
               const Eigen::Vector2d& direction, const RayOptions& options) {
  const Eigen::Vector2d local = start - view.origin();
  const double extent =
      view.resolution() * std::max(view.num_x(), view.num_y());
  // Starts far outside would overflow the cell index; they are unknown anyway.
  if (!local.allFinite() || !direction.allFinite() ||
      local.cwiseAbs().maxCoeff() > extent) {
    return kNaN;
  }
  Axis x = MakeAxis(local.x(), direction.x(), view.resolution());
  Axis y = MakeAxis(local.y(), direction.y(), view.resolution());
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
