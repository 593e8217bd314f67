// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_SWEEP_RETURNS_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_SWEEP_RETURNS_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/sensor/timed_point_cloud_data.h"

namespace cartographer_ext {
namespace front_end {

// The returns of a sweep of a single laser in the plane, as seen from it, in
// their order; x and y as in the tracking frame.
inline std::vector<Eigen::Vector2f> PlanarReturns(
    const cartographer::sensor::TimedPointCloudOriginData& sweep) {
  std::vector<Eigen::Vector2f> returns;
  returns.reserve(sweep.ranges.size());
  for (const auto& range : sweep.ranges) {
    returns.push_back(
        (range.point_time.position - sweep.origins.front()).head<2>());
  }
  return returns;
}

// Of a scan, likewise.
inline std::vector<Eigen::Vector2f> PlanarReturns(
    const cartographer::sensor::TimedPointCloudData& scan) {
  std::vector<Eigen::Vector2f> returns;
  returns.reserve(scan.ranges.size());
  for (const auto& point : scan.ranges) {
    returns.push_back((point.position - scan.origin).head<2>());
  }
  return returns;
}

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_SWEEP_RETURNS_H_
