// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/localization_monitor.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// Mean distance to walls, each at most `cap`.
double MeanWallDistance(const Costmap& costmap,
                        const std::vector<Eigen::Vector2d>& echoes,
                        const Pose2& pose, const double cap) {
  double sum = 0.;
  for (const Eigen::Vector2d& echo : echoes) {
    sum += std::min(cap, costmap.WallDistance(pose * echo));
  }
  return sum / std::max<size_t>(1, echoes.size());
}

bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) &&
         std::isfinite(pose.theta);
}

}  // namespace

double ShareAtWalls(const Costmap& costmap,
                    const std::vector<Eigen::Vector2d>& echoes,
                    const Pose2& map_from_robot, const double tolerance) {
  if (!IsFinite(map_from_robot)) return 0.;
  int count = 0, at_walls = 0;
  for (const Eigen::Vector2d& echo : echoes) {
    if (!echo.allFinite()) continue;
    ++count;
    at_walls += costmap.WallDistance(map_from_robot * echo) <= tolerance;
  }
  return count == 0 ? 0. : static_cast<double>(at_walls) / count;
}

Pose2 RefinePose(const Costmap& costmap,
                 const std::vector<Eigen::Vector2d>& echoes,
                 const Pose2& guess) {
  std::vector<Eigen::Vector2d> finite;
  for (const Eigen::Vector2d& echo : echoes) {
    if (echo.allFinite()) finite.push_back(echo);
  }
  if (finite.empty() || !IsFinite(guess)) return guess;
  // From coarse to fine steps. A larger cap gives the coarse levels a larger
  // basin of convergence.
  struct Level {
    double reach, step, turn_reach, turn_step, cap;
  };
  const Level levels[] = {{0.6, 0.1, DegToRad(12.), DegToRad(2.), 0.4},
                          {0.1, 0.025, DegToRad(2.), DegToRad(0.5), 0.2},
                          {0.025, 0.0125, DegToRad(0.5), DegToRad(0.25), 0.15}};
  Pose2 best = guess;
  for (const Level& level : levels) {
    const Pose2 middle = best;
    double least = MeanWallDistance(costmap, finite, middle, level.cap);
    const int reach = static_cast<int>(std::lround(level.reach / level.step));
    const int turns =
        static_cast<int>(std::lround(level.turn_reach / level.turn_step));
    for (int t = -turns; t <= turns; ++t) {
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          const Pose2 pose(middle.x + x * level.step, middle.y + y * level.step,
                           NormalizeAngle(middle.theta + t * level.turn_step));
          const double distance =
              MeanWallDistance(costmap, finite, pose, level.cap);
          if (distance < least) {
            least = distance;
            best = pose;
          }
        }
      }
    }
  }
  return best;
}

void LocalizationMonitor::AddScan(const Costmap& costmap,
                                  const std::vector<Eigen::Vector2d>& echoes,
                                  const Pose2& map_from_robot,
                                  const Pose2& odometry_step,
                                  const double time) {
  share_ =
      ShareAtWalls(costmap, echoes, map_from_robot, options_.wall_tolerance);
  const bool finite = IsFinite(map_from_robot);
  if (any_ && finite) {
    const Pose2 step = Between(last_pose_, map_from_robot);
    if ((step.translation() - odometry_step.translation()).norm() >
        options_.jump_distance) {
      lost_ = jumped_ = true;
      changing_ = false;
    }
  }
  const bool says_otherwise = lost_ ? share_ > options_.found_share && finite
                                    : share_ < options_.lost_share || !finite;
  if (!says_otherwise) {
    changing_ = false;
  } else if (!changing_) {
    changing_ = true;
    changing_since_ = time;
  } else if (time - changing_since_ >= options_.seconds) {
    lost_ = !lost_;
    changing_ = jumped_ = false;
  }
  any_ = true;
  last_time_ = time;
  if (finite) last_pose_ = map_from_robot;
}

bool LocalizationMonitor::IsLost(const double now) const {
  return lost_ || !any_ || now - last_time_ > options_.max_pose_age;
}

std::string LocalizationMonitor::Reason(const double now) const {
  if (!any_) return "localisation has not given any pose";
  if (now - last_time_ > options_.max_pose_age) {
    return absl::StrFormat("localisation has been silent for %.1f s",
                           now - last_time_);
  }
  if (!lost_) return "";
  if (jumped_) return "the pose jumped";
  return absl::StrFormat("only %.0f %% of the echoes lie at walls of the map",
                         100. * share_);
}

}  // namespace navigation
}  // namespace cartographer_ext
