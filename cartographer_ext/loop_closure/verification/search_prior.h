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

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace loop_closure {

// Volume of a search window by its half widths in metres and radians, m^2 rad.
double SearchVolume(double linear_window, double angular_window);

// A prediction and how far the match lies from it.
struct PredictedMatch {
  Pose2 displacement;
  double translation_sigma = 1.;  // metres, of the prediction, > 0
  double rotation_sigma = 1.;     // radians, > 0
};

// Gaussian density of a true match where this one lies, per m^2 rad.
double PredictedDensity(const PredictedMatch& match);

// Density of a true match where this one lies, given those by two predictions,
// either of which may hold, and by a search in which it may be anywhere. The last
// one has the weight `kUnexpectedShare`: both predictions may be further off than
// they claim.
double TrueDensity(double predicted, double otherwise_predicted,
                   double search_density);

constexpr double kUnexpectedShare = 0.1;

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SEARCH_PRIOR_H_
