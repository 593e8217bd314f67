// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How far along a path the robot is, and what lies ahead of it.
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
  // Moves on to the point of the path nearest to the robot, at most a little
  // back and a few metres ahead of the last one.
  void Advance(const Eigen::Vector2d& position);
  // Metres from the robot's place on the path to its end.
  double Remaining() const;
  // Point so many metres ahead, the end at most.
  Eigen::Vector2d Ahead(double distance) const;
  // Points about a decimetre apart, from the robot's place on.
  std::vector<Eigen::Vector2d> PointsAhead(double distance) const;

 private:
  std::vector<Eigen::Vector2d> points_;  // evenly spaced between corners
  std::vector<double> lengths_;          // from the start, metres
  size_t nearest_ = 0;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_PATH_TRACKER_H_
