// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/family_paths.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace experiments {

void Drive(const double length, const double curvature, const double step,
           const int floor, const int robot, Path* const path) {
  const int steps = std::max(1, static_cast<int>(std::lround(length / step)));
  const double distance = length / steps, turn = distance * curvature;
  for (int i = 0; i != steps; ++i) {
    const Pose2 chord(distance * std::cos(0.5 * turn),
                      distance * std::sin(0.5 * turn), turn);
    path->Add(path->poses.back() * chord, floor, robot);
  }
}

Path Rings(const int rings, const double radius, const double step,
           const double laps, Random* const random) {
  Path path;
  path.Add(Pose2(0., 0., kPi / 2.), 0, 0);
  const double half = kPi * radius;
  const int halves = std::lround(2 * rings * laps);
  for (int k = 0; k != halves; ++k) {
    const int leg = k % (2 * rings);
    const int ring = leg < rings ? leg : 2 * rings - 1 - leg;
    const double sign = ring % 2 == 0 ? -1. : 1.;
    Drive(half, sign / radius, step, 0, 0, &path);
  }
  // End somewhere on the path.
  Drive(random->Uniform(0.2, 0.9) * half, -1. / radius, step, 0, 0, &path);
  return path;
}

constexpr int StreetWalker::kDx[4];
constexpr int StreetWalker::kDy[4];

Path Star(const int arms, const double length, const double step,
          Random* const random) {
  Path path;
  path.Add(Pose2(), 0, 0);
  for (int k = 0; k != arms; ++k) {
    const double arm = length * random->Uniform(0.6, 1.4);
    const double curvature = random->Normal(0., 0.5 / length);
    Drive(arm, curvature, step, 0, 0, &path);
    path.Add(path.poses.back() * Pose2(0., 0., kPi), 0, 0);
    Drive(arm, -curvature, step, 0, 0, &path);
    const double turn = 2. * kPi / arms + random->Normal(0., 0.1);
    path.Add(path.poses.back() * Pose2(0., 0., NormalizeAngle(turn - kPi)), 0,
             0);
  }
  return path;
}

}  // namespace experiments
}  // namespace cartographer_ext
