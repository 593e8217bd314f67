// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/localization_error.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "cartographer_ext/common/order_statistics.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kJump = 0.5;  // metres

}  // namespace

int CountJumps(const std::vector<LocalizationError>& errors) {
  int jumps = 0;
  for (size_t i = 1; i < errors.size(); ++i) {
    jumps += (errors[i].offset - errors[i - 1].offset).norm() > kJump;
  }
  return jumps;
}

double MedianError(const std::vector<LocalizationError>& errors) {
  if (errors.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> distances;
  for (const LocalizationError& error : errors) {
    distances.push_back(error.offset.norm());
  }
  return UpperMedian(std::move(distances));
}

double MaxError(const std::vector<LocalizationError>& errors) {
  double largest =
      errors.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.;
  for (const LocalizationError& error : errors) {
    largest = std::max(largest, error.offset.norm());
  }
  return largest;
}

}  // namespace navigation
}  // namespace cartographer_ext
