// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Suspicion of wheel slip by the speed of the wheels: it grows faster than the
// robot can accelerate, as wheels do that lose their grip. Where the scan does not
// determine the translation, as in a corridor without features, this is the only
// evidence, as the match there is the prediction itself.
//
// Robots that are driven hard look the same. How often it was slip is learnt where
// scans tell: of s sudden changes that turned out to be faults of odometry while
// they lasted and n that did not, the probability of slip is
//
//   p = (s + 1) / (s + n + 1.5).
//
// A change counts if it lasts, since the error of a stamp is made up for by the
// next, and until half of it is taken back. Slip is likely while p > 1/2, where the
// robot was driving and the wheels have become faster than it ever was where a scan
// told its speed. A robot that stops at once is believed to stop.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_SLIP_SUSPICION_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_SLIP_SUSPICION_H_

#include <vector>

#include "absl/types/optional.h"

namespace cartographer_ext {
namespace front_end {

// Forward speed of the wheels over an interval.
struct WheelSpeed {
  double interval = 0.;  // seconds, > 0
  double speed = 0.;     // m/s
  // Change since the interval before by an IMU, m/s, if there is one.
  absl::optional<double> inertial_change;
};

// What the match says of the same interval.
struct MatchedSpeed {
  double time = 0.;   // of the later scan, seconds
  double speed = 0.;  // forwards, m/s
  // Whether the scan determines the translation along the direction of motion.
  bool is_observable = true;
};

// See above. Not thread-safe.
class SlipSuspicion {
 public:
  // m/s^2, what robots do not exceed.
  explicit SlipSuspicion(const double max_acceleration)
      : max_acceleration_(max_acceleration) {}

  // The next interval between two scans; the wheels over consecutive parts of it.
  void Add(const std::vector<WheelSpeed>& wheels, const MatchedSpeed& match);
  // What the comparison with the matches up to then, the same interval included,
  // says of the odometry: whether it is wrong.
  void Learn(bool is_wrong);
  // There is no odometry for an interval.
  void Interrupt();

  // Whether the speed has changed suddenly and the scan tells nothing.
  bool is_suspected() const { return is_sudden_ && !last_.is_observable; }
  // Whether the wheels rather slip than not, whatever the scan tells.
  bool is_likely() const { return is_likely_; }
  // There is nothing else to go by.
  bool is_believed() const { return is_likely_ && !last_.is_observable; }
  // Of the wheels before the suspicion, m/s.
  double speed_before() const { return speed_before_; }

 private:
  void AddPart(const WheelSpeed& part);
  // Over a time for which there is a speed.
  void AddSpeed(const WheelSpeed& wheels);
  bool IsSudden(const WheelSpeed& wheels, double change) const;
  double SlipProbability() const;

  const double max_acceleration_;
  double time_ = 0.;              // of the end of the last part, seconds
  WheelSpeed pending_;            // parts that are too short
  absl::optional<double> speed_;  // of the wheels in the last part, m/s
  // Of the wheels over half a second, where nothing is suspected, m/s.
  double speed_before_ = 0.;
  bool is_suspicious_ = false;  // since a sudden change
  double largest_excess_ = 0.;  // since then, m/s
  double excess_distance_ = 0.;
  double suspected_since_ = 0.;
  int suspected_parts_ = 0;
  bool was_driving_ = false;  // before the suspicion
  bool is_sudden_ = false;    // and has lasted
  bool is_likely_ = false;
  MatchedSpeed last_;
  double last_interval_ = 0.;  // seconds
  // By matches where scans tell, over half a second, m/s; the largest in this and
  // in the last period without a fault, and in those before.
  double matched_speed_ = 0.;
  double fastest_now_ = 0., fastest_before_ = 0., fastest_ = 0.;
  double period_ = 0.;  // seconds
  // A sudden change that is not decided yet, and for how long scans have told.
  bool is_undecided_ = false;
  double told_ = 0.;      // seconds
  bool is_told_ = false;  // all the time
  int num_slips_ = 0;
  int num_others_ = 0;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_SLIP_SUSPICION_H_
