// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/search_prior.h"

#include <cmath>

namespace cartographer_ext {
namespace loop_closure {

double SearchVolume(const double linear_window, const double angular_window) {
  const double width = 2. * linear_window;
  return width * width * 2. * angular_window;
}

double PredictedDensity(const PredictedMatch& match) {
  const double distance =
      match.displacement.translation().norm() / match.translation_sigma;
  const double angle =
      NormalizeAngle(match.displacement.theta) / match.rotation_sigma;
  return std::exp(-0.5 * (distance * distance + angle * angle)) /
         (std::pow(2. * kPi, 1.5) * match.translation_sigma *
          match.translation_sigma * match.rotation_sigma);
}

double TrueDensity(const double predicted, const double otherwise_predicted,
                   const double search_density) {
  return 0.5 * (1. - kUnexpectedShare) * (predicted + otherwise_predicted) +
         kUnexpectedShare * search_density;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
