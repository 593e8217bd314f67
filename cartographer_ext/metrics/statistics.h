// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_METRICS_STATISTICS_H_
#define CARTOGRAPHER_EXT_METRICS_STATISTICS_H_

#include <cstdint>
#include <vector>

namespace cartographer_ext {
namespace evaluation {

// Statistics of a list of values; all zero for an empty one.
struct Statistics {
  int64_t count = 0;
  double mean = 0.;
  double std = 0.;     // of the sample (divisor n - 1); 0 for one value
  double median = 0.;  // for an even count the mean of the middle two
  double rmse = 0.;    // square root of the mean square
  double max = 0.;
};

Statistics ComputeStatistics(std::vector<double> values);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_METRICS_STATISTICS_H_
