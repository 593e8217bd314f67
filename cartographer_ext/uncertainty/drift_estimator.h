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
// likelihood of a cycle is a mixture with the density u of a wrong one:
//
//   p(E | c, f, w, h) = (1 - w) N(E; -A c, C(f)) + w u(E | h),
//   u(E | h) = ((1 - h) / 1 rad + h N(E_theta; 0, s^2)) / (2 W)^2.
//
// A wrong loop lies anywhere in the window that was searched, of half width W.
// In buildings of equal parallel places (shelves, rooms along a corridor) it
// has the right heading, so that s is that of a right cycle for factors of one.
// Without this share h, a drift of metres would explain loops one place off
// better than u does. It does not depend on f: otherwise large factors of the
// rotation could explain wrong loops of any heading.
//
// The share w of wrong cycles and h are unknown as well: in a blurred map most
// may be wrong. Assuming too small a share would inflate the noise to explain
// them.
//
// Given f, w and h, c has a normal prior and is found by reweighted least
// squares, where the weight of a cycle is its probability of being right. It
// starts from none and from what single headings of long paths (below) would
// tell, and the likeliest result counts: from none alone, a drift of half a radian
// along the run would pass for wrong loops, all of them. Given c and h, the posterior of (ln f_t, ln f_r, ln f_u, w) is computed on a grid,
// with a normal prior of the logarithms that allows for a factor of ten within
// two standard deviations, and a uniform one of w; given those, h is the mean
// probability of the wrong cycles to be aligned. The steps alternate a fixed
// number of times, while the grid of the factors is narrowed to the posterior.
//
// A loop over a long path closes a cycle, too, but whether its place is the right
// one is the question that the drift is to answer. Equal places are parallel, so
// its heading alone is used, with the share k = w (1 - h) of wrong
// headings:
//
//   p(E_theta | c, f, k) = ((1 - k) N(E_theta; -a c, f_r^2 v_r + f_u^2 v_u + v)
//                           + k / 1 rad)^b,
//
// with a the last row of A and v the elements of the covariances. The paths
// overlap, so what they say is raised to the power of b, the length of the path
// that they cover together over the sum of their lengths, at most one.
//
// The prior noise of the translation is an upper bound on that of a local SLAM
// that works, so the 90 percent point of the prior of its factor is one. A prior
// centred at one would quadruple the bound with the first cycle, however well it
// closes. That of the rotation is centred: turns drift more than assumed where
// they drift, and few cycles tell it.
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
#include "cartographer_ext/uncertainty/drift_cycle.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace uncertainty {

// Priors of the estimation.
struct DriftEstimatorOptions {
  // Mean of the logarithm of the factor of the translation; zero for the
  // others. Standard deviation of all three.
  double prior_translation = -1.28 * 1.15;
  double prior_sigma = 1.15;  // > 0
  // Standard deviations of the errors that are constant along the run, > 0, for
  // uncalibrated wheels and lasers.
  double prior_heading = 0.002;  // radians per metre
  double prior_turning = 0.03;
  double prior_scale = 0.02;
  // Limits of W above, metres, > 0. A narrower window would explain drift by
  // wrong loops. A wider one would explain wrong loops by drift: they are denser
  // in it than evenly spread (docs/benchmarks/any_building.md, "Equal places").
  double least_window = 2.;
  double largest_window = 5.;
  double upper_quantile = 0.9;  // in (0.5, 1)
  size_t max_cycles = 400;      // the oldest are dropped, > 0
};

// Result of the estimation.
struct DriftFit {
  // Exponentials of the means of the logarithms.
  DriftFactors mean;
  DriftFactors upper;
  CommonDrift common;
  double wrong_share = 0.5;    // w, of the cycles
  double aligned_share = 0.5;  // h, of the wrong ones
};

// Collects cycles of a trajectory and fits the drift, see above. Bounded by
// `max_cycles`. Not thread-safe.
class DriftEstimator {
 public:
  explicit DriftEstimator(const DriftEstimatorOptions& options);

  void Add(const DriftCycle& cycle);
  // `driven`: length of the path that the headings cover together, metres.
  // Paths that overlap repeat each other.
  void SetHeadings(std::vector<HeadingCycle> headings, double driven);
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

  // u(E | h) and its two parts, already multiplied by their shares.
  struct WrongDensity {
    double anywhere = 0.;
    double aligned = 0.;
    double Sum() const { return anywhere + aligned; }
  };
  WrongDensity DensityOfWrong(const DriftCycle& cycle,
                              double aligned_share) const;
  Eigen::Vector3d PriorSigma() const;
  // With the drift and the shares of `fit`.
  CommonDrift FitCommon(const DriftFit& fit) const;
  CommonDrift FitCommonFrom(const DriftFit& fit,
                            const Eigen::Vector3d& start) const;
  // Where only the heading (0) or only the turning (1) drifts all along, by as much
  // as the headings tell.
  Eigen::Vector3d StartByHeadings(const DriftFit& fit, int axis) const;
  // Logarithms of the densities of c with its prior, less a constant: of the
  // headings, of everything.
  double LogOfHeadings(const DriftFit& fit,
                       const Eigen::Vector3d& common) const;
  double LogPosterior(const DriftFit& fit, const Eigen::Vector3d& common) const;
  // Updates the masses of the levels in `grid`. Returns the mean of w.
  double FitFactors(const DriftFit& fit, std::array<Marginal, 3>* grid) const;
  double FitAlignedShare(const DriftFit& fit) const;

  const DriftEstimatorOptions options_;
  std::deque<DriftCycle> cycles_;
  std::vector<HeadingCycle> headings_;
  double heading_weight_ = 1.;
  int num_cycles_ = 0;
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_ESTIMATOR_H_
