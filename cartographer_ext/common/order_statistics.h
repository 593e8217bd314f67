// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Medians and quantiles of unsorted values. Nothing is interpolated: the result
// is one of the values, so it does not depend on rounding. Where the mean of the
// two middle values is wanted, ComputeStatistics (metrics/statistics.h) has it.
#ifndef CARTOGRAPHER_EXT_COMMON_ORDER_STATISTICS_H_
#define CARTOGRAPHER_EXT_COMMON_ORDER_STATISTICS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "glog/logging.h"

namespace cartographer_ext {

// The value at index `rank` of the values in ascending order.
template <typename T>
T OrderStatistic(std::vector<T> values, const size_t rank) {
  CHECK_LT(rank, values.size());
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[rank];
}

// The median of an odd number of values, the larger one of the middle two of an
// even number. `values` must not be empty.
template <typename T>
T UpperMedian(std::vector<T> values) {
  const size_t rank = values.size() / 2;
  return OrderStatistic(std::move(values), rank);
}

// Quantile by nearest rank: the smallest value that at least `fraction` (0 to 1)
// of the values do not exceed. The quantile 0.5 of an even number of values is
// the smaller one of the middle two. `values` must not be empty.
template <typename T>
T NearestRankQuantile(std::vector<T> values, const double fraction) {
  CHECK(!values.empty());
  const double rank = std::max(
      0., std::ceil(fraction * static_cast<double>(values.size())) - 1.);
  const size_t last = values.size() - 1;
  return OrderStatistic(std::move(values),
                        std::min(last, static_cast<size_t>(rank)));
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_ORDER_STATISTICS_H_
