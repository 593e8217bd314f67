// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/metrics/histogram.h"

#include "glog/logging.h"

namespace cartographer {
namespace metrics {

namespace {

class NullHistogram : public Histogram {
 public:
  void Observe(double) override {}
};

}  // namespace

Histogram* Histogram::Null() {
  static NullHistogram histogram;
  return &histogram;
}

Histogram::BucketBoundaries Histogram::FixedWidth(
    const double width, const int num_finite_buckets) {
  BucketBoundaries boundaries;
  double end = 0.;
  for (int i = 0; i != num_finite_buckets; ++i) {
    end += width;
    boundaries.push_back(end);
  }
  return boundaries;
}

Histogram::BucketBoundaries Histogram::ScaledPowersOf(const double base,
                                                      const double scale_factor,
                                                      const double max_value) {
  CHECK_GT(base, 1.);
  CHECK_GT(scale_factor, 0.);
  BucketBoundaries boundaries;
  for (double end = scale_factor; end < max_value; end *= base) {
    boundaries.push_back(end);
  }
  return boundaries;
}

}  // namespace metrics
}  // namespace cartographer
