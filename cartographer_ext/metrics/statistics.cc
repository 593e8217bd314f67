// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/statistics.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace evaluation {

Statistics ComputeStatistics(std::vector<double> values) {
  Statistics result;
  if (values.empty()) return result;
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double sum = 0., sum_of_squares = 0.;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  result.count = static_cast<int64_t>(values.size());
  result.mean = sum / n;
  result.rmse = std::sqrt(sum_of_squares / n);
  result.max = values.back();
  if (values.size() > 1) {
    // Deviations from the mean rather than a difference of large sums.
    double squared_deviations = 0.;
    for (const double value : values) {
      squared_deviations += (value - result.mean) * (value - result.mean);
    }
    result.std = std::sqrt(squared_deviations / (n - 1.));
  }
  const size_t middle = values.size() / 2;
  result.median = values.size() % 2 == 1
                      ? values[middle]
                      : 0.5 * (values[middle - 1] + values[middle]);
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
