// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_LOCALIZATION_ERROR_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_LOCALIZATION_ERROR_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace navigation {

struct LocalizationError {
  io::TimeNs time = 0;
  Eigen::Vector2d offset;  // reported less true, map frame
};

// Median and largest distance of the errors, metres.
double MedianError(const std::vector<LocalizationError>& errors);
double MaxError(const std::vector<LocalizationError>& errors);

// Scans at which the error changes by more than half a metre.
int CountJumps(const std::vector<LocalizationError>& errors);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_LOCALIZATION_ERROR_H_
