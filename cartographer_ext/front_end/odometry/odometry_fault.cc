// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_fault.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace front_end {
namespace {

// A scan tells places apart that are this far from each other.
constexpr double kPlaceDistance = 0.1;  // metres
constexpr double kPlaceAngle = 0.05;    // radians
constexpr double kLeastPlaces = 1e-3;
// Sizes of a fault, without those that grow with the motion.
constexpr double kLeastFaultTranslation = 0.05;  // metres
constexpr double kLeastFaultRotation = 0.05;     // radians
constexpr double kSameViewAngle = 0.4;  // radians, less than half a narrow view

bool IsWithin(const Pose2& motion, const double angle) {
  return motion.translation().norm() < kSamePlaceDistance &&
         std::abs(NormalizeAngle(motion.theta)) < angle;
}

}  // namespace

bool SeeTheSame(const Pose2& motion) {
  return IsWithin(motion, kSameViewAngle);
}

bool IsOnePlace(const Pose2& found, const Pose2& expected) {
  return IsWithin(Between(expected, found), kSamePlaceAngle);
}

double FaultCost(const Pose2& error, const Pose2& motion) {
  const double translation =
      error.translation().norm() /
      (kLeastFaultTranslation + motion.translation().norm());
  const double rotation = NormalizeAngle(error.theta) /
                          (kLeastFaultRotation + std::abs(motion.theta));
  // (1 + q)^-((3 + 1) / 2)
  return 2. * std::log1p(translation * translation + rotation * rotation);
}

Pose2 Beyond(const Pose2& a, const Pose2& b) {
  const Pose2 off = Between(a, b);
  const double places =
      std::max(off.translation().norm() / kPlaceDistance,
               std::abs(NormalizeAngle(off.theta)) / kPlaceAngle);
  if (!(places > kLeastPlaces)) return b;  // no direction
  const double factor = std::max(1., 2. / places);
  return b * Pose2(factor * off.x, factor * off.y, factor * off.theta);
}

double LogPlaces(const double linear, const double angular) {
  const double side = std::max(1., 2. * linear / kPlaceDistance);
  return std::log(side * side * std::max(1., 2. * angular / kPlaceAngle));
}

}  // namespace front_end
}  // namespace cartographer_ext
