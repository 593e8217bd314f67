// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The progress of the robot along a path, and the path ahead of it.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_PATH_TRACKER_H_
#define CARTOGRAPHER_EXT_NAVIGATION_PATH_TRACKER_H_

#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace navigation {

class PathTracker {
 public:
  PathTracker() = default;
  // Corners of the path in metres; at least one.
  explicit PathTracker(const std::vector<Eigen::Vector2d>& corners);

  bool empty() const { return points_.empty(); }
  // Advances to the point of the path nearest to the robot, from half a metre
  // before to a few metres after the last one.
  void Advance(const Eigen::Vector2d& position);
  // Metres from the robot's point on the path to its end.
  double Remaining() const;
  // The point this many metres ahead, or the end.
  Eigen::Vector2d Ahead(double distance) const;
  // Points about a decimetre apart, starting at the robot's.
  std::vector<Eigen::Vector2d> PointsAhead(double distance) const;

 private:
  std::vector<Eigen::Vector2d> points_;  // evenly spaced between corners
  std::vector<double> lengths_;          // from the start, metres
  size_t nearest_ = 0;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_PATH_TRACKER_H_
