// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Innovation check of odometry: its motion between scans against that of the
// scan matcher.
//
// Two comparisons are made, both by
//
//   chi2 = |dt|^2 / s_t^2 + dr^2 / s_r^2
//
// with standard deviations that grow with the motion,
//
//   s_t^2 = translation^2 + (per_metre * distance)^2
//   s_r^2 = rotation^2 + (per_radian * angle)^2:
//
//  * from scan to scan, for sudden faults: odometry that repeats a pose
//  (stale),
//    or reports more motion than the robot made (jumping);
//  * over a window of about a second, for lasting faults: the wrong sign in
//    reverse, and wheel slip.
//
// A lasting fault ends when the window agrees again; a jump or a run of stale
// poses ends with the interval, and the window restarts.
//
// Where the translation is not observable in the scan, its match is the
// prediction itself, and only rotations are compared. A speed that changes
// faster than the robot can accelerate is then the only evidence; it is reported
// as a suspicion, and as slip where it is believed (slip_suspicion.h). Elsewhere
// it is a prior: the window then decides as within a fault.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_MONITOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_MONITOR_H_

#include <deque>
#include <functional>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/odometry/slip_suspicion.h"

namespace cartographer_ext {
namespace front_end {

// State of odometry in an interval between two scans.
enum class OdometryState {
  kOk,
  kAbsent,         // no readings, or none for this interval
  kStale,          // repeats a pose while the robot moves
  kJumping,        // moves further than the robot
  kWrongSign,      // forwards instead of backwards
  kSlipping,       // wheel slip
  kSlipSuspected,  // sudden speed where the translation is not observable
};

// Whether odometry moved otherwise than the robot.
bool IsWrong(OdometryState state);

// Log-likelihood by which a scan must contradict odometry before that is held
// for wrong, which it is in about one scan of a thousand.
constexpr double kLogOddsOfOdometryFault = 7.;

// Noise and thresholds of the comparison.
struct OdometryCheckOptions {
  bool enabled = true;
  // Motions are also compared over this time. Longer detects weaker slip,
  // later.
  double window = 1.;  // seconds
  // chi2, 3 degrees of freedom: far beyond 0.9999, since errors of scan
  // matching are not Gaussian and a false alarm costs the odometry.
  double gate = 25.;
  // Standard deviations of the comparison, of scan matching above all: about
  // half a cell of 5 cm.
  double translation_noise = 0.03;  // metres
  double rotation_noise = 0.03;     // radians
  double translation_noise_per_metre = 0.05;
  double rotation_noise_per_radian = 0.1;
  // A change of motion between two scans by this much is suspect at once,
  // before matching: beyond what the search around a prediction covers easily.
  double jump_distance = 0.3;  // metres
  double jump_angle = 0.3;     // radians
  // A fault of odometry needs this much evidence of the scan, natural logarithm
  // of a ratio of likelihoods.
  double min_evidence = kLogOddsOfOdometryFault;
  // Where the translation is not observable, above what robots in buildings do.
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
  // The match makes up for errors of several intervals before, and is no jump.
  bool makes_up = false;
  // Whether the scan determines the translation along the direction of motion.
  bool translation_observable = true;
  // Over consecutive parts of the interval, for suspicions of slip. None: the mean.
  std::vector<WheelSpeed> speeds;
  // By how much more likely (natural logarithm) the scan is at its match than
  // displaced by an error of odometry, (robot by the match <- robot by
  // odometry). Not given: matches are beyond doubt.
  std::function<double(const Pose2&)> evidence;
};

// Checks odometry against scan matching, see above. Not thread-safe.
class OdometryMonitor {
 public:
  explicit OdometryMonitor(const OdometryCheckOptions& options);

  // Before the match: whether the motion by odometry differs too much from the
  // expected one to be trusted.
  bool IsSuspect(double interval, const Pose2& odometry, bool frozen,
                 const Pose2& expected) const;

  // After the match. Returns the state of the interval.
  OdometryState Add(const MotionComparison& given);

  OdometryState state() const { return state_; }
  // Whether the wheels may slip where the scan does not tell, whatever the state.
  bool suspects_slip() const { return suspicion_.is_suspected(); }
  // Of the wheels before that, m/s.
  double speed_before_slip() const { return suspicion_.speed_before(); }
  // Whether predictions should use odometry. A jump is over once detected.
  bool IsTrusted() const {
    return state_ == OdometryState::kOk || state_ == OdometryState::kJumping ||
           state_ == OdometryState::kSlipSuspected;
  }

  // Faults of odometry per metre that the robot drove, by those that scans showed.
  double faults_per_metre() const {
    return (kPriorFaults + num_faults_) / (kPriorMetres + metres_);
  }

  // The difference of the motions by odometry and by the matches since they
  // last agreed: (robot now <- robot according to odometry). Identity while
  // they agree. After a jump that of the jump: it may be the scan that is wrong,
  // by a stamp long after it was measured.
  Pose2 MissedMotion() const;

 private:
  struct Entry {
    double time;
    Pose2 odometry;  // both since the same arbitrary start
    Pose2 match;
  };

  // Before any scan: wheels slip once in two hundred metres.
  static constexpr double kPriorFaults = 1.;
  static constexpr double kPriorMetres = 200.;

  OdometryState Judge(const MotionComparison& given);
  void SuspectSlip(const MotionComparison& comparison);
  OdometryState Decide(const MotionComparison& comparison);
  double ChiSquare(const Pose2& odometry, const Pose2& match) const;
  OdometryState CheckInterval(const MotionComparison& comparison) const;
  OdometryState CheckWindow(const MotionComparison& comparison) const;
  // Whether the scan itself tells that odometry is wrong.
  static bool IsEvident(const MotionComparison& comparison,
                        const Pose2& odometry, const Pose2& match,
                        double min_evidence);
  // Since the last agreement up to `entry`, see MissedMotion.
  Pose2 MissedBy(const Entry& entry) const;
  void Restart(double time);

  const OdometryCheckOptions options_;
  OdometryState state_ = OdometryState::kOk;
  // Never empty: the first entry is the start of both.
  std::deque<Entry> window_;
  Entry last_agreed_;
  Pose2 jump_;  // the motion that was missed in a jump
  int num_faults_ = 0;
  double metres_ = 0.;  // driven by the matches
  SlipSuspicion suspicion_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_MONITOR_H_
