// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/insertion_count.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace front_end {
namespace {

// Rotation between scans at 5 Hz and half a radian a second.
constexpr double kRotationSpacing = 0.1;
constexpr double kMostInsertions = 10.;

}  // namespace

int InsertionCount(const Pose2& motion, const double spacing) {
  const double by_translation =
      spacing > 0. ? std::hypot(motion.x, motion.y) / spacing : 0.;
  const double by_rotation =
      std::abs(NormalizeAngle(motion.theta)) / kRotationSpacing;
  const double count = std::max(by_translation, by_rotation);
  // The comparison is written so that NaN counts once.
  return count > 1. ? static_cast<int>(std::min(kMostInsertions, count)) : 1;
}

}  // namespace front_end
}  // namespace cartographer_ext
