// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Online estimate of the offset between the clocks of laser and odometry.
//
// A scan stamped t shows the world at the moment that odometry stamps t - d.
// With the right d the turn that odometry reports between two scans is that of
// the scan matcher. A grid of offsets is tried in parallel: for each one the
// squared difference of the turns, clipped so that a wheel that slips or a
// match that fails does not decide, is summed up with slow forgetting. Scans
// between which all offsets tell the same turn say nothing and are left out.
// The estimate is the minimum, refined by the parabola through its neighbours,
// and taken over only when there is enough evidence and it is clearly better
// than the value in force. A few turns on the spot are enough.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_

#include <vector>

namespace cartographer_ext {
namespace front_end {

struct TimeOffsetOptions {
  bool estimate = true;
  double initial = 0.;  // seconds
  double minimum = -0.1;
  double maximum = 0.25;
  double step = 0.01;
  double forgetting = 0.998;  // a scan, of the sums
  double min_spread = 0.01;   // radians, of the turns by offset
  double clip = 0.05;         // radians
  double min_weight = 25.;    // scans with evidence
  double evidence = 2.;       // logarithm of the likelihood ratio
};

class TimeOffsetEstimator {
 public:
  explicit TimeOffsetEstimator(const TimeOffsetOptions& options);

  // The offsets on trial, seconds, ascending; empty without estimate.
  const std::vector<double>& candidates() const { return candidates_; }

  // The turn between two scans by the scan matcher, and by odometry for every
  // candidate, radians.
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
