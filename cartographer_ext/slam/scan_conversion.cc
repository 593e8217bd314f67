// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/scan_conversion.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/map/host_types.h"

namespace cartographer_ext {
namespace evaluation {

cartographer::sensor::TimedPointCloudData ToTimedPointCloudData(
    const io::LaserScan& scan, const double min_range, const double max_range) {
  const double nearest = std::max(min_range, scan.range_min);
  const double furthest = std::min(max_range, scan.range_max);
  cartographer::sensor::TimedPointCloudData data;
  data.time = ToHostTime(scan.time);
  data.origin = Eigen::Vector3f(static_cast<float>(scan.laser_pose.x),
                                static_cast<float>(scan.laser_pose.y), 0.f);
  data.ranges.reserve(scan.ranges.size());
  const auto add = [&](const Eigen::Vector2d& in_laser, const float time) {
    const Eigen::Vector2d point = scan.laser_pose * in_laser;
    cartographer::sensor::TimedRangefinderPoint timed_point;
    timed_point.position = Eigen::Vector3f(static_cast<float>(point.x()),
                                           static_cast<float>(point.y()), 0.f);
    timed_point.time = time;
    data.ranges.push_back(timed_point);
  };
  const double last = static_cast<double>(scan.ranges.size()) - 1.;
  for (size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    // The comparison is written so that NaN fails it.
    if (!(range >= nearest && range <= furthest) || std::isinf(range)) continue;
    const double angle =
        scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    add(Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle)),
        static_cast<float>(std::min(
            0., (static_cast<double>(i) - last) * scan.time_increment)));
  }
  for (size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector2d& in_laser = scan.points[i];
    const double range = in_laser.norm();
    if (!(range >= nearest && range <= furthest)) continue;
    add(in_laser, scan.point_times.empty() ? 0.f : scan.point_times[i]);
  }
  return data;
}

}  // namespace evaluation
}  // namespace cartographer_ext
