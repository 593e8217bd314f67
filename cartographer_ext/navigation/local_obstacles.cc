// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/local_obstacles.h"

#include <algorithm>
#include <limits>

#include "cartographer_ext/navigation/distance_transform.h"

namespace cartographer_ext {
namespace navigation {

LocalObstacles::LocalObstacles(const Costmap& costmap,
                               const ObstacleLayer* const layer,
                               const std::vector<Eigen::Vector2d>& echoes,
                               const Eigen::Vector2d& center,
                               const double half_width)
    : geometry_(&costmap.geometry()) {
  const int reach =
      static_cast<int>(std::ceil(half_width / geometry_->resolution()));
  const Cell middle = geometry_->CellAt(center);
  first_ = {middle.x - reach, middle.y - reach};
  width_ = 2 * reach + 1;
  std::vector<uint8_t> occupied(width_ * width_);
  const bool unknown_is_free = costmap.options().unknown_is_free;
  for (int y = 0; y != width_; ++y) {
    for (int x = 0; x != width_; ++x) {
      const Cell cell{first_.x + x, first_.y + y};
      const CellState state = costmap.state(cell);
      occupied[y * width_ + x] =
          state == CellState::kOccupied ||
          (state == CellState::kUnknown && !unknown_is_free);
    }
  }
  const auto mark = [&](const Cell& cell) {
    const int x = cell.x - first_.x, y = cell.y - first_.y;
    if (x >= 0 && y >= 0 && x < width_ && y < width_) {
      occupied[y * width_ + x] = 1;
    }
  };
  if (layer != nullptr) {
    for (const Cell& cell : layer->marks()) mark(cell);
  }
  for (const Eigen::Vector2d& echo : echoes) {
    if (echo.allFinite()) mark(geometry_->CellAt(echo));
  }
  distances_ =
      DistanceTransform(occupied, width_, width_, geometry_->resolution());
}

double LocalObstacles::Clearance(const Footprint& footprint,
                                 const Pose2& pose) const {
  double clearance = std::numeric_limits<double>::infinity();
  for (const Footprint::Part& part : footprint.parts) {
    clearance = std::min(clearance, Distance(pose * part.center) - part.radius);
  }
  return clearance;
}

}  // namespace navigation
}  // namespace cartographer_ext
