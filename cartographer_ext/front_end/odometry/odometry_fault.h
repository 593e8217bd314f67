// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What is to be expected of a fault of odometry, and of the places that a scan
// matcher finds instead.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_FAULT_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_FAULT_H_

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// Poses that differ by less are one place.
constexpr double kSamePlaceDistance = 0.25;  // metres
constexpr double kSamePlaceAngle = 0.2;      // radians

// Whether two scans with this motion of the robot between them see the same.
// What is found instead of a pose by odometry can be followed through them.
bool SeeTheSame(const Pose2& motion);

// Whether two poses are near enough for being of one place, where the second
// one was predicted from the scan before.
bool IsOnePlace(const Pose2& found, const Pose2& expected);

// Minus the logarithm of the prior density of a fault of odometry over `motion`,
// relative to that of no error: Cauchy in three dimensions, of the size of the
// motion, which the fault has where wheels slip, and 5 cm and 0.05 rad.
double FaultCost(const Pose2& error, const Pose2& motion);

// The pose on the other side of `b` from `a`, as far from it, but at least as far
// as two places (20 cm or 0.1 rad). A scan that fits there as well
// as at `b`, as along a corridor, is no evidence for `b`.
Pose2 Beyond(const Pose2& a, const Pose2& b);

// Logarithm of the number of places that a scan tells apart in a window with
// these half widths, metres and radians. The best of them exceeds one place by
// about that by chance.
double LogPlaces(double linear, double angular);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_FAULT_H_
