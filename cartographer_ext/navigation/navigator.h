// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Drives a robot to goals on a finished map:
//
//   scan, pose ─► ObstacleLayer, MovingObstacles, LocalizationMonitor
//   PathPlanner (A*) ─► path ─► DynamicWindow ─► LimitSpeed ─► command
//
// once a second a new path, ten times a second a new command. It stops where it
// is lost or its laser sees nothing, and reports why. Where it makes no
// progress it recovers: it turns once round and looks, forgets obstacles that
// it has not seen since, backs up along its path, waits, and at last gives the
// goal up. Where it and somebody who walks there wait for each other it goes to
// a passing place, a wider place near by, and lets them pass. While it is
// touched it does not move. Plain types only, deterministic.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_NAVIGATOR_H_
#define CARTOGRAPHER_EXT_NAVIGATION_NAVIGATOR_H_

#include <deque>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/navigation/costmap.h"
#include "cartographer_ext/navigation/dynamic_window.h"
#include "cartographer_ext/navigation/local_obstacles.h"
#include "cartographer_ext/navigation/localization_monitor.h"
#include "cartographer_ext/navigation/moving_obstacles.h"
#include "cartographer_ext/navigation/obstacle_layer.h"
#include "cartographer_ext/navigation/path_planner.h"
#include "cartographer_ext/navigation/path_tracker.h"
#include "cartographer_ext/navigation/robot.h"

namespace cartographer_ext {
namespace navigation {

struct NavigatorOptions {
  RobotLimits robot;
  ObstacleLayerOptions obstacles;
  MovingObstacleOptions moving;
  DynamicWindowOptions window;
  LocalizationMonitorOptions localization;
  double plan_period = 1.;  // seconds
  // Metres, by the pose reported: within the first a goal is reached; the robot
  // drives on until the second as long as the goal is ahead of it.
  double goal_tolerance = 0.05;
  double goal_aim = 0.015;
  double approach_distance = 0.25;  // metres: straight to the goal from here
  double window_half_width = 2.5;   // metres, of the local obstacles
  double stop_margin = 0.02;        // metres, kept by LimitSpeed
  double max_scan_age = 0.5;        // seconds
  int min_echoes = 10;              // fewer: the laser sees nothing
  double stuck_seconds = 8.;        // of trying without progress: recover
  double give_up_seconds = 90.;     // without progress: next goal
};

enum class DriveState {
  kDriving,
  kTurning,     // on the spot, towards the path
  kObstructed,  // waiting for a path to become free
  kRecovering,
  kLost,      // stopped: the pose cannot be believed
  kBlind,     // stopped: no scan, or one that shows nothing
  kFinished,  // no goal is left
};

const char* ToString(DriveState state);

struct GoalResult {
  Eigen::Vector2d goal = Eigen::Vector2d::Zero();
  bool reached = false;
  std::string reason;  // why not
  double time = 0.;    // when it was reached or given up
};

// One scan, with the pose of the robot at its stamp as localisation reports it.
struct NavigatorScan {
  double time = 0.;
  Pose2 map_from_robot;
  // Motion since the last scan, as odometry measured it.
  Pose2 odometry_step;
  // In the robot frame at the stamp.
  Eigen::Vector2d laser = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> echoes;
  std::vector<Eigen::Vector2d> free_ends;  // beams without an echo
};

struct NavigatorStep {
  double time = 0.;
  Pose2 map_from_robot;     // now
  Velocity velocity;        // measured
  Pose2 motion_since_scan;  // (robot at the scan <- robot now)
};

class Navigator {
 public:
  // The costmap must outlive the navigator.
  Navigator(const Costmap* costmap, const NavigatorOptions& options,
            const std::vector<Eigen::Vector2d>& goals);

  void AddScan(const NavigatorScan& scan);
  // The command for the next control period; never one from which the robot
  // could not stop before the nearest echo of the last scan.
  Velocity Step(const NavigatorStep& step);

  DriveState state() const { return state_; }
  // What the robot does and why; a message for the user.
  const std::string& message() const { return message_; }
  bool finished() const { return goal_ == goals_.size(); }
  size_t goal() const { return goal_; }
  const std::vector<GoalResult>& results() const { return results_; }
  const Plan& plan() const { return plan_; }
  int plans() const { return plans_; }
  int recoveries() const { return recoveries_; }
  // How often it went to a wider place so as to let somebody pass.
  int times_given_way() const { return times_given_way_; }

 private:
  enum class Recovery { kTurn, kForget, kBackUp, kWait };

  Velocity Stop(DriveState state, const std::string& message);
  // Whether scan and pose allow to drive at all; else stops.
  bool SensesAreGood(const NavigatorStep& step);
  // Plans when it is time to. False where there is nothing to follow.
  bool FollowsPlan(const NavigatorStep& step);
  // Whether the path followed so far is still free and hardly worse than a new
  // one: a robot that changes its path with every scan oscillates.
  bool KeepsPath(const Plan& plan, const Eigen::Vector2d& place) const;
  // Whether the robot was a little behind its present position a moment ago: a
  // laser that looks forward only does not see where it backs up to.
  bool CameFromBehind(const Pose2& pose) const;
  void FinishGoal(bool reached, const std::string& reason, double time);
  // Starts or ends a recovery where there was no progress.
  void WatchProgress(const NavigatorStep& step);
  Velocity Recover(const NavigatorStep& step);
  // How many echoes that no wall explains are nearer than `distance` (metres)
  // to the outline.
  int CountUnexplainedEchoes(const NavigatorStep& step, double distance) const;
  // Whether something that is not a wall touches the robot, which then stops.
  bool IsTouched(const NavigatorStep& step);
  // Whether the robot is on its way to a passing place or waits there. Looks
  // for one where somebody has blocked it for some time.
  bool IsGivingWay(const NavigatorStep& step);
  // The command that leads to the passing place.
  Velocity GiveWay(const NavigatorStep& step);
  // Map, obstacle layer and the latest echoes around the robot.
  LocalObstacles ObstaclesAround(const NavigatorStep& step) const;
  Velocity Follow(const NavigatorStep& step);
  Velocity Approach(const NavigatorStep& step, const DynamicWindowInput& input);
  // Whether the robot is as near to its goal as it gets without turning.
  bool IsAtGoal(const NavigatorStep& step) const;
  // The command if it is admissible; else stops and says whether it waits for
  // somebody.
  Velocity Admit(const DynamicWindowInput& input, const Velocity& command);
  // Sets the message, and whether it brakes for a moving obstacle only.
  void ExplainBraking(const DynamicWindowInput& input);
  // For driving at `target` (map frame), without a path.
  DynamicWindowInput WindowInput(const NavigatorStep& step,
                                 const Eigen::Vector2d& target,
                                 const LocalObstacles* obstacles) const;
  // For following the path to the goal.
  DynamicWindowInput PathInput(const NavigatorStep& step,
                               const LocalObstacles* obstacles) const;
  // Nearest to the wish that acceleration allows.
  Velocity Reach(const Velocity& current, const Velocity& wish) const;

  const Costmap* const costmap_;
  const NavigatorOptions options_;
  const std::vector<Eigen::Vector2d> goals_;
  ObstacleLayer layer_;
  MovingObstacles moving_;
  LocalizationMonitor monitor_;
  PathPlanner planner_;
  DynamicWindow window_;
  NavigatorScan scan_;
  bool has_scan_ = false;
  std::vector<Eigen::Vector2d> echoes_now_;  // robot frame, now

  size_t goal_ = 0;
  std::vector<GoalResult> results_;
  Plan plan_;
  PathTracker tracker_;
  double planned_ = -1e9;  // when
  // When a path became so much longer that the obstacle is to be remembered.
  double detour_seen_ = -1e9;
  bool turning_ = false;
  std::deque<Eigen::Vector2d> trail_;  // the last metre, newest last

  DriveState state_ = DriveState::kDriving;
  std::string message_;
  int plans_ = 0;
  int recoveries_ = 0;
  int times_given_way_ = 0;
  // Progress: where and when the robot last came nearer to the goal.
  Eigen::Vector2d progress_place_ = Eigen::Vector2d::Zero();
  double progress_time_ = 0.;
  double trying_since_ = 0.;  // neither recovering nor waiting for somebody
  bool waits_for_somebody_ = false;
  bool has_progress_ = false;
  double recovery_begin_ = 0., recovery_end_ = 0.;
  double looked_ = 0.;  // when the last look around began
  Recovery recovery_ = Recovery::kForget;
  int recovery_count_ = 0;  // since the last progress
  // Where the robot lets others pass.
  struct PassingPlace {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();  // map frame
    bool backwards = false;                              // how it drives there
    bool arrived = false;
    double end = 0.;  // when it goes on to its goal
  };
  absl::optional<PassingPlace> passing_place_;
  int passing_places_ = 0;  // since the last progress
  // Seconds in which it did not move although it should, since the last
  // progress.
  double blocked_seconds_ = 0.;
  double stepped_ = 0.;          // time of the last step
  double somebody_near_ = -1e9;  // when somebody last moved near the robot
  double touched_since_ = 0.;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_NAVIGATOR_H_
