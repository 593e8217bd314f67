// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/arc.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(ArcTest, IsWhatManySmallStepsAddUpTo) {
  constexpr int kSteps = 20000;
  for (const double length : {-1.5, 0., 0.02, 2.}) {
    for (const double angle : {-3., -1e-7, 0., 1e-5, 0.4, 2.5}) {
      double x = 0., y = 0.;
      for (int i = 0; i != kSteps; ++i) {
        const double heading = angle * (i + 0.5) / kSteps;
        x += length / kSteps * std::cos(heading);
        y += length / kSteps * std::sin(heading);
      }
      const Pose2 pose = ArcPose(length, angle);
      EXPECT_NEAR(pose.x, x, 1e-8) << length << " m, " << angle << " rad";
      EXPECT_NEAR(pose.y, y, 1e-8) << length << " m, " << angle << " rad";
      EXPECT_DOUBLE_EQ(pose.theta, angle);
    }
  }
}

TEST(ArcTest, TwoHalvesAreTheWhole) {
  const Pose2 half = ArcPose(0.7, 1.9), whole = ArcPose(1.4, 3.8);
  const Pose2 twice = half * half;
  EXPECT_NEAR(twice.x, whole.x, 1e-12);
  EXPECT_NEAR(twice.y, whole.y, 1e-12);
  EXPECT_NEAR(NormalizeAngle(twice.theta - whole.theta), 0., 1e-12);
}

}  // namespace
}  // namespace cartographer_ext
