// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The field of view of a scan, from the bearings of its beams with and without
// an echo; no description of the laser is needed.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_FIELD_OF_VIEW_H_
#define CARTOGRAPHER_EXT_NAVIGATION_FIELD_OF_VIEW_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace navigation {

class FieldOfView {
 public:
  // Ends of beams with and without an echo in the robot frame; those that are
  // not finite are ignored.
  FieldOfView(const Eigen::Vector2d& laser,
              const std::vector<Eigen::Vector2d>& echoes,
              const std::vector<Eigen::Vector2d>& free_ends)
      : laser_(laser) {
    for (const auto* const ends : {&echoes, &free_ends}) {
      for (const Eigen::Vector2d& end : *ends) {
        if (end.allFinite()) bearings_.push_back(Bearing(end));
      }
    }
    std::sort(bearings_.begin(), bearings_.end());
  }

  // Whether a beam points at a point (robot frame), occluded or not.
  bool Contains(const Eigen::Vector2d& point) const {
    // Wide enough to bridge one missing beam.
    constexpr double kGap = 0.05;  // radians
    const double bearing = Bearing(point);
    const auto next =
        std::lower_bound(bearings_.begin(), bearings_.end(), bearing - kGap);
    return next != bearings_.end() && *next <= bearing + kGap;
  }

 private:
  double Bearing(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d beam = point - laser_;
    return std::atan2(beam.y(), beam.x());
  }

  const Eigen::Vector2d laser_;
  std::vector<double> bearings_;  // sorted
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_FIELD_OF_VIEW_H_
