// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/beam_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr size_t kMinIntervals = 20;
constexpr size_t kMaxIntervals = 200;
// Between the first and the last beam of a scan, radians: less than half of it, or a
// cell at two metres, is not asked about.
constexpr double kLeastDistortion = 0.05;

}  // namespace

constexpr double BeamTimes::kMinEvidence;
constexpr double BeamTimes::kSignificance;
constexpr int BeamTimes::kNumOrders;

void BeamTimes::AddScan(const std::vector<Eigen::Vector2f>& returns,
                        const double interval) {
  if (interval > 0. && intervals_.size() < kMaxIntervals) {
    intervals_.push_back(interval);
    if (intervals_.size() >= kMinIntervals) period_ = UpperMedian(intervals_);
  }
  if (returns.empty()) return;
  double bearing = 0., low = 0., high = 0.;
  for (size_t i = 0; i < returns.size(); ++i) {
    const double wrapped = std::atan2(returns[i].y(), returns[i].x());
    if (i == 0) {
      bearing = low = high = wrapped;
    } else {
      bearing += NormalizeAngle(wrapped - bearing);
      low = std::min(low, bearing);
      high = std::max(high, bearing);
    }
  }
  if (has_bearings_) {
    // One that begins behind the robot or beside it begins at pi or more.
    const double middle = 0.5 * (first_bearing_ + last_bearing_);
    const double turns =
        2. * kPi * std::round((0.5 * (low + high) - middle) / (2. * kPi));
    low = std::min(low - turns, first_bearing_);
    high = std::max(high - turns, last_bearing_);
  }
  has_bearings_ = true;
  first_bearing_ = low;
  last_bearing_ = high;
}

double BeamTimes::Sweep() const {
  return period_ * std::min(1., (last_bearing_ - first_bearing_) / (2. * kPi));
}

std::vector<BeamOrder> BeamTimes::Candidates(const double turn) const {
  std::vector<BeamOrder> candidates;
  if (!(period_ > 0.) ||
      std::abs(turn) * Sweep() / period_ < kLeastDistortion) {
    return candidates;
  }
  for (const BeamOrder order :
       {BeamOrder::kAtOnce, BeamOrder::kCounterclockwise,
        BeamOrder::kClockwise}) {
    const Evidence& evidence = evidence_[static_cast<size_t>(order)];
    const bool is_refuted =
        evidence.sum < -kMinEvidence &&
        evidence.sum < -kSignificance * std::sqrt(evidence.squares);
    if (order != order_ && !is_refuted) candidates.push_back(order);
  }
  return candidates;
}

void BeamTimes::AddEvidence(const BeamOrder candidate, const double gain) {
  if (!std::isfinite(gain)) return;
  const double clipped = std::max(-kMinEvidence, std::min(gain, kMinEvidence));
  Evidence& evidence = evidence_[static_cast<size_t>(candidate)];
  evidence.sum += clipped;
  evidence.squares += clipped * clipped;
  if (evidence.sum > kMinEvidence &&
      evidence.sum > kSignificance * std::sqrt(evidence.squares)) {
    order_ = candidate;
    evidence_.fill(Evidence());
  }
}

std::vector<float> BeamTimes::Times(
    const BeamOrder order, const std::vector<Eigen::Vector2f>& returns) const {
  std::vector<float> times(returns.size(), 0.f);
  if (order == BeamOrder::kAtOnce) return times;
  const double per_radian =
      period_ / (2. * kPi) * (order == BeamOrder::kCounterclockwise ? 1. : -1.);
  const double middle = 0.5 * (first_bearing_ + last_bearing_);
  for (size_t i = 0; i < returns.size(); ++i) {
    const double bearing = std::atan2(returns[i].y(), returns[i].x());
    times[i] =
        static_cast<float>(per_radian * NormalizeAngle(bearing - middle));
  }
  return times;
}

}  // namespace front_end
}  // namespace cartographer_ext
