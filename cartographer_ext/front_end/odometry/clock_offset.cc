// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/clock_offset.h"

#include <cstddef>
#include <vector>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Longer intervals are not used, seconds.
constexpr double kMaxInterval = 1.;
// Turns waiting for later readings.
constexpr size_t kMaxPending = 20;

}  // namespace

ClockOffset::ClockOffset(const TimeOffsetOptions& options)
    : estimator_(options) {}

void ClockOffset::AddMatch(const double from, const double to,
                           const double turn, const OdometryBuffer& buffer) {
  if (estimator_.candidates().empty() || !(to > from) ||
      to - from > kMaxInterval) {
    return;
  }
  pending_.push_back({from, to, turn});
  while (!pending_.empty()) {
    const MatchedTurn& oldest = pending_.front();
    const bool is_covered =
        !buffer.empty() &&
        buffer.last_time() >= oldest.to - estimator_.candidates().front() &&
        buffer.first_time() <= oldest.from - estimator_.candidates().back();
    if (is_covered) {
      Learn(oldest, buffer);
    } else if (pending_.size() <= kMaxPending) {
      return;
    }
    pending_.pop_front();
  }
}

void ClockOffset::Learn(const MatchedTurn& matched,
                        const OdometryBuffer& buffer) {
  std::vector<double> turns;
  turns.reserve(estimator_.candidates().size());
  for (const double offset : estimator_.candidates()) {
    OdometrySample begin, end;
    buffer.Lookup(matched.from - offset, &begin);
    buffer.Lookup(matched.to - offset, &end);
    turns.push_back(NormalizeAngle(end.pose.theta - begin.pose.theta));
  }
  estimator_.Add(matched.turn, turns);
}

}  // namespace front_end
}  // namespace cartographer_ext
