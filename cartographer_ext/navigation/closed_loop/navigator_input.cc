// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/navigator_input.h"

#include <cmath>

namespace cartographer_ext {
namespace navigation {

namespace {

constexpr double kFreeDistance = 2.;  // metres along a beam without an echo

}  // namespace

NavigatorScan ToNavigatorScan(const io::LaserScan& scan) {
  NavigatorScan result;
  result.laser = scan.laser_pose.translation();
  for (size_t i = 0; i != scan.ranges.size(); ++i) {
    const double angle = scan.angle_min + i * scan.angle_increment;
    const bool echo =
        scan.ranges[i] >= scan.range_min && scan.ranges[i] <= scan.range_max;
    const double range = echo ? scan.ranges[i] : scan.range_max;
    const Eigen::Vector2d point =
        scan.laser_pose *
        Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
    // A surface that is black or made of glass gives no echo either: only the
    // near part of such a beam is taken as free.
    if (echo) {
      result.echoes.push_back(point);
    } else {
      result.free_ends.push_back(result.laser + (point - result.laser) *
                                                    (kFreeDistance / range));
    }
  }
  return result;
}

}  // namespace navigation
}  // namespace cartographer_ext
