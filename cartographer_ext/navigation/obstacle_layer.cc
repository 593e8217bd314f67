// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/obstacle_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/navigation/grid_ray.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr float kNoMark = std::numeric_limits<float>::quiet_NaN();

}  // namespace

ObstacleLayer::ObstacleLayer(const Costmap* const costmap,
                             const ObstacleLayerOptions& options)
    : costmap_(costmap),
      options_(options),
      times_(costmap->geometry().size(), kNoMark),
      first_times_(costmap->geometry().size(), kNoMark),
      past_times_(costmap->geometry().size(), kNoMark),
      kept_until_(costmap->geometry().size(), 0.f) {
  CHECK_GT(options.range, 0.);
  CHECK_GT(options.max_marks, 0);
  const double resolution = costmap->geometry().resolution();
  const int reach = static_cast<int>(
      std::ceil(costmap->options().inflation_radius / resolution));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const uint8_t weight = costmap->WeightAt(resolution * std::hypot(dx, dy));
      if (weight != kMinWeight) stamp_.push_back({dx, dy, weight});
    }
  }
}

bool ObstacleLayer::IsMarked(const Cell& cell) const {
  const GridGeometry& geometry = costmap_->geometry();
  return geometry.Contains(cell) && !std::isnan(times_[geometry.Index(cell)]);
}

bool ObstacleLayer::IsSettled(const Cell& cell) const {
  if (!IsMarked(cell)) return false;
  const size_t index = costmap_->geometry().Index(cell);
  return times_[index] - first_times_[index] >= options_.settle_seconds;
}

double ObstacleLayer::MarkAge(const Eigen::Vector2d& point,
                              const double now) const {
  const GridGeometry& geometry = costmap_->geometry();
  const Cell middle = geometry.CellAt(point);
  double age = 0.;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell cell{middle.x + dx, middle.y + dy};
      if (!IsMarked(cell)) continue;
      age = std::max(age, now - first_times_[geometry.Index(cell)]);
    }
  }
  return age;
}

bool ObstacleLayer::IsWall(const Eigen::Vector2d& echo) const {
  return costmap_->WallDistance(echo) <= options_.wall_tolerance;
}

void ObstacleLayer::ClearBeam(const Eigen::Vector2d& laser,
                              const Eigen::Vector2d& end, const bool keep_end) {
  const GridGeometry& geometry = costmap_->geometry();
  const Eigen::Vector2d ray = end - laser;
  const double length = ray.norm();
  if (length == 0.) return;
  const double shown = std::min(length, options_.range);
  const Cell end_cell = geometry.CellAt(end);
  VisitLine(geometry.ToGrid(laser),
            geometry.ToGrid(laser + ray * (shown / length)),
            [&](const Cell& cell, double /*length*/) {
              if (!geometry.Contains(cell)) return true;
              if (keep_end && cell == end_cell) return true;
              const size_t index = geometry.Index(cell);
              if (std::isnan(times_[index])) return true;
              past_times_[index] = times_[index];
              times_[index] = kNoMark;
              kept_until_[index] = 0.f;
              return true;
            });
}

void ObstacleLayer::Update(const ScanInMap& scan) {
  if (!scan.laser.allFinite()) return;
  const GridGeometry& geometry = costmap_->geometry();
  if (!marks_.empty()) {
    for (const Eigen::Vector2d& end : scan.free_ends) {
      if (end.allFinite()) ClearBeam(scan.laser, end, false);
    }
    for (const Eigen::Vector2d& echo : scan.echoes) {
      if (echo.allFinite()) ClearBeam(scan.laser, echo, true);
    }
  }
  // Cleared cells are removed from the list before they can be marked again.
  Compact(scan.time);
  for (const Eigen::Vector2d& echo : scan.echoes) {
    if (!echo.allFinite() || (echo - scan.laser).norm() > options_.range) {
      continue;
    }
    const Cell cell = geometry.CellAt(echo);
    if (!geometry.Contains(cell) || IsWall(echo)) continue;
    float& time = times_[geometry.Index(cell)];
    if (std::isnan(time)) {
      const size_t index = geometry.Index(cell);
      marks_.push_back(cell);
      if (!(scan.time - past_times_[index] <= options_.renewal_seconds)) {
        first_times_[index] = static_cast<float>(scan.time);
      }
    }
    time = static_cast<float>(scan.time);
  }
  Compact(scan.time);
}

void ObstacleLayer::Clear(const Eigen::Vector2d& center, const double radius,
                          const double since) {
  const GridGeometry& geometry = costmap_->geometry();
  for (const Cell& cell : marks_) {
    if ((geometry.Center(cell) - center).norm() <= radius &&
        times_[geometry.Index(cell)] < since) {
      times_[geometry.Index(cell)] = kNoMark;
      kept_until_[geometry.Index(cell)] = 0.f;
    }
  }
  Compact(-std::numeric_limits<double>::infinity());
}

void ObstacleLayer::Keep(const Eigen::Vector2d& center, const double radius,
                         const double until) {
  const GridGeometry& geometry = costmap_->geometry();
  for (const Cell& cell : marks_) {
    if (IsSettled(cell) && (geometry.Center(cell) - center).norm() <= radius) {
      kept_until_[geometry.Index(cell)] = static_cast<float>(until);
    }
  }
}

void ObstacleLayer::LetGo() {
  for (const Cell& cell : marks_) {
    kept_until_[costmap_->geometry().Index(cell)] = 0.f;
  }
}

void ObstacleLayer::Compact(const double now) {
  const GridGeometry& geometry = costmap_->geometry();
  const double oldest = now - options_.memory_seconds;
  const double oldest_unsettled =
      now -
      std::min(options_.memory_seconds, options_.unsettled_memory_seconds);
  const auto forget = [&](const Cell& cell) {
    float& time = times_[geometry.Index(cell)];
    if (std::isnan(time)) return true;
    if (time >= (IsSettled(cell) ? oldest : oldest_unsettled) ||
        kept_until_[geometry.Index(cell)] > now) {
      return false;
    }
    time = kNoMark;
    return true;
  };
  marks_.erase(std::remove_if(marks_.begin(), marks_.end(), forget),
               marks_.end());
  const int64_t surplus =
      static_cast<int64_t>(marks_.size()) - options_.max_marks;
  if (surplus <= 0) return;
  for (int64_t i = 0; i != surplus; ++i) {
    times_[geometry.Index(marks_[i])] = kNoMark;
  }
  marks_.erase(marks_.begin(), marks_.begin() + surplus);
}

void ObstacleLayer::ApplyTo(WeightGrid* const weights) const {
  const GridGeometry& geometry = costmap_->geometry();
  *weights = costmap_->weights();
  for (const Cell& mark : marks_) {
    if (!IsSettled(mark)) continue;
    for (const StampedWeight& stamped : stamp_) {
      const Cell cell{mark.x + stamped.dx, mark.y + stamped.dy};
      if (!geometry.Contains(cell)) continue;
      uint8_t& weight = weights->weights[geometry.Index(cell)];
      weight = stamped.weight == kBlocked || weight == kBlocked
                   ? kBlocked
                   : std::max(weight, stamped.weight);
    }
  }
}

}  // namespace navigation
}  // namespace cartographer_ext
