// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_METRICS_HISTOGRAM_H_
#define CARTOGRAPHER_METRICS_HISTOGRAM_H_

#include <map>
#include <vector>

namespace cartographer {
namespace metrics {

// Counts observations by bucket. Boundaries are the upper ends of the finite
// buckets; one more takes what is above.
class Histogram {
 public:
  using BucketBoundaries = std::vector<double>;

  // Ignores everything.
  static Histogram* Null();

  // width, 2 * width, ...
  static BucketBoundaries FixedWidth(double width, int num_finite_buckets);

  // scale_factor, scale_factor * base, ... while not above max_value.
  // `base` > 1, `scale_factor` > 0.
  static BucketBoundaries ScaledPowersOf(double base, double scale_factor,
                                         double max_value);

  virtual ~Histogram() = default;
  virtual void Observe(double value) = 0;
};

}  // namespace metrics
}  // namespace cartographer

#endif  // CARTOGRAPHER_METRICS_HISTOGRAM_H_
