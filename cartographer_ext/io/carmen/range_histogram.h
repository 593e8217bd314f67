// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates the reading with which a laser reports "no return", if the log does
// not define it.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_RANGE_HISTOGRAM_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_RANGE_HISTOGRAM_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace cartographer_ext {
namespace io {

// Counts of readings by centimetre.
class RangeHistogram {
 public:
  RangeHistogram() : bins_(kNumRangeBins, 0) {}

  void Add(const std::vector<float>& ranges) {
    for (const float range : ranges) {
      if (!(range > 0.f) || !(range < kNumRangeBins * kRangeBin)) continue;
      ++bins_[std::min<int>(kNumRangeBins - 1, range / kRangeBin)];
      max_ = std::max(max_, range);
    }
  }

  // Just below the code for "no return", infinity if there is none.
  double RangeMax() const {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    if (max_ <= 0.f) return kNoLimit;
    const double below = std::nextafter(max_, 0.f);
    // The laser counts to 2^n - 1 in its unit and reserves the last nine
    // values.
    for (const double reserved : {8.183, 16.375, 32.759, 81.83}) {
      const double unit = reserved > 80. ? 0.01 : 0.001;
      if (max_ > reserved - 0.5 * unit && max_ < reserved + 8.5 * unit) {
        return reserved - unit;
      }
    }
    const int bin = std::min<int>(kNumRangeBins - 1, max_ / kRangeBin);
    int64_t near = 0;
    for (int i = std::max(0, bin - 50); i < bin; ++i) near += bins_[i];
    const bool saturated = bins_[bin] >= 10 && bins_[bin] > 4 * near;
    return saturated ? below : kNoLimit;
  }

 private:
  static constexpr double kRangeBin = 0.01;
  static constexpr int kNumRangeBins = 1 << 14;

  std::vector<int64_t> bins_;
  float max_ = 0.f;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_RANGE_HISTOGRAM_H_
