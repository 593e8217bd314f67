// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/truth_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kMaxCells = 64e6;
constexpr double kViewDistance = 0.25;  // metres driven between two views
constexpr double kViewTime = 0.1;       // seconds between poses looked at
// Minimum number of beams per view, so that distant walls are closed.
constexpr int kBeams = 720;
constexpr float kOccupied = 1.f;
constexpr float kFree = 0.f;

class Painter {
 public:
  Painter(const Simulation& simulation, io::OccupancyMap* map)
      : simulation_(simulation), map_(map) {}

  void View(const Pose2& laser) {
    const LaserSettings& settings = simulation_.world().laser;
    const double span = settings.angle_increment * settings.beams;
    const int beams = std::max(settings.beams, kBeams);
    for (int i = 0; i != beams; ++i) {
      const double angle = laser.theta + settings.angle_min + span * i / beams;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const RayHit hit = simulation_.plan().Cast(laser.translation(), direction,
                                                 settings.max_range);
      const double reach = settings.max_range * std::sqrt(hit.reflectivity);
      // Rays end a little before the wall, so that a grazing beam does not mark
      // cells of the wall as free.
      if (hit.range > reach || hit.range < settings.min_range) continue;
      Free(laser.translation(), direction, hit.range - map_->resolution);
      Occupied(laser.translation() + hit.range * direction);
    }
  }

 private:
  float* Cell(const Eigen::Vector2d& point) {
    const int x = static_cast<int>(
        std::floor((point.x() - map_->origin.x) / map_->resolution));
    const int y = static_cast<int>(
        std::floor((point.y() - map_->origin.y) / map_->resolution));
    if (x < 0 || y < 0 || x >= map_->width || y >= map_->height) return nullptr;
    return &map_->at(x, y);
  }

  void Occupied(const Eigen::Vector2d& point) {
    float* const cell = Cell(point);
    if (cell != nullptr) *cell = kOccupied;
  }

  void Free(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
            const double length) {
    const double step = 0.5 * map_->resolution;
    for (double along = 0.; along < length; along += step) {
      float* const cell = Cell(origin + along * direction);
      if (cell != nullptr && *cell != kOccupied) *cell = kFree;
    }
  }

  const Simulation& simulation_;
  io::OccupancyMap* const map_;
};

}  // namespace

absl::StatusOr<io::OccupancyMap> MakeTruthMap(const Simulation& simulation,
                                              const double resolution) {
  if (!(resolution >= 1e-3 && resolution <= 10.)) {
    return absl::InvalidArgumentError(
        absl::StrCat("resolution ", resolution, " is outside [0.001, 10] m"));
  }
  const RayCaster& plan = simulation.plan();
  Eigen::Vector2d min = plan.min(), max = plan.max();
  if (!(min.x() <= max.x())) min = max = Eigen::Vector2d::Zero();
  const auto low = [resolution](const double value) {
    return std::floor(value / resolution) - 2.;
  };
  const auto high = [resolution](const double value) {
    return std::ceil(value / resolution) + 2.;
  };
  const double width = high(max.x()) - low(min.x());
  const double height = high(max.y()) - low(min.y());
  if (width * height > kMaxCells) {
    return absl::InvalidArgumentError(
        absl::StrCat("a map of ", width, " by ", height,
                     " cells is too large; choose a coarser resolution"));
  }
  io::OccupancyMap map = io::OccupancyMap::Make(
      static_cast<int>(width), static_cast<int>(height), resolution,
      Pose2(low(min.x()) * resolution, low(min.y()) * resolution, 0.));
  Painter painter(simulation, &map);
  const Drive& drive = simulation.drive();
  double last_distance = -kViewDistance;
  double last_heading = 0.;
  double distance = 0.;
  double signed_distance = 0.;
  for (double time = 0.; time <= drive.duration(); time += kViewTime) {
    const MotionState motion = drive.At(time);
    distance += std::abs(motion.distance - signed_distance);
    signed_distance = motion.distance;
    if (distance - last_distance < kViewDistance &&
        std::abs(motion.heading - last_heading) < 0.2) {
      continue;
    }
    last_distance = distance;
    last_heading = motion.heading;
    painter.View(motion.pose * simulation.world().laser.mounting);
  }
  return map;
}

}  // namespace simulation
}  // namespace cartographer_ext
