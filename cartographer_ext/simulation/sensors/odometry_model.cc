// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/odometry_model.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/simulation/seeds.h"
#include "cartographer_ext/simulation/sensors/wheel.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Kind = OdometryFault::Kind;

bool InWindow(const OdometryFault& fault, const double time) {
  const bool for_ever =
      fault.duration == 0. && (fault.in_place || fault.kind == Kind::kReverse ||
                               fault.kind == Kind::kOffset);
  return time >= fault.start &&
         (for_ever || time < fault.start + fault.duration);
}

class Odometer {
 public:
  Odometer(const World& world, const Drive& drive,
           const std::vector<OdometryFault>& faults, const uint64_t seed)
      : settings_(world.odometry),
        drive_(drive),
        faults_(faults),
        begin_(world.begin),
        noise_(MakeRandom(seed, RandomStream::kOdometryNoise)),
        lateral_(MakeRandom(seed, RandomStream::kOdometryLateral)),
        left_(0., 0., 0.),
        right_(0., 0., 0.),
        open_(faults.size()),
        jumped_(faults.size(), false) {
    Random scales = MakeRandom(seed, RandomStream::kOdometryScales);
    const double common = settings_.scale_sigma * scales.Normal();
    const double mismatch = settings_.mismatch_sigma * scales.Normal();
    run_.scale_left = settings_.scale_left + common - 0.5 * mismatch;
    run_.scale_right = settings_.scale_right + common + 0.5 * mismatch;
    run_.believed_wheel_base =
        settings_.wheel_base * (1. + settings_.wheel_base_error +
                                settings_.wheel_base_sigma * scales.Normal());
    left_ = Wheel(run_.scale_left, settings_.noise, settings_.ticks_per_meter);
    right_ =
        Wheel(run_.scale_right, settings_.noise, settings_.ticks_per_meter);
  }

  OdometryRun Run() {
    if (!settings_.present) return std::move(run_);
    for (int64_t i = 0;; ++i) {
      const double stamp = settings_.phase + i / settings_.rate;
      if (stamp > drive_.duration() + 1e-9) break;
      Message(stamp);
    }
    for (size_t i = 0; i != faults_.size(); ++i) Close(i);
    std::sort(run_.labels.begin(), run_.labels.end(),
              [](const FaultLabel& a, const FaultLabel& b) {
                return a.start < b.start;
              });
    return std::move(run_);
  }

 private:
  struct OpenLabel {
    bool open = false;
    FaultLabel label;
  };

  void Mark(const size_t fault, const double from, const double to,
            const double distance, const double angle) {
    OpenLabel& open = open_[fault];
    // Marks less than half a second apart belong to one event.
    if (open.open && begin_ + from > open.label.end + 0.5) Close(fault);
    if (!open.open) {
      open.open = true;
      open.label = FaultLabel();
      open.label.kind = faults_[fault].kind;
      open.label.start = begin_ + from;
    }
    open.label.end = begin_ + to;
    open.label.distance += distance;
    open.label.angle += angle;
  }

  void Close(const size_t fault) {
    if (open_[fault].open) run_.labels.push_back(open_[fault].label);
    open_[fault].open = false;
  }

  // The time of the wheel readings in a message stamped `stamp`.
  double MeasuringTime(const double stamp) {
    double time = stamp;
    for (size_t i = 0; i != faults_.size(); ++i) {
      const OdometryFault& fault = faults_[i];
      if (fault.kind != Kind::kOffset || !InWindow(fault, stamp)) continue;
      time += fault.seconds;
      Mark(i, last_stamp_, stamp, 0., 0.);
    }
    return std::max(time, measured_until_);
  }

  void Integrate(const double from, const double to, const double stamp) {
    const MotionState before = drive_.At(from), after = drive_.At(to);
    const double distance = after.distance - before.distance;
    const double turn = after.heading - before.heading;
    const double half_base = 0.5 * settings_.wheel_base;
    const double left = distance - half_base * turn;
    const double right = distance + half_base * turn;
    double slip_left = 0., slip_right = 0.;
    for (size_t i = 0; i != faults_.size(); ++i) {
      const OdometryFault& fault = faults_[i];
      if (fault.kind != Kind::kSlip || !InWindow(fault, from)) continue;
      if (fault.in_place &&
          (after.pose.translation() - fault.center).norm() > fault.radius) {
        continue;
      }
      const double extra_left =
          fault.gain_left * left + fault.spin_left * (to - from);
      const double extra_right =
          fault.gain_right * right + fault.spin_right * (to - from);
      slip_left += extra_left;
      slip_right += extra_right;
      if (extra_left == 0. && extra_right == 0.) continue;
      Mark(i, last_stamp_, stamp, 0.5 * (extra_left + extra_right),
           (extra_right - extra_left) / settings_.wheel_base);
    }
    const double counted_left = left_.Advance(left, slip_left, &noise_);
    const double counted_right = right_.Advance(right, slip_right, &noise_);
    double counted = 0.5 * (counted_left + counted_right);
    for (size_t i = 0; i != faults_.size(); ++i) {
      if (faults_[i].kind == Kind::kReverse && distance < 0. && counted < 0. &&
          InWindow(faults_[i], from)) {
        Mark(i, last_stamp_, stamp, -2. * counted, 0.);
        counted = -counted;
        break;
      }
    }
    pose_ = pose_ * ArcPose(counted, (counted_right - counted_left) /
                                         run_.believed_wheel_base);
    if (settings_.lateral_noise > 0.) {
      const double sigma =
          settings_.lateral_noise * std::sqrt(std::abs(distance));
      pose_ = pose_ * Pose2(0., sigma * lateral_.Normal(), 0.);
    }
  }

  void Message(const double stamp) {
    const double until = MeasuringTime(stamp);
    const double span = until - measured_until_;
    const int steps = std::max(
        1, static_cast<int>(std::ceil(span * settings_.encoder_rate - 1e-6)));
    for (int i = 0; i != steps && span > 0.; ++i) {
      Integrate(measured_until_ + span * i / steps,
                measured_until_ + span * (i + 1) / steps, stamp);
    }
    measured_until_ = until;
    Pose2 reported = pose_;
    for (size_t i = 0; i != faults_.size(); ++i) {
      const OdometryFault& fault = faults_[i];
      if (fault.kind == Kind::kJump && stamp >= fault.start && !jumped_[i]) {
        jumped_[i] = true;
        Mark(i, last_stamp_, stamp, fault.distance, fault.angle);
        pose_ = reported = pose_ * Pose2(fault.distance, 0., fault.angle);
      }
    }
    for (size_t i = 0; i != faults_.size(); ++i) {
      if (faults_[i].kind != Kind::kStale) continue;
      if (InWindow(faults_[i], stamp) && !run_.readings.empty()) {
        reported = run_.readings.back().pose;
        Mark(i, last_stamp_, stamp, 0., 0.);
      } else if (open_[i].open) {
        // The first fresh message brings the jump.
        const Pose2 jump = Between(run_.readings.back().pose, reported);
        Mark(i, last_stamp_, stamp, jump.translation().norm(), jump.theta);
        Close(i);
      }
    }
    io::OdometryReading reading;
    reading.time = io::FromSeconds(begin_ + stamp);
    reading.pose = reported;
    run_.readings.push_back(reading);
    last_stamp_ = stamp;
  }

  const OdometrySettings settings_;
  const Drive& drive_;
  const std::vector<OdometryFault>& faults_;
  const double begin_;
  Random noise_;
  Random lateral_;
  Wheel left_;
  Wheel right_;
  OdometryRun run_;
  Pose2 pose_;  // (odometry <- robot)
  double measured_until_ = 0.;
  double last_stamp_ = 0.;
  std::vector<OpenLabel> open_;
  std::vector<bool> jumped_;
};

}  // namespace

OdometryRun SimulateOdometry(const World& world, const Drive& drive,
                             const std::vector<OdometryFault>& faults,
                             const uint64_t seed) {
  return Odometer(world, drive, faults, seed).Run();
}

const char* FaultName(const OdometryFault::Kind kind) {
  switch (kind) {
    case Kind::kSlip:
      return "slip";
    case Kind::kStale:
      return "stale";
    case Kind::kJump:
      return "jump";
    case Kind::kReverse:
      return "reverse";
    case Kind::kOffset:
      return "offset";
  }
  return "";
}

}  // namespace simulation
}  // namespace cartographer_ext
