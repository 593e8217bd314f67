// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/laser_model.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace simulation {

LaserModel::LaserModel(const LaserSettings& settings, const RayCaster* plan,
                       const ObstacleMotion* obstacles, const uint64_t seed)
    : settings_(settings),
      plan_(plan),
      obstacles_(obstacles),
      random_(MakeRandom(seed, RandomStream::kLaser)) {}

double LaserModel::ExactRange(const Pose2& laser, const double angle,
                              const std::vector<Disc>& obstacles) const {
  const Eigen::Vector2d origin = laser.translation();
  const Eigen::Vector2d direction(std::cos(laser.theta + angle),
                                  std::sin(laser.theta + angle));
  RayHit hit = plan_->Cast(origin, direction, settings_.max_range);
  for (const Disc& disc : obstacles) {
    const double range = RayToDisc(origin, direction, disc);
    if (range < hit.range) {
      hit.range = range;
      hit.reflectivity = disc.reflectivity;
    }
  }
  const bool echo =
      hit.range >= settings_.min_range &&
      hit.range <= settings_.max_range * std::sqrt(hit.reflectivity);
  return echo ? hit.range : kNoHit;
}

float LaserModel::Measure(double range) {
  // The number of draws per beam is fixed, so that the result of one beam does
  // not change the noise of the others.
  const double dropout_draw = random_.Uniform();
  const double outlier_draw = random_.Uniform();
  const double place_draw = random_.Uniform();
  const double noise_draw = random_.Normal();
  if (range == kNoHit || dropout_draw < settings_.dropout) {
    return static_cast<float>(settings_.no_return);
  }
  if (outlier_draw < settings_.outlier) {
    range = settings_.min_range + place_draw * (range - settings_.min_range);
  }
  range += noise_draw *
           std::hypot(settings_.noise, settings_.proportional_noise * range);
  if (settings_.resolution > 0.) {
    range = settings_.resolution * std::round(range / settings_.resolution);
  }
  range = std::max(settings_.min_range, std::min(settings_.max_range, range));
  return static_cast<float>(range);
}

io::LaserScan LaserModel::EmptyScan() const {
  io::LaserScan scan;
  scan.angle_min = settings_.angle_min;
  scan.angle_increment = settings_.angle_increment;
  scan.range_min = settings_.min_range;
  scan.range_max = settings_.max_range;
  scan.laser_pose = settings_.mounting;
  scan.ranges.reserve(settings_.beams);
  return scan;
}

io::LaserScan LaserModel::Snapshot(const Pose2& robot,
                                   const std::vector<Disc>& obstacles) {
  io::LaserScan scan = EmptyScan();
  const Pose2 laser = robot * settings_.mounting;
  for (int i = 0; i != settings_.beams; ++i) {
    scan.ranges.push_back(Measure(
        ExactRange(laser, settings_.angle_min + i * settings_.angle_increment,
                   obstacles)));
  }
  return scan;
}

io::LaserScan LaserModel::Scan(const Drive& drive, const double time) {
  io::LaserScan scan = EmptyScan();
  const bool rolling = settings_.sweep > 0. && settings_.beams > 1;
  if (rolling) scan.time_increment = settings_.sweep / (settings_.beams - 1);
  Pose2 laser = drive.PoseAt(time) * settings_.mounting;
  std::vector<Disc> obstacles = obstacles_->At(time);
  for (int i = 0; i != settings_.beams; ++i) {
    if (rolling) {
      const double beam_time =
          time - scan.time_increment * (settings_.beams - 1 - i);
      laser = drive.PoseAt(beam_time) * settings_.mounting;
      obstacles = obstacles_->At(beam_time);
    }
    scan.ranges.push_back(Measure(
        ExactRange(laser, settings_.angle_min + i * settings_.angle_increment,
                   obstacles)));
  }
  return scan;
}

}  // namespace simulation
}  // namespace cartographer_ext
