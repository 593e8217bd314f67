// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides whether the pose reported by localisation can be trusted, by the
// share of the echoes that are at walls of the map when seen from that pose.
// The robot is lost, or found again, only after this has lasted for some time.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_LOCALIZATION_MONITOR_H_
#define CARTOGRAPHER_EXT_NAVIGATION_LOCALIZATION_MONITOR_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/navigation/costmap.h"

namespace cartographer_ext {
namespace navigation {

// Share of the echoes (robot frame) that lie within `tolerance` metres of a
// wall; 0 without any.
double ShareAtWalls(const Costmap& costmap,
                    const std::vector<Eigen::Vector2d>& echoes,
                    const Pose2& map_from_robot, double tolerance);

// The pose near `guess` (within 0.6 m and 12 degrees) at which the echoes lie
// nearest to walls, for an operator's rough guess.
Pose2 RefinePose(const Costmap& costmap,
                 const std::vector<Eigen::Vector2d>& echoes,
                 const Pose2& guess);

struct LocalizationMonitorOptions {
  double wall_tolerance = 0.25;  // metres
  double lost_share = 0.4;       // below it: lost
  double found_share = 0.55;     // above it: found again
  double seconds = 1.;           // duration of either
  double jump_distance = 0.5;    // metres between two poses, beyond odometry
  double max_pose_age = 0.5;     // seconds
};

class LocalizationMonitor {
 public:
  explicit LocalizationMonitor(const LocalizationMonitorOptions& options)
      : options_(options) {}

  // After each scan, with the pose at its stamp and the motion that odometry
  // measured since the last one.
  void AddScan(const Costmap& costmap,
               const std::vector<Eigen::Vector2d>& echoes,
               const Pose2& map_from_robot, const Pose2& odometry_step,
               double time);
  // The robot is also lost without a recent pose.
  bool IsLost(double now) const;
  // Why, for the user; empty unless lost.
  std::string Reason(double now) const;
  double share_at_walls() const { return share_; }

 private:
  const LocalizationMonitorOptions options_;
  bool any_ = false;
  bool lost_ = false;
  bool jumped_ = false;
  double share_ = 0.;
  double changing_since_ = 0.;  // since when the share contradicts the state
  bool changing_ = false;
  double last_time_ = 0.;
  Pose2 last_pose_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_LOCALIZATION_MONITOR_H_
