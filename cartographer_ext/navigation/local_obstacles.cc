// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/local_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/distance_transform.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kWiderReach = 1.;     // metres
constexpr double kWiderStride = 0.05;  // metres
constexpr int kWiderDirections = 24;
constexpr double kMuchRoom = 0.8;   // metres of clearance: more is no better
constexpr double kWiderGain = 0.1;  // metres of clearance, at least
constexpr double kNearer = 0.002;   // metres: less is rounding
constexpr double kPricePerMetre = 0.1;  // metres of clearance

}  // namespace

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

absl::optional<WiderPlace> LocalObstacles::FindWiderPlace(
    const Footprint& footprint, const double margin, const Pose2& pose) const {
  const double now = Clearance(footprint, pose);
  absl::optional<WiderPlace> best;
  double best_score = std::min(now, kMuchRoom) + kWiderGain;
  for (int i = 0; i != kWiderDirections; ++i) {
    const double angle = 2. * kPi * i / kWiderDirections;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double before = now;
    for (double length = kWiderStride; length <= kWiderReach + 1e-6;
         length += kWiderStride) {
      const Eigen::Vector2d place = pose.translation() + length * direction;
      const double clearance =
          Clearance(footprint, Pose2(place.x(), place.y(), angle));
      if (clearance < std::min(margin, before - kNearer)) break;
      before = clearance;
      const double score =
          std::min(clearance, kMuchRoom) - kPricePerMetre * length;
      if (score > best_score) {
        best_score = score;
        best = WiderPlace{place, clearance};
      }
    }
  }
  return best;
}

}  // namespace navigation
}  // namespace cartographer_ext
