// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How well the path between the ends of a loop predicts it. In a building of
// equal places a set of loops that are all one place off is as consistent as the
// right one, and may be the larger one. What tells them apart is how far local
// SLAM must have drifted for them.
//
// With chi^2 the squared Mahalanobis distance of the loop from the path, and f a
// factor on the variances of the path, the densities of a right loop and of one
// that lies anywhere within three standard deviations have the ratio
//
//   q(f) = 6^3 / (2 pi f)^(3/2) exp(-chi^2 / (2 f)).
//
// The noise that is assumed for a path is an upper bound, so that f is below one
// where local SLAM works. It is estimated from all loops over long paths, the wrong
// ones included: with p_i the probability by its scores that a loop is right, and
// w_i the density of wrong ones,
//
//   p(loops | f) = prod_i (p_i q_i(f) + (1 - p_i) w_i)^b_i,
//
// where b_i is the share of the path that the loop does not have in common with
// others that confirm it: they share its error. The prior of f is that of the
// translation in drift_estimator.h, whose 90 percent point is one. The same
// quantile of the posterior, at most one, is used: an upper bound again.
//
// A factor below one is for the long paths that it was learnt from. A path is never
// taken to be better known than one of 30 m, for which the estimate of the drift
// holds.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_PATH_AGREEMENT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_PATH_AGREEMENT_H_

#include <vector>

#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Metres. A place at the end of a longer path may be another one that looks alike;
// from shorter ones the drift is estimated (drift_learner.h).
constexpr double kLongPath = 30.;

// A loop and the path between its ends.
struct PathAgreement {
  double length = 0.;      // of the path, metres
  double chi_square = 0.;  // for a factor of one
  // w above: of wrong loops within the window that was searched, in units of that
  // within three standard deviations, at most 1. 0: no path is known.
  double wrong_density = 0.;

  bool is_known() const { return wrong_density > 0.; }
};

// `search_density`: of matches evenly spread over the window, per m^2 rad.
// Unknown where `paths` has no path between the ends, or the density is zero.
PathAgreement AgreementWithPath(const uncertainty::PathUncertainty& paths,
                                const uncertainty::LoopEdge& loop,
                                double search_density);

// The factor on the variances of a path of this length, metres, where long paths
// have the factor `factor` in (0, 1].
double FactorOfPath(double factor, double length);

// q above.
double DensityOfRight(const PathAgreement& agreement, double factor);

// What the path says about a loop whose path is known: d, q with a share for paths
// that are worse than they claim, over the density w.
double OddsByPath(const PathAgreement& agreement, double factor);

// A loop over a long path, from which f is estimated.
struct PathSample {
  PathAgreement agreement;  // known, over a long path
  double probability = 0.;  // p above
  double share = 1.;        // b above
};

// The upper bound of f, see above; 1 without samples.
double LearnPathFactor(const std::vector<PathSample>& samples);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_PATH_AGREEMENT_H_
