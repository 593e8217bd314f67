// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/range_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kFirstRange = 0.25;  // metres
constexpr double kRangesPerOctave = 2.;
constexpr double kFirstDifference = 5e-4;  // metres
constexpr double kDifferencesPerOctave = 5.;
// Beams until it is known, until it is found anew, and until nothing is new.
constexpr uint32_t kMinCount = 1024;
constexpr uint32_t kCountPerUpdate = 256;
constexpr uint32_t kMaxCount = 20 * 1024;
// Of the absolute value of a normal deviate, in standard deviations.
struct Quantile {
  double share;
  double value;
};
constexpr Quantile kQuantiles[] = {
    {0.1, 0.12566}, {0.25, 0.31864}, {0.5, 0.67449}, {0.75, 1.15035}};
// Standard deviations by the quantiles differ by more where it is not noise.
constexpr double kMostRatio = 1.3;
// Nor is it where they are larger: metres, and of the range.
constexpr double kMostNoise = 0.02;
constexpr double kMostNoisePerMetre = 0.02;

int Bin(const double value, const double first, const double per_octave,
        const int count) {
  if (!(value > first)) return 0;
  return std::min(count - 1,
                  static_cast<int>(per_octave * std::log2(value / first)));
}

}  // namespace

void RangeNoise::Add(const Beam& before, const Beam& beam, const Beam& after) {
  const double whole = std::sin(after.bearing - before.bearing);
  const double weight_before = std::sin(after.bearing - beam.bearing) / whole;
  const double weight_after = std::sin(beam.bearing - before.bearing) / whole;
  const double expected =
      weight_before / before.range + weight_after / after.range;
  // In the middle of beams evenly apart sqrt(1.5) times the noise.
  const double difference =
      std::abs(beam.range * (1. - beam.range * expected)) /
      std::sqrt(1. + weight_before * weight_before +
                weight_after * weight_after);
  if (!std::isfinite(difference)) return;
  const int range = Bin(beam.range, kFirstRange, kRangesPerOctave, kNumRanges);
  ++counts_[range][Bin(difference, kFirstDifference, kDifferencesPerOctave,
                       kNumDifferences)];
  if (++totals_[range] % kCountPerUpdate == 0) Update(range);
}

bool RangeNoise::IsKnown(const double range) const {
  return totals_[Bin(range, kFirstRange, kRangesPerOctave, kNumRanges)] >=
         kMaxCount;
}

double RangeNoise::At(const double range) const {
  const double sigma =
      sigmas_[Bin(range, kFirstRange, kRangesPerOctave, kNumRanges)];
  return sigma <= kMostNoise + kMostNoisePerMetre * range ? sigma : 0.;
}

double RangeNoise::Difference(const int range, const double share) const {
  const auto& counts = counts_[range];
  const double wanted = share * totals_[range];
  double below = 0.;
  int k = 0;
  while (k + 1 < kNumDifferences && below + counts[k] < wanted) {
    below += counts[k++];
  }
  // Those in the first one may be nothing at all: ranges have steps.
  if (k == 0) return 0.;
  const double part = (wanted - below) / std::max<double>(1., counts[k]);
  return kFirstDifference * std::exp2((k + part) / kDifferencesPerOctave);
}

void RangeNoise::Update(const int range) {
  if (totals_[range] < kMinCount) return;
  double least = std::numeric_limits<double>::infinity(), most = 0.;
  for (const Quantile& quantile : kQuantiles) {
    const double sigma = Difference(range, quantile.share) / quantile.value;
    least = std::min(least, sigma);
    most = std::max(most, sigma);
  }
  sigmas_[range] =
      most <= kMostRatio * least ? Difference(range, 0.5) / 0.67449 : 0.;
}

}  // namespace front_end
}  // namespace cartographer_ext
