// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Online estimate of the offset between the clocks of laser and odometry.
//
// A scan stamped t shows the world at the moment that odometry stamps t - d.
// With the right d the rotation of odometry between two scans equals that of
// the scan matcher. A grid of candidate offsets is evaluated in parallel: each
// one accumulates the squared difference of the rotations with slow forgetting,
// clipped so that wheel slip or a failed match does not decide. Scans between
// which all candidates give the same rotation carry no information and are
// skipped. The estimate is the minimum, refined by a parabola through its
// neighbours, and adopted only with enough evidence and if it is clearly better
// than the current value. A few rotations on the spot suffice.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_

#include <vector>

namespace cartographer_ext {
namespace front_end {

// Candidates and evidence of the estimate.
struct TimeOffsetOptions {
  bool estimate = true;
  double initial = 0.;  // seconds
  // Range of candidates: scans are stamped late more often than early, by a
  // driver or a rotation of the laser.
  double minimum = -0.1;
  double maximum = 0.25;
  double step = 0.01;
  double forgetting = 0.998;  // of the sums, per scan
  double min_spread = 0.01;   // radians, between the candidates
  double clip = 0.05;         // radians
  double min_weight = 25.;    // scans with evidence
  double evidence = 2.;       // logarithm of the likelihood ratio
};

// Estimates the clock offset, see above. Not thread-safe.
class TimeOffsetEstimator {
 public:
  explicit TimeOffsetEstimator(const TimeOffsetOptions& options);

  // The candidate offsets, seconds, ascending; empty without estimation.
  const std::vector<double>& candidates() const { return candidates_; }

  // The rotation between two scans by the scan matcher, and by odometry for
  // every candidate, radians.
  void Add(double matched_turn, const std::vector<double>& odometry_turns);

  // Scan minus odometry stamp of the same moment, seconds.
  double offset() const { return offset_; }
  // Scans with evidence, after forgetting.
  double weight() const { return weight_; }

 private:
  void Update();

  const TimeOffsetOptions options_;
  std::vector<double> candidates_;
  std::vector<double> sums_;
  double weight_ = 0.;
  double offset_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_
