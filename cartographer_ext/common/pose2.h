// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Planar rigid transforms for code that needs no host. A Pose2 written
// (a <- b) maps points of frame b into frame a:  p_a = R(theta) p_b + (x, y).
#ifndef CARTOGRAPHER_EXT_COMMON_POSE2_H_
#define CARTOGRAPHER_EXT_COMMON_POSE2_H_

#include <cmath>

#include "Eigen/Core"

namespace cartographer_ext {

constexpr double kPi = 3.14159265358979323846;

// Wraps an angle in radians to [-pi, pi].
inline double NormalizeAngle(double angle) {
  if (angle >= -kPi && angle <= kPi) return angle;
  return std::remainder(angle, 2. * kPi);
}

// Degrees to radians.
inline double DegToRad(double degrees) { return degrees * kPi / 180.; }
// Radians to degrees.
inline double RadToDeg(double radians) { return radians * 180. / kPi; }

// A planar rigid transform: rotation by theta, then translation by (x, y).
struct Pose2 {
  double x = 0.;      // metres
  double y = 0.;      // metres
  double theta = 0.;  // radians

  Pose2() = default;
  Pose2(double x_in, double y_in, double theta_in)
      : x(x_in), y(y_in), theta(theta_in) {}

  Eigen::Vector2d translation() const { return Eigen::Vector2d(x, y); }

  // (a <- b) from (b <- a).
  Pose2 Inverse() const {
    const double c = std::cos(theta), s = std::sin(theta);
    return Pose2(-c * x - s * y, s * x - c * y, -theta);
  }
};

// (a <- c) = (a <- b) * (b <- c); the angle is wrapped.
inline Pose2 operator*(const Pose2& lhs, const Pose2& rhs) {
  const double c = std::cos(lhs.theta), s = std::sin(lhs.theta);
  return Pose2(lhs.x + c * rhs.x - s * rhs.y, lhs.y + s * rhs.x + c * rhs.y,
               NormalizeAngle(lhs.theta + rhs.theta));
}

inline Eigen::Vector2d operator*(const Pose2& pose, const Eigen::Vector2d& p) {
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  return Eigen::Vector2d(pose.x + c * p.x() - s * p.y(),
                         pose.y + s * p.x() + c * p.y());
}

// Pose of b seen from a: a^-1 * b.
inline Pose2 Between(const Pose2& a, const Pose2& b) { return a.Inverse() * b; }

// Linear in translation, and in the smaller rotation between the angles;
// `ratio` 0 gives a, 1 gives b.
inline Pose2 Interpolate(const Pose2& a, const Pose2& b, double ratio) {
  return Pose2(
      a.x + ratio * (b.x - a.x), a.y + ratio * (b.y - a.y),
      NormalizeAngle(a.theta + ratio * NormalizeAngle(b.theta - a.theta)));
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_POSE2_H_
