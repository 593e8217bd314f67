// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef TESTS_UNCERTAINTY_RANDOM_WALK_H_
#define TESTS_UNCERTAINTY_RANDOM_WALK_H_

#include <limits>

#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace uncertainty {

// Noise without what is constant along a run, and however far nodes are apart.
inline PathNoiseOptions RandomWalk() {
  PathNoiseOptions noise;
  noise.heading_drift = 0.;
  noise.scale_error = 0.;
  noise.jump_threshold_metres = std::numeric_limits<double>::infinity();
  noise.jump_threshold_radians = std::numeric_limits<double>::infinity();
  return noise;
}

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // TESTS_UNCERTAINTY_RANDOM_WALK_H_
