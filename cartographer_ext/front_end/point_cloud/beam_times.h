// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// When the beams of a laser were measured that does not say so.
//
// A laser that turns once between two scans measures the last beam of a scan that
// much later than the first. If its driver gives one stamp for all, scans of a
// turning robot are too wide or too narrow: by nine degrees at 50 degrees a second
// and 5.5 scans a second. They turn the map. Other lasers without times of beams
// measure at once, or have a mirror that turns much faster.
//
// Which it is, and which way the laser turns, is asked of the scans while the robot
// turns: each is put right by every candidate, and the candidate whose scans fit the
// map better is taken as soon as the sum of their log-likelihoods is larger by
// `kMinEvidence` and by `kSignificance` standard deviations of what it scatters by
// (the test of time_offset.h), each scan clipped so that a failed match does not
// decide. One that is as much less likely is not asked for any more. Times are
// relative to the middle of the sweep, so that the pose of a scan does not depend
// on the answer.
#ifndef CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_BEAM_TIMES_H_
#define CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_BEAM_TIMES_H_

#include <array>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

// The direction in which a laser turns, seen from above. Without evidence the
// beams of a scan were measured at once.
enum class BeamOrder { kAtOnce, kCounterclockwise, kClockwise };

// Learns the order, see above. Not thread-safe.
class BeamTimes {
 public:
  static constexpr double kMinEvidence = 7.;    // natural logarithm
  static constexpr double kSignificance = 3.2;  // standard deviations

  // A scan: its returns in the order of the beams, from the laser, metres; seconds
  // since the scan before, zero if unknown.
  void AddScan(const std::vector<Eigen::Vector2f>& returns, double interval);

  // Those that may yet turn out to be better than order(), for a turn of the robot
  // since the scan before, radians; none if it distorts a scan too little.
  std::vector<BeamOrder> Candidates(double turn) const;

  // By how much the last scan is more likely in this order than in order().
  void AddEvidence(BeamOrder candidate, double gain);

  BeamOrder order() const { return order_; }

  // Of returns of the last scan in any order, seconds after the middle of the
  // sweep; zero if all are measured at once.
  std::vector<float> Times(BeamOrder order,
                           const std::vector<Eigen::Vector2f>& returns) const;

 private:
  static constexpr int kNumOrders = 3;
  struct Evidence {
    double sum = 0.;
    double squares = 0.;
  };

  // Seconds from the first to the last beam if the laser turns once a scan.
  double Sweep() const;

  BeamOrder order_ = BeamOrder::kAtOnce;
  std::array<Evidence, kNumOrders> evidence_;
  std::vector<double> intervals_;  // of the first scans
  double period_ = 0.;             // their median; zero: not known
  // Of all beams that had a return, radians, continuous; where they begin the laser
  // begins.
  bool has_bearings_ = false;
  double first_bearing_ = 0., last_bearing_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_BEAM_TIMES_H_
