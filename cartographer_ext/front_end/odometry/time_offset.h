// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Online estimate of the offset between the clocks of laser and odometry.
//
// A scan stamped t shows the world at the moment that odometry stamps t - d.
// With the right d the rotation of odometry between two scans equals that of
// the scan matcher. A grid of candidate offsets is evaluated in parallel: each
// one accumulates the squared difference of the rotations with slow forgetting,
// clipped so that wheel slip or a failed match does not decide. Scans for which
// the candidates' rotations differ no more than by the noise carry no information
// and are skipped. The estimate is the minimum, refined by a parabola through its
// neighbours.
//
// The heading of wheels is noisy, and of many candidates one always fits best. So
// the estimate is adopted only if it is significantly better than the initial
// value or the current one: the sum over the scans of the differences of the
// squares, in standard deviations as these differences scatter (the test of Vuong,
// "Likelihood ratio tests for model selection and non-nested hypotheses",
// Econometrica 57, 1989, without centring). Some rotations on the spot suffice.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_

#include <cstddef>
#include <deque>
#include <limits>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

// Candidates and evidence of the estimate.
struct TimeOffsetOptions {
  bool estimate = true;
  double initial = 0.;  // seconds
  // Range of candidates: scans are stamped late more often than early, by a
  // driver or a rotation of the laser; in the log of Killian Court by 0.62 s.
  double minimum = -0.1;
  double maximum = 0.8;
  double step = 0.01;
  double forgetting = 0.998;  // of the sums, per scan
  double min_spread = 0.01;   // radians, between the candidates
  double noise_spread = 6.;   // the same in standard deviations of the noise
  double clip = 0.05;         // radians
  double min_weight = 40.;    // scans with evidence
  // Standard deviations by which the estimate must be better than the initial
  // value or the one in force, and those by which it must then be better than the
  // one in force.
  double significance = 3.2;
  double least_gain = 1.;
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
  // Notes the absolute differences of a scan of all candidates.
  void AddErrors(const std::vector<double>& errors);
  // By how much better than an offset a candidate explains the matches: the
  // difference of the sums in standard deviations of what the differences from
  // scan to scan let expect by chance.
  double Significance(size_t candidate, double offset) const;

  const TimeOffsetOptions options_;
  std::vector<double> candidates_;
  // Of the last scans, oldest first, and the standard deviation of those of the
  // best candidate; infinite until there are enough.
  std::deque<std::vector<double>> errors_;
  int num_errors_ = 0;
  double noise_ = std::numeric_limits<double>::infinity();
  // Of the squared differences, and of the products of those of two candidates.
  std::vector<double> sums_;
  Eigen::MatrixXd products_;
  double weight_ = 0.;
  double offset_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_TIME_OFFSET_H_
