// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/histogram.h"

#include <algorithm>
#include <numeric>

#include "absl/strings/str_format.h"
#include "glog/logging.h"

namespace cartographer {
namespace common {

void Histogram::Add(const float value) { values_.push_back(value); }

std::string Histogram::ToString(const int buckets) const {
  CHECK_GE(buckets, 1);
  if (values_.empty()) return "Count: 0";
  const auto extremes = std::minmax_element(values_.begin(), values_.end());
  const float min = *extremes.first;
  const float max = *extremes.second;
  const double sum = std::accumulate(values_.begin(), values_.end(), 0.);
  std::string result =
      absl::StrFormat("Count: %d  Min: %f  Max: %f  Mean: %f", values_.size(),
                      min, max, sum / values_.size());
  if (min == max) return result;

  std::vector<int> counts(buckets, 0);
  for (const float value : values_) {
    const int bucket =
        static_cast<int>(buckets * ((value - min) / (max - min)));
    ++counts[std::min(std::max(bucket, 0), buckets - 1)];
  }
  int total = 0;
  for (int i = 0; i != buckets; ++i) {
    total += counts[i];
    constexpr int kBarLength = 20;
    const int bar =
        (counts[i] * kBarLength + values_.size() / 2) / values_.size();
    absl::StrAppendFormat(
        &result, "\n[%f, %f%c %s%s Count: %d (%.2f%%) Total: %d (%.2f%%)",
        min + (max - min) * i / buckets, min + (max - min) * (i + 1) / buckets,
        i + 1 == buckets ? ']' : ')', std::string(kBarLength - bar, ' '),
        std::string(bar, '#'), counts[i], 100. * counts[i] / values_.size(),
        total, 100. * total / values_.size());
  }
  return result;
}

}  // namespace common
}  // namespace cartographer
