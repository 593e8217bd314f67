// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Innovation check of odometry: what it says of the way between scans against
// what the scan matcher says.
//
// Two comparisons are made, both by chi2 = |dt|^2 / s_t^2 + dr^2 / s_r^2 with
// standard deviations that grow with the motion,
//   s_t^2 = translation^2 + (per_metre * way)^2,
//   s_r^2 = rotation^2 + (per_radian * turn)^2:
//  * from scan to scan, for what happens at once: odometry that repeats a pose
//    (stale), or moves the robot by more than it moved (jumping);
//  * over a window of about a second, for what goes on: the wrong sign in
//    reverse, and wheels that slip.
// A fault that goes on ends when the window agrees again; a jump or a burst of
// stale poses ends with the interval, and the window starts anew.
//
// Where the scan cannot tell the way, its match is the prediction itself, and
// only turns are compared. There a speed that changes faster than the robot can
// (wheels that lose or find their grip) is all that is left to see; it is
// reported as a suspicion and changes nothing.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_MONITOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_MONITOR_H_

#include <deque>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

enum class OdometryState {
  kOk,
  kAbsent,         // none, or none for this interval
  kStale,          // repeats a pose while the scan moves
  kJumping,        // moved further than the robot
  kWrongSign,      // forwards for backwards
  kSlipping,       // wheels do not do what the floor does
  kSlipSuspected,  // sudden speed where the scan cannot tell the way
};

struct OdometryCheckOptions {
  bool enabled = true;
  double window = 1.;               // seconds
  double gate = 25.;                // chi2, 3 degrees of freedom
  double translation_noise = 0.03;  // metres
  double rotation_noise = 0.03;     // radians
  double translation_noise_per_metre = 0.05;
  double rotation_noise_per_radian = 0.1;
  double jump_distance = 0.3;     // metres
  double jump_angle = 0.3;        // radians
  double max_acceleration = 1.5;  // m/s^2
};

// One interval between two scans. Motions are (earlier robot <- later robot).
struct MotionComparison {
  double time = 0.;      // of the later scan, seconds
  double interval = 0.;  // seconds, > 0
  bool has_odometry = true;
  Pose2 odometry;
  bool frozen = false;  // odometry repeated one pose
  Pose2 match;
  // Whether the scan tells how far the robot went along its way.
  bool translation_observable = true;
  // Change of forward speed by an IMU, m/s; only with has_inertial.
  bool has_inertial = false;
  double inertial_speed_change = 0.;
};

class OdometryMonitor {
 public:
  explicit OdometryMonitor(const OdometryCheckOptions& options);

  // Before the match: whether the motion by odometry is so different from what
  // the velocity makes expect that it should not be relied on.
  bool IsSuspect(double interval, const Pose2& odometry, bool frozen,
                 const Pose2& expected) const;

  // After the match. Returns the state of the interval.
  OdometryState Add(const MotionComparison& given);

  OdometryState state() const { return state_; }
  // Whether a prediction should rest on odometry. A jump is over when it is
  // seen.
  bool IsTrusted() const {
    return state_ == OdometryState::kOk || state_ == OdometryState::kJumping ||
           state_ == OdometryState::kSlipSuspected;
  }

  // The motion by odometry from the last moment it agreed until now, against
  // the motion by the matches: (robot now <- where odometry, once it has caught
  // up, puts the robot). Identity while it agrees.
  Pose2 MissedMotion() const;

 private:
  struct Entry {
    double time;
    Pose2 odometry;  // since some start, both
    Pose2 match;
  };

  double ChiSquare(const Pose2& odometry, const Pose2& match) const;
  OdometryState CheckInterval(const MotionComparison& comparison) const;
  OdometryState CheckWindow() const;
  bool SuspectSlip(const MotionComparison& comparison);
  void Restart(double time);

  const OdometryCheckOptions options_;
  OdometryState state_ = OdometryState::kOk;
  // Never empty: the first entry is where both began.
  std::deque<Entry> window_;
  Entry last_agreed_;
  // For the suspicion of slip.
  bool has_speed_ = false;
  double speed_ = 0.;         // by odometry, m/s
  double excess_speed_ = 0.;  // of a suspected slip, m/s
  double suspected_since_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_MONITOR_H_
