// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/time_offset.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// The noise is that of so many scans, and is found anew after so many.
constexpr size_t kMostErrors = 200;
constexpr int kErrorsBetweenUpdates = 20;
constexpr double kSigmaPerMedian = 1.4826;  // of the absolute value, normal

}  // namespace

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
  products_ = Eigen::MatrixXd::Zero(candidates_.size(), candidates_.size());
}

void TimeOffsetEstimator::Add(const double matched_turn,
                              const std::vector<double>& odometry_turns) {
  if (candidates_.empty() || odometry_turns.size() != candidates_.size() ||
      !std::isfinite(matched_turn)) {
    return;
  }
  std::vector<double> errors(candidates_.size());
  for (size_t i = 0; i < errors.size(); ++i) {
    errors[i] = std::abs(NormalizeAngle(matched_turn - odometry_turns[i]));
  }
  AddErrors(errors);
  const auto bounds =
      std::minmax_element(odometry_turns.begin(), odometry_turns.end());
  const double least_spread =
      std::max(options_.min_spread, options_.noise_spread * noise_);
  if (!(*bounds.second - *bounds.first >= least_spread)) return;
  // Odometry must be able to explain the match at some offset.
  if (matched_turn < *bounds.first - options_.clip ||
      matched_turn > *bounds.second + options_.clip) {
    return;
  }
  Eigen::VectorXd squares(sums_.size());
  for (size_t i = 0; i < sums_.size(); ++i) {
    squares[i] = Squared(std::min(options_.clip, errors[i]));
    sums_[i] = options_.forgetting * sums_[i] + squares[i];
  }
  products_ *= Squared(options_.forgetting);
  products_ += squares * squares.transpose();
  weight_ = options_.forgetting * weight_ + 1.;
  if (weight_ >= options_.min_weight) Update();
}

void TimeOffsetEstimator::AddErrors(const std::vector<double>& errors) {
  errors_.push_back(errors);
  if (errors_.size() > kMostErrors) errors_.pop_front();
  if (++num_errors_ % kErrorsBetweenUpdates != 0) return;
  noise_ = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < candidates_.size(); ++i) {
    std::vector<double> of_candidate;
    of_candidate.reserve(errors_.size());
    for (const std::vector<double>& of_scan : errors_) {
      of_candidate.push_back(of_scan[i]);
    }
    noise_ = std::min(noise_,
                      kSigmaPerMedian * UpperMedian(std::move(of_candidate)));
  }
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
  const double gain = Significance(index, offset_);
  if (gain < options_.least_gain ||
      std::max(gain, Significance(index, options_.initial)) <
          options_.significance) {
    return;
  }
  offset_ = estimate;
}

double TimeOffsetEstimator::Significance(const size_t candidate,
                                         const double offset) const {
  // Between the candidates around it.
  const double place =
      std::min(std::max((offset - options_.minimum) / options_.step, 0.),
               static_cast<double>(sums_.size() - 1));
  const size_t low = std::min(static_cast<size_t>(place), sums_.size() - 2);
  const double ratio = place - static_cast<double>(low);
  Eigen::VectorXd worse = Eigen::VectorXd::Zero(sums_.size());
  worse[low] = 1. - ratio;
  worse[low + 1] = ratio;
  worse[candidate] -= 1.;
  const double difference =
      worse.dot(Eigen::Map<const Eigen::VectorXd>(sums_.data(), sums_.size()));
  const double variance = worse.dot(products_ * worse);
  return variance > 0. ? difference / std::sqrt(variance) : 0.;
}

}  // namespace front_end
}  // namespace cartographer_ext
