// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Importance of keys, computed from the trials of a search with any sampler.
// Objectives are replaced by their ranks first, because the error of a folded
// map is a hundred times that of a good one and would dominate.
//
// * effect: share of the variance of the ranks that the value of this key
//   explains, by the means over quarters of its range (or its choices); the
//   correlation ratio, corrected for what that many groups explain by chance.
// * trend: rank correlation of value and objective (Spearman), -1 to 1; with a
//   positive trend larger values are worse.
#ifndef CARTOGRAPHER_EXT_TUNING_SENSITIVITY_H_
#define CARTOGRAPHER_EXT_TUNING_SENSITIVITY_H_

#include <cstddef>
#include <string>
#include <vector>

#include "cartographer_ext/tuning/parameter_space.h"

namespace cartographer_ext {
namespace tuning {

constexpr size_t kLeastTrialsForSensitivity = 8;

struct Sensitivity {
  std::string key;
  double effect = 0.;  // 0 to 1
  double trend = 0.;   // 0 for choices
  int trials = 0;
};

// `points` and their `objectives`; in the order of the parameters. All zero
// with fewer trials than that.
std::vector<Sensitivity> ComputeSensitivity(
    const std::vector<Parameter>& parameters, const std::vector<Point>& points,
    const std::vector<double>& objectives);

// 1 for the smallest; equal values share the mean of their ranks.
std::vector<double> Ranks(const std::vector<double>& values);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SENSITIVITY_H_
