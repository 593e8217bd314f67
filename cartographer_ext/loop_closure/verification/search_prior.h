// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What is known about a match before its scores are looked at: how much was
// searched, and where in it the match lies. In a window of a metre around a
// well-known prediction the best match is nearly always the right one, in a
// whole building often not; and a true match lies near its prediction, while
// wrong ones lie anywhere.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SEARCH_PRIOR_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SEARCH_PRIOR_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace loop_closure {

// Volume of a search window by its half widths in metres and radians, m^2 rad.
double SearchVolume(double linear_window, double angular_window);

// Gaussian density of a true match at this displacement from its prediction, per
// m^2 rad. `covariance` of (x, y, theta), positive definite, in the frame of the
// displacement.
double PredictedDensity(const Pose2& displacement,
                        const Eigen::Matrix3d& covariance);

// Density of a true match where this one lies, given those by two predictions,
// either of which may hold, and by a search in which it may be anywhere. The last
// one has the weight `kUnexpectedShare`: both predictions may be further off than
// they claim.
double TrueDensity(double predicted, double otherwise_predicted,
                   double search_density);

constexpr double kUnexpectedShare = 0.1;

// Logarithm of the likelihood that a match with this score is the true one, up to
// a constant: of two matches of one search, the larger one is likelier. Places
// that look alike have nearly the same score, so that it decides only as far as
// it differs by more than its noise. `predicted_density` as above.
double LogLikelihoodOfMatch(double score, double predicted_density,
                            double search_density);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SEARCH_PRIOR_H_
