// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The threshold on the temporal score (paper C, optimised Cartographer 2025,
// section 1.2).
//
//   C eq. 1   tau = 0.5 + 0.2 exp(-C Var(S_t))
//
// with the variance over the last k temporal scores (eq. 2, 3). The text asks
// for a stricter threshold when the scores are unstable, but the formula
// relaxes it: Var = 0 gives 0.7, a large variance gives 0.5. Both readings are
// available:
//
//   kAsPrinted              tau = low + span exp(-C Var)
//   kStricterWhenUnstable   tau = low + span (1 - exp(-C Var))
//
// Score variances are of the order 1e-3 ... 1e-2, so C must be tens to hundreds
// to have an effect: C = 100 puts the middle of the range at Var = 0.007. Until
// k scores exist the fixed base threshold applies.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_DYNAMIC_THRESHOLD_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_DYNAMIC_THRESHOLD_H_

#include "cartographer_ext/loop_closure/verification/score_window.h"

namespace cartographer_ext {
namespace loop_closure {

// Effect of a large variance on the threshold, see above.
enum class ThresholdDirection { kAsPrinted, kStricterWhenUnstable };

// Parameters of eq. 1 to 3.
struct DynamicThresholdOptions {
  bool enabled = true;  // otherwise there is no threshold
  ThresholdDirection direction = ThresholdDirection::kStricterWhenUnstable;
  double low = 0.45;            // of eq. 1, in [0, 1]
  double span = 0.1;            // of eq. 1, in [0, 1 - low]
  double sensitivity = 100.;    // C of eq. 1, >= 0
  int window = 10;              // k of eq. 2, > 0
  double base_threshold = 0.5;  // until k scores exist, in [0, 1]
};

// C eq. 1 for a given variance (>= 0).
double ThresholdFromVariance(const DynamicThresholdOptions& options,
                             double variance);

// Not thread-safe: scores are added in candidate order.
class DynamicThreshold {
 public:
  explicit DynamicThreshold(const DynamicThresholdOptions& options);

  // The threshold in force for the next candidate.
  double Current() const;
  // Variance of the last k scores, zero until k scores exist.
  double Variance() const;
  void AddScore(double temporal_score);

 private:
  const DynamicThresholdOptions options_;
  ScoreWindow scores_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_DYNAMIC_THRESHOLD_H_
