// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_buffer.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cartographer_ext/common/order_statistics.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A velocity is taken over at least this long, seconds, ...
constexpr double kVelocitySpan = 0.05;
// ... and from readings not further apart than this.
constexpr double kMaxVelocitySpan = 0.7;
// Readings that the median interval is computed from.
constexpr size_t kUsualReadings = 10;

bool IsSame(const Pose2& a, const Pose2& b) {
  return a.x == b.x && a.y == b.y && a.theta == b.theta;
}

}  // namespace

OdometryBuffer::OdometryBuffer(const double seconds, const size_t max_readings,
                               const double max_extrapolation)
    : seconds_(seconds),
      max_readings_(max_readings),
      max_extrapolation_(max_extrapolation) {}

bool OdometryBuffer::Add(const double time, const Pose2& pose) {
  if (!std::isfinite(time) || !std::isfinite(pose.x) ||
      !std::isfinite(pose.y) || !std::isfinite(pose.theta)) {
    return false;
  }
  if (!readings_.empty() && time <= readings_.back().time) return false;
  has_moved_ = has_moved_ ||
               (!readings_.empty() && !IsSame(readings_.back().pose, pose));
  readings_.push_back({time, pose});
  // The reading before the span stays, so that all of it can be interpolated.
  while (readings_.size() > 2 && readings_[1].time < time - seconds_) {
    readings_.pop_front();
  }
  if (readings_.size() > max_readings_) Thin();
  return true;
}

void OdometryBuffer::Thin() {
  // Of the older half every second one, the first included.
  const size_t half = readings_.size() / 2;
  std::deque<Reading> thinned;
  for (size_t i = 0; i != readings_.size(); ++i) {
    if (i >= half || i % 2 == 0) thinned.push_back(readings_[i]);
  }
  readings_.swap(thinned);
}

Pose2 OdometryBuffer::Extrapolate(const double seconds) const {
  const Reading& last = readings_.back();
  if (readings_.size() < 2) return last.pose;
  size_t i = readings_.size() - 2;
  while (i > 0 && last.time - readings_[i].time < kVelocitySpan) --i;
  const double span = last.time - readings_[i].time;
  if (span > kMaxVelocitySpan) return last.pose;
  const double ratio =
      std::min(seconds, std::max(max_extrapolation_, span)) / span;
  const Pose2 motion = Between(readings_[i].pose, last.pose);
  return last.pose *
         Pose2(motion.x * ratio, motion.y * ratio, motion.theta * ratio);
}

double OdometryBuffer::MedianInterval() const {
  std::vector<double> intervals;
  for (size_t i = readings_.size();
       i > 1 && intervals.size() + 1 < kUsualReadings; --i) {
    intervals.push_back(readings_[i - 1].time - readings_[i - 2].time);
  }
  return intervals.empty() ? 0. : UpperMedian(std::move(intervals));
}

std::deque<OdometryBuffer::Reading>::const_iterator OdometryBuffer::FirstAfter(
    const double time) const {
  return std::upper_bound(
      readings_.begin(), readings_.end(), time,
      [](const double t, const Reading& reading) { return t < reading.time; });
}

bool OdometryBuffer::HasJump(const double from, const double to,
                             const OdometryJump& jump) const {
  for (auto after = FirstAfter(from); after != readings_.end(); ++after) {
    if (after == readings_.begin()) continue;
    const auto before = after - 1;
    if (before->time >= to) break;
    const double seconds = after->time - before->time;
    const Pose2 motion = Between(before->pose, after->pose);
    const double distance = std::hypot(motion.x, motion.y);
    const double angle = std::abs(motion.theta);
    if ((distance >= jump.distance && distance > jump.speed * seconds) ||
        (angle >= jump.angle && angle > jump.turn_rate * seconds)) {
      return true;
    }
  }
  return false;
}

std::vector<Pose2> OdometryBuffer::Steps(const double from,
                                         const double to) const {
  std::vector<Pose2> steps;
  OdometrySample last, end;
  if (!Lookup(from, &last) || !Lookup(to, &end)) return steps;
  for (auto next = FirstAfter(from); next != readings_.end() && next->time < to;
       ++next) {
    steps.push_back(Between(last.pose, next->pose));
    last.pose = next->pose;
  }
  steps.push_back(Between(last.pose, end.pose));
  return steps;
}

bool OdometryBuffer::Lookup(const double time,
                            OdometrySample* const sample) const {
  if (readings_.empty()) return false;
  *sample = OdometrySample();
  if (time <= readings_.front().time) {
    sample->pose = readings_.front().pose;
    sample->extrapolated = readings_.front().time - time;
    return true;
  }
  if (time >= readings_.back().time) {
    sample->extrapolated = time - readings_.back().time;
    sample->pose = Extrapolate(sample->extrapolated);
    sample->frozen =
        readings_.size() > 1 &&
        IsSame(readings_[readings_.size() - 2].pose, readings_.back().pose);
    return true;
  }
  const auto after = FirstAfter(time);
  const auto before = after - 1;
  sample->pose =
      Interpolate(before->pose, after->pose,
                  (time - before->time) / (after->time - before->time));
  sample->frozen = IsSame(before->pose, after->pose);
  return true;
}

}  // namespace front_end
}  // namespace cartographer_ext
