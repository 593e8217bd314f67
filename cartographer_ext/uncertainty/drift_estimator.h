// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Drift of local SLAM, estimated from cycles that loops close over short pieces
// of its path.
//
// Without errors of its path a cycle would close. With c the errors that are
// constant along the run (CommonDrift) and A their effects,
//
//   E = -A c + noise,
//   cov(noise) = C(f) = f_t^2 C_t + f_r^2 C_r + f_u^2 C_u + C_other,
//
// where C_t, C_r and C_u are the prior covariances from translation, rotation
// per metre and rotation while turning, and C_other is the noise of the loops.
// The unknowns are c and the factors f. Some of the loops are wrong, so the
// likelihood of a cycle is a mixture with a uniform density:
//
//   p(E | c, f, w) = (1 - w) N(E; -A c, C(f)) + w u.
//
// The share w of wrong cycles is unknown as well: in a blurred map most may be
// wrong. Assuming too small a share would inflate the noise to explain them.
//
// Given f and w, c has a normal prior and is found by reweighted least squares,
// where the weight of a cycle is its probability of being right. Given c, the
// posterior of (ln f_t, ln f_r, ln f_u, w) is computed on a grid, with a normal
// prior around zero that allows for a factor of ten within two standard
// deviations, and a uniform one of w. Both steps alternate a fixed number of
// times, while the grid of the factors is narrowed to the posterior.
//
// The upper bound is a quantile of each factor: far above the mean with few
// cycles, close to it later.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_ESTIMATOR_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_ESTIMATOR_H_

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/uncertainty/path_uncertainty.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace uncertainty {

// A cycle that would close without errors.
struct DriftCycle {
  Eigen::Vector3d error;  // metres, metres, radians
  CovarianceParts parts;  // of the error; loops are in `other`
};

// A piece of the path of local SLAM, not corrected.
struct DriftStretch {
  Pose2 pose;
  CovarianceParts parts;
};

// The cycle of two loops (cycle_consistency.h): `loop_u` is (a_u <- b_u),
// `path_b` (b_u <- b_v), `loop_v` (a_v <- b_v), `path_a` (a_v <- a_u).
DriftCycle CycleOfLoops(const UncertainPose& loop_u, const DriftStretch& path_b,
                        const UncertainPose& loop_v,
                        const DriftStretch& path_a);
// The cycle of one loop (a <- b) with the path (b <- a).
DriftCycle CycleOfLoop(const UncertainPose& loop, const DriftStretch& path);

// Priors of the estimation.
struct DriftEstimatorOptions {
  // Standard deviation of the logarithm of a factor.
  double prior_sigma = 1.15;  // > 0
  // Standard deviations of the errors that are constant along the run, > 0, for
  // uncalibrated wheels and lasers.
  double prior_heading = 0.002;  // radians per metre
  double prior_turning = 0.03;
  double prior_scale = 0.02;
  double outlier_density = 0.01;  // u, over 10 m by 10 m by 1 rad
  double upper_quantile = 0.9;    // in (0.5, 1)
  size_t max_cycles = 400;        // the oldest are dropped, > 0
};

// Result of the estimation.
struct DriftFit {
  // Exponentials of the means of the logarithms.
  DriftFactors mean;
  DriftFactors upper;
  CommonDrift common;
  double wrong_share = 0.5;  // w, of the cycles
};

// Collects cycles of a trajectory and fits the drift, see above. Bounded by
// `max_cycles`. Not thread-safe.
class DriftEstimator {
 public:
  explicit DriftEstimator(const DriftEstimatorOptions& options);

  void Add(const DriftCycle& cycle);
  DriftFit Fit() const;
  // Number of cycles ever added.
  int num_cycles() const { return num_cycles_; }

 private:
  // Posterior of the logarithm of one factor on equidistant levels, each of
  // which represents its cell.
  struct Marginal {
    double center = 0.;
    double step = 1.;
    std::vector<double> mass;  // sums to one

    double LogFactor(int level) const;
    double Mean() const;
    double Sigma() const;
    double Quantile(double quantile) const;
  };

  CommonDrift FitCommon(const DriftFactors& factors, double wrong_share) const;
  // Updates the masses of the levels in `grid`. Returns the mean of w.
  double FitFactors(const CommonDrift& common,
                    std::array<Marginal, 3>* grid) const;

  const DriftEstimatorOptions options_;
  std::deque<DriftCycle> cycles_;
  int num_cycles_ = 0;
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_ESTIMATOR_H_
