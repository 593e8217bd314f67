// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/drive.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kMaxDuration = 4. * 3600.;  // seconds
// Corners sharper than this are turned in place.
constexpr double kTurnInPlace = 100. * kPi / 180.;
// A leg begins with a turn in place if its direction differs from the heading
// by more than this.
constexpr double kAligned = 20. * kPi / 180.;
// Distances and angles at which a target counts as reached.
constexpr double kReached = 0.01;
constexpr double kReachedAngle = 1e-3;
// The profiles sqrt(2 a d) brake with a reserve, for they are followed in
// steps.
constexpr double kBrakeReserve = 0.9;
// Corners looked ahead at when choosing the speed.
constexpr size_t kMaxCorners = 100;

double Limited(const double value, const double limit) {
  return std::max(-limit, std::min(limit, value));
}

// The state `time` seconds into a step that begins with `state`.
MotionState Advance(const MotionState& state, const double time) {
  // Five-point Gauss-Legendre nodes and weights on [0, 1].
  static const double kNodes[] = {
      0.5, 0.5 - 0.26923465505284155, 0.5 + 0.26923465505284155,
      0.5 - 0.45308992296933200, 0.5 + 0.45308992296933200};
  static const double kWeights[] = {0.28444444444444444, 0.23931433524968324,
                                    0.23931433524968324, 0.11846344252809454,
                                    0.11846344252809454};
  MotionState next = state;
  next.speed = state.speed + state.acceleration * time;
  next.turn_rate = state.turn_rate + state.turn_acceleration * time;
  next.distance = state.distance + state.speed * time +
                  0.5 * state.acceleration * time * time;
  next.heading = state.heading + state.turn_rate * time +
                 0.5 * state.turn_acceleration * time * time;
  double dx = 0., dy = 0.;
  for (int i = 0; i != 5; ++i) {
    const double u = kNodes[i] * time;
    const double speed = state.speed + state.acceleration * u;
    const double heading = state.heading + state.turn_rate * u +
                           0.5 * state.turn_acceleration * u * u;
    dx += kWeights[i] * speed * std::cos(heading);
    dy += kWeights[i] * speed * std::sin(heading);
  }
  next.pose.x = state.pose.x + time * dx;
  next.pose.y = state.pose.y + time * dy;
  next.pose.theta = NormalizeAngle(std::remainder(next.heading, 2. * kPi));
  return next;
}

// A run of waypoints that is driven in one direction without a stop.
struct Leg {
  std::vector<Eigen::Vector2d> points;  // starts at the robot
  std::vector<double> speeds;           // of the path to point i; [0] unused
  bool backwards = false;
};

double CornerAngle(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& c) {
  const Eigen::Vector2d in = b - a, out = c - b;
  return std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out)));
}

class Driver {
 public:
  Driver(const RobotSettings& robot, const Pose2& start) : robot_(robot) {
    state_.pose = start;
    state_.heading = start.theta;
  }

  bool Wait(const double seconds) {
    const int64_t steps = std::llround(seconds / kDriveStep);
    for (int64_t i = 0; i < steps; ++i) {
      if (!Step(0., 0.)) return false;
    }
    return true;
  }

  // Turns in place by `angle` radians.
  bool Turn(const double angle) {
    if (robot_.turn_radius > 0. && std::abs(angle) >= kReachedAngle) {
      must_turn_in_place_ = true;
      return false;
    }
    const double target = state_.heading + angle;
    while (true) {
      const double left = target - state_.heading;
      if (std::abs(left) < kReachedAngle &&
          std::abs(state_.turn_rate) <= robot_.turn_acceleration * kDriveStep) {
        break;
      }
      const double braking =
          kBrakeReserve *
          std::sqrt(2. * robot_.turn_acceleration * std::abs(left));
      // The last term keeps strong motors from overshooting in one step.
      const double rate = std::min(
          {robot_.turn_rate, braking, 0.5 * std::abs(left) / kDriveStep});
      if (!Step(0., left > 0. ? rate : -rate)) return false;
    }
    return StandStill();
  }

  bool Follow(const Leg& leg) {
    const Eigen::Vector2d first = leg.points[1] - leg.points[0];
    const double heading =
        std::atan2(first.y(), first.x()) + (leg.backwards ? kPi : 0.);
    const double off = std::remainder(heading - state_.heading, 2. * kPi);
    if (std::abs(off) > kAligned && !Turn(off)) return false;
    for (size_t to = 1; to < leg.points.size();) {
      if (Reached(leg, to)) {
        ++to;
        continue;
      }
      if (!Pursue(leg, to)) return false;
    }
    return StandStill();
  }

  Eigen::Vector2d position() const { return state_.pose.translation(); }
  double heading() const { return state_.heading; }
  double length() const { return length_; }
  // Whether a robot that needs a turning circle was to turn in place.
  bool must_turn_in_place() const { return must_turn_in_place_; }
  std::vector<MotionState> TakeStates() {
    state_.acceleration = state_.turn_acceleration = 0.;
    states_.push_back(state_);
    return std::move(states_);
  }

 private:
  // One step towards the wanted speed and turn rate, within the limits. False
  // when the drive gets too long.
  bool Step(const double speed, const double turn_rate) {
    if (states_.size() * kDriveStep > kMaxDuration) return false;
    state_.acceleration =
        Limited((speed - state_.speed) / kDriveStep, robot_.acceleration);
    state_.turn_acceleration = Limited(
        (turn_rate - state_.turn_rate) / kDriveStep, robot_.turn_acceleration);
    states_.push_back(state_);
    const double before = state_.distance;
    state_ = Advance(state_, kDriveStep);
    length_ += std::abs(state_.distance - before);
    return true;
  }

  bool StandStill() {
    while (state_.speed != 0. || state_.turn_rate != 0.) {
      if (!Step(0., 0.)) return false;
      // The remainder of the division by the step length.
      if (std::abs(state_.speed) < 1e-12) state_.speed = 0.;
      if (std::abs(state_.turn_rate) < 1e-12) state_.turn_rate = 0.;
    }
    return true;
  }

  // A waypoint is passed when the robot is level with it; the last one when it
  // is also nearly standing.
  bool Reached(const Leg& leg, const size_t to) const {
    const Eigen::Vector2d along =
        (leg.points[to] - leg.points[to - 1]).normalized();
    const double left = (leg.points[to] - position()).dot(along);
    if (to + 1 == leg.points.size()) return left < kReached;
    // At a corner, the tracking switches to the next segment halfway round.
    const Eigen::Vector2d onwards =
        (leg.points[to + 1] - leg.points[to]).normalized();
    const Eigen::Vector2d bisector = along + onwards;
    return (leg.points[to] - position()).dot(bisector) < 0.;
  }

  // The point of the path one lookahead ahead of the robot.
  Eigen::Vector2d Carrot(const Leg& leg, size_t to, double lookahead) const {
    Eigen::Vector2d from = leg.points[to - 1];
    const Eigen::Vector2d along = (leg.points[to] - from).normalized();
    from += (position() - from).dot(along) * along;  // the robot's foot point
    while (true) {
      const Eigen::Vector2d rest = leg.points[to] - from;
      const double length = rest.norm();
      if (length >= lookahead &&
          rest.dot(leg.points[to] - leg.points[to - 1]) > 0.) {
        return from + lookahead / length * rest;
      }
      if (to + 1 == leg.points.size()) {
        // The last segment is extended beyond its end, so that the target point
        // stays ahead.
        const Eigen::Vector2d last =
            (leg.points[to] - leg.points[to - 1]).normalized();
        return leg.points[to] +
               (lookahead - std::min(length, lookahead)) * last;
      }
      if (rest.dot(leg.points[to] - leg.points[to - 1]) > 0.) {
        lookahead -= length;
      }
      from = leg.points[to];
      ++to;
    }
  }

  // The highest speed that every corner ahead and the end allow.
  double SpeedLimit(const Leg& leg, const size_t to) const {
    double limit = leg.speeds[to];
    const double horizon =
        robot_.lookahead + limit * limit / (2. * robot_.acceleration);
    double distance = (leg.points[to] - position()).norm();
    for (size_t i = to; distance <= horizon + 1. && i < to + kMaxCorners; ++i) {
      double allowed = 0.;
      double at = distance;
      if (i + 1 < leg.points.size()) {
        // The follower's arc begins one lookahead before the corner, with a
        // radius of about lookahead / tan(angle / 2).
        const double angle =
            CornerAngle(leg.points[i - 1], leg.points[i], leg.points[i + 1]);
        const double radius =
            robot_.lookahead / std::max(1e-3, 2. * std::sin(0.5 * angle));
        allowed = std::min(leg.speeds[i + 1], 0.7 * robot_.turn_rate * radius);
        at = std::max(0., distance - robot_.lookahead);
      }
      const double reachable = std::sqrt(
          allowed * allowed + 2. * kBrakeReserve * robot_.acceleration * at);
      limit = std::min(limit, reachable);
      if (i + 1 >= leg.points.size()) break;
      distance += (leg.points[i + 1] - leg.points[i]).norm();
    }
    return std::max(limit, 0.02);  // creep, so that every target is reached
  }

  bool Pursue(const Leg& leg, const size_t to) {
    const Eigen::Vector2d aim = Carrot(leg, to, robot_.lookahead) - position();
    const double direction =
        std::atan2(aim.y(), aim.x()) + (leg.backwards ? kPi : 0.);
    const double off = std::remainder(direction - state_.heading, 2. * kPi);
    double speed = SpeedLimit(leg, to);
    double curvature = 2. * std::sin(off) / std::max(0.1, aim.norm());
    if (robot_.turn_radius > 0.) {
      curvature = Limited(curvature, 1. / robot_.turn_radius);
    }
    if (std::abs(curvature) * speed > robot_.turn_rate) {
      speed = std::max(0.02, robot_.turn_rate / std::abs(curvature));
    }
    // In reverse, the turn brings the robot's rear to the target.
    const double turn = Limited(
        curvature * std::max(std::abs(state_.speed), .02), robot_.turn_rate);
    return Step(leg.backwards ? -speed : speed, turn);
  }

  const RobotSettings robot_;
  MotionState state_;
  std::vector<MotionState> states_;
  double length_ = 0.;
  bool must_turn_in_place_ = false;
};

}  // namespace

absl::StatusOr<Drive> Drive::Plan(const World& world, const uint64_t seed) {
  Driver driver(world.robot, world.start);
  Random random = MakeRandom(seed, RandomStream::kDrive);
  const auto target = [&world, &random](const DriveCommand& command) {
    const double range = world.robot.jitter;
    const double dx = random.Uniform(-range, range);
    const double dy = random.Uniform(-range, range);
    return Eigen::Vector2d(command.target + Eigen::Vector2d(dx, dy));
  };
  using Kind = DriveCommand::Kind;
  for (size_t i = 0; i < world.drive.size();) {
    const DriveCommand& command = world.drive[i];
    bool reached = true;
    if (command.kind == Kind::kWait) {
      reached = driver.Wait(command.seconds);
      ++i;
    } else if (command.kind == Kind::kTurn) {
      reached = driver.Turn(
          std::remainder(command.heading - driver.heading(), 2. * kPi));
      ++i;
    } else {
      // All following waypoints of the same kind, up to a hairpin.
      Leg leg;
      leg.backwards = command.kind == Kind::kReverse;
      leg.points.push_back(driver.position());
      leg.speeds.push_back(0.);
      for (; i < world.drive.size() && world.drive[i].kind == command.kind;
           ++i) {
        const Eigen::Vector2d point = target(world.drive[i]);
        if ((point - leg.points.back()).norm() < 2. * kReached) continue;
        const size_t size = leg.points.size();
        if (size >= 2 && CornerAngle(leg.points[size - 2], leg.points.back(),
                                     point) > kTurnInPlace) {
          reached = reached && driver.Follow(leg);
          leg.points = {driver.position()};
          leg.speeds = {0.};
        }
        leg.points.push_back(point);
        leg.speeds.push_back(world.drive[i].speed > 0. ? world.drive[i].speed
                                                       : world.robot.speed);
      }
      if (leg.points.size() >= 2) reached = reached && driver.Follow(leg);
    }
    if (driver.must_turn_in_place()) {
      return absl::InvalidArgumentError(
          absl::StrCat(command.where,
                       ": the drive needs a turn in place, and the robot has "
                       "a turning radius of ",
                       world.robot.turn_radius, " m"));
    }
    if (!reached) {
      return absl::InvalidArgumentError(absl::StrCat(
          command.where, ": the drive does not arrive here within ",
          kMaxDuration, " s; the robot is at (", driver.position().x(), ", ",
          driver.position().y(), ")"));
    }
  }
  Drive drive;
  drive.length_ = driver.length();
  drive.states_ = driver.TakeStates();
  return drive;
}

double Drive::duration() const { return (states_.size() - 1) * kDriveStep; }

MotionState Drive::At(const double time) const {
  if (time <= 0.) {
    MotionState state = states_.front();
    state.acceleration = state.turn_acceleration = 0.;
    return state;
  }
  // Rounding may assign a time at the border of two steps to either one; both
  // give the same pose.
  const double index = std::floor(time / kDriveStep);
  if (index >= static_cast<double>(states_.size() - 1)) return states_.back();
  const size_t step = static_cast<size_t>(index);
  return Advance(states_[step], std::max(0., time - step * kDriveStep));
}

}  // namespace simulation
}  // namespace cartographer_ext
