// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"

#include <cmath>

namespace cartographer_ext {
namespace loop_closure {

double ThresholdFromVariance(const DynamicThresholdOptions& options,
                             const double variance) {
  const double decay = std::exp(-options.sensitivity * variance);
  switch (options.direction) {
    case ThresholdDirection::kAsPrinted:
      return options.low + options.span * decay;  // C eq. 1
    case ThresholdDirection::kStricterWhenUnstable:
      return options.low + options.span * (1. - decay);
  }
  LOG(FATAL) << "unknown threshold direction";
  return options.low;
}

DynamicThreshold::DynamicThreshold(const DynamicThresholdOptions& options)
    : options_(options), scores_(options.window) {}

double DynamicThreshold::Current() const {
  if (!scores_.full()) return options_.base_threshold;
  return ThresholdFromVariance(options_, scores_.Variance());
}

double DynamicThreshold::Variance() const {
  return scores_.full() ? scores_.Variance() : 0.;
}

void DynamicThreshold::AddScore(const double temporal_score) {
  scores_.Add(temporal_score);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
