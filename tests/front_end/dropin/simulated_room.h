// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A laser in a world of straight walls, for tests of local SLAM.
#ifndef TESTS_FRONT_END_DROPIN_SIMULATED_ROOM_H_
#define TESTS_FRONT_END_DROPIN_SIMULATED_ROOM_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "Eigen/Core"
#include "cartographer/common/time.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace front_end {
namespace test {

struct Wall {
  Eigen::Vector2d a, b;
};

// 8 m x 6 m with a cupboard and a bay.
inline std::vector<Wall> Room() {
  const std::vector<Eigen::Vector2d> outline = {
      {-4., -3.}, {4., -3.}, {4., 1.}, {3., 1.}, {3., 3.}, {-4., 3.}};
  std::vector<Wall> walls;
  for (size_t i = 0; i < outline.size(); ++i) {
    walls.push_back({outline[i], outline[(i + 1) % outline.size()]});
  }
  walls.push_back({{-4., 0.5}, {-3.2, 0.5}});
  walls.push_back({{-3.2, 0.5}, {-3.2, 1.6}});
  walls.push_back({{-3.2, 1.6}, {-4., 1.6}});
  return walls;
}

// Two walls 2.4 m apart that go on for ever, as far as the laser sees.
inline std::vector<Wall> Corridor() {
  return {{{-500., -1.2}, {500., -1.2}}, {{-500., 1.2}, {500., 1.2}}};
}

// Metres to the first wall, infinity if there is none.
inline double Cast(const std::vector<Wall>& walls, const Eigen::Vector2d& from,
                   const double angle) {
  const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) {
    const Eigen::Vector2d along = wall.b - wall.a;
    const double det = ray.x() * -along.y() + ray.y() * along.x();
    if (std::abs(det) < 1e-12) continue;
    const Eigen::Vector2d to = wall.a - from;
    const double t = (to.x() * -along.y() + to.y() * along.x()) / det;
    const double u = (ray.x() * to.y() - ray.y() * to.x()) / det;
    if (t > 0. && u >= 0. && u <= 1.) nearest = std::min(nearest, t);
  }
  return nearest;
}

inline cartographer::common::Time At(const double seconds) {
  return cartographer::common::FromUniversal(
      637000000000000000LL + static_cast<int64_t>(std::llround(seconds * 1e7)));
}

// 360 beams all round with 1 cm of noise, from the robot's origin.
inline cartographer::sensor::TimedPointCloudData Scan(
    const std::vector<Wall>& walls, const double seconds, const Pose2& pose,
    const double max_range, Random* const random) {
  cartographer::sensor::TimedPointCloudData data;
  data.time = At(seconds);
  data.origin = Eigen::Vector3f::Zero();
  for (int i = 0; i < 360; ++i) {
    const double angle = DegToRad(i);
    double range = Cast(walls, pose.translation(), pose.theta + angle);
    if (range > max_range) continue;
    range += random->Normal(0., 0.01);
    cartographer::sensor::TimedRangefinderPoint point;
    point.position =
        Eigen::Vector3f(static_cast<float>(range * std::cos(angle)),
                        static_cast<float>(range * std::sin(angle)), 0.f);
    point.time = 0.f;
    data.ranges.push_back(point);
  }
  return data;
}

inline cartographer::sensor::OdometryData Odometry(const double seconds,
                                                   const Pose2& pose) {
  return {At(seconds), cartographer::transform::Rigid3d(
                           Eigen::Vector3d(pose.x, pose.y, 0.),
                           Eigen::Quaterniond(Eigen::AngleAxisd(
                               pose.theta, Eigen::Vector3d::UnitZ())))};
}

}  // namespace test
}  // namespace front_end
}  // namespace cartographer_ext

#endif  // TESTS_FRONT_END_DROPIN_SIMULATED_ROOM_H_
