// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_COMMON_ARC_H_
#define CARTOGRAPHER_EXT_COMMON_ARC_H_

#include <cmath>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {

// (start <- end) of an arc of constant curvature that is `length` metres long
// and turns by `angle` radians.
inline Pose2 ArcPose(const double length, const double angle) {
  const double half = 0.5 * angle;
  const double chord = std::abs(half) < 1e-6 ? length * (1. - half * half / 6.)
                                             : length * std::sin(half) / half;
  return Pose2(chord * std::cos(half), chord * std::sin(half),
               NormalizeAngle(angle));
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_ARC_H_
