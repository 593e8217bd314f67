// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The noise that neighbouring loops show among themselves. A cycle of two of them has
// only short stretches of odometry, so it closes in any map, or in none.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_CYCLE_NOISE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_CYCLE_NOISE_H_

#include <vector>

#include "cartographer_ext/optimization/offline/loop_support.h"

namespace cartographer_ext {
namespace optimization {

// Factors on the standard deviations that explain the errors e of cycles best, as a
// mixture of right ones and of ones that lead anywhere within the area A that the
// errors cover:
//
//   sum over cycles log( p N(e; 0, o^2 C_o + l^2 C_l) + (1 - p) / (2 pi A) )
struct CycleNoise {
  double odometry = 1.;
  double loops = 1.;
  double share = 0.;  // p
  double log_likelihood = 0.;
  double of_given = 0.;  // that of the claimed noise
};

// The best of factors from the root of two down to a thirty-second, in steps of the
// root of two.
CycleNoise FindCycleNoise(const std::vector<LoopCycle>& cycles);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_CYCLE_NOISE_H_
