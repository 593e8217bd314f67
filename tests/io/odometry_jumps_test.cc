// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/odometry_jumps.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr TimeNs kTenth = 100000000;

TEST(OdometryJumpsTest, WhatARobotDrivesStaysAsItIs) {
  OdometryJumps jumps;
  // Slips of a metre, a pause of a minute in which it was driven 30 m.
  const struct {
    int tenths;
    Pose2 pose;
  } readings[] = {{0, Pose2(1e6, 2e6, 3.)},
                  {1, Pose2(1e6 + 1., 2e6, -3.)},
                  {2, Pose2(1e6 + 9., 2e6, 0.)},
                  {602, Pose2(1e6 + 39., 2e6, 1.)}};
  for (const auto& reading : readings) {
    const Pose2 pose = jumps.Remove(reading.tenths * kTenth, reading.pose);
    EXPECT_EQ(pose.x, reading.pose.x);
    EXPECT_EQ(pose.y, reading.pose.y);
    EXPECT_EQ(pose.theta, reading.pose.theta);
  }
  EXPECT_EQ(jumps.count(), 0);
}

TEST(OdometryJumpsTest, OneBadReadingCostsItsTwoStepsOnly) {
  OdometryJumps jumps;
  double x = 0.;
  for (int i = 0; i < 10; ++i) {
    // 0.1 m a reading.
    Pose2 raw(0.1 * i, 0., 0.);
    if (i == 4) raw = Pose2(600., -3., 2.);
    const Pose2 pose = jumps.Remove(i * kTenth, raw);
    EXPECT_LE(std::abs(pose.x - x), 0.1 + 1e-9) << i;
    EXPECT_NEAR(pose.y, 0., 1e-9);
    EXPECT_NEAR(pose.theta, 0., 1e-9);
    x = pose.x;
  }
  EXPECT_NEAR(x, 0.7, 1e-9);
  EXPECT_EQ(jumps.count(), 2);
  EXPECT_EQ(jumps.first_time(), 4 * kTenth);
  EXPECT_NEAR(jumps.first_distance(), 600., 1.);
}

TEST(OdometryJumpsTest, AResetGoesOnWhereItWas) {
  OdometryJumps jumps;
  jumps.Remove(0, Pose2(50., 20., 0.5));
  jumps.Remove(kTenth, Pose2(50., 20., 0.5));
  // Back at the origin, from where it drives a metre ahead.
  jumps.Remove(2 * kTenth, Pose2(0., 0., 0.));
  const Pose2 pose = jumps.Remove(3 * kTenth, Pose2(1., 0., 0.));
  EXPECT_NEAR(pose.x, 50. + std::cos(0.5), 1e-9);
  EXPECT_NEAR(pose.y, 20. + std::sin(0.5), 1e-9);
  EXPECT_NEAR(pose.theta, 0.5, 1e-9);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
