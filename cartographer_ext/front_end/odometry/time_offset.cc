// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/time_offset.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

TimeOffsetEstimator::TimeOffsetEstimator(const TimeOffsetOptions& options)
    : options_(options), offset_(options.initial) {
  if (!options.estimate || !(options.step > 0.)) return;
  const int count = static_cast<int>(
      std::floor((options.maximum - options.minimum) / options.step + 1e-9));
  for (int i = 0; i <= count; ++i) {
    candidates_.push_back(options.minimum + i * options.step);
  }
  if (candidates_.size() < 3) candidates_.clear();
  sums_.assign(candidates_.size(), 0.);
}

void TimeOffsetEstimator::Add(const double matched_turn,
                              const std::vector<double>& odometry_turns) {
  if (candidates_.empty() || odometry_turns.size() != candidates_.size() ||
      !std::isfinite(matched_turn)) {
    return;
  }
  const auto bounds =
      std::minmax_element(odometry_turns.begin(), odometry_turns.end());
  if (!(*bounds.second - *bounds.first >= options_.min_spread)) return;
  // Odometry must be able to explain the match at some offset.
  if (matched_turn < *bounds.first - options_.clip ||
      matched_turn > *bounds.second + options_.clip) {
    return;
  }
  for (size_t i = 0; i < sums_.size(); ++i) {
    const double error =
        std::min(options_.clip,
                 std::abs(NormalizeAngle(matched_turn - odometry_turns[i])));
    sums_[i] = options_.forgetting * sums_[i] + error * error;
  }
  weight_ = options_.forgetting * weight_ + 1.;
  if (weight_ >= options_.min_weight) Update();
}

void TimeOffsetEstimator::Update() {
  const auto best = std::min_element(sums_.begin(), sums_.end());
  const size_t index = static_cast<size_t>(best - sums_.begin());
  double estimate = candidates_[index];
  if (index > 0 && index + 1 < sums_.size()) {
    const double before = sums_[index - 1], after = sums_[index + 1];
    const double curvature = before - 2. * *best + after;
    if (curvature > 0.) {
      estimate += options_.step * 0.5 * (before - after) / curvature;
    }
  }
  // The sum at the value in force, between the candidates around it.
  const double place =
      std::min(std::max((offset_ - options_.minimum) / options_.step, 0.),
               static_cast<double>(sums_.size() - 1));
  const size_t low = std::min(static_cast<size_t>(place), sums_.size() - 2);
  const double ratio = place - static_cast<double>(low);
  const double current = (1. - ratio) * sums_[low] + ratio * sums_[low + 1];
  // How much likelier it is, for errors of unknown variance: n / 2 times the
  // logarithm of the ratio of the sums.
  if (*best > 0. &&
      0.5 * weight_ * std::log(current / *best) <= options_.evidence) {
    return;
  }
  offset_ = estimate;
}

}  // namespace front_end
}  // namespace cartographer_ext
