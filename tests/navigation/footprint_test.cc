// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/footprint.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(FootprintTest, ADiscIsRound) {
  const Footprint disc = Footprint::Disc(0.3);
  EXPECT_DOUBLE_EQ(disc.inscribed_radius(), 0.3);
  EXPECT_DOUBLE_EQ(disc.circumscribed_radius(), 0.3);
  const Pose2 pose(1., 2., 0.7);
  EXPECT_NEAR(disc.Distance(pose, {1., 3.}), 0.7, 1e-12);
  EXPECT_NEAR(disc.Distance(pose, {1., 2.}), -0.3, 1e-12);
}

TEST(FootprintTest, DiscsCoverARectangleAndHardlyMore) {
  for (const double half_width : {0.1, 0.25, 0.4}) {
    for (const double front : {0.1, 0.3, 0.9}) {
      const double rear = 0.5 * front + 0.15;
      const Footprint footprint = Footprint::Rectangle(front, rear, half_width);
      for (int i = 0; i <= 100; ++i) {
        const double x = -rear + (front + rear) * i / 100.;
        for (const double y : {-half_width, 0., half_width}) {
          EXPECT_LE(footprint.Distance(Pose2(), {x, y}), 1e-12)
              << x << " " << y << " of " << front << " x " << half_width;
        }
        EXPECT_GT(footprint.Distance(Pose2(), {x, 1.2001 * half_width}), 0.);
      }
      EXPECT_GT(footprint.Distance(Pose2(), {-rear - half_width, 0.}), 0.);
    }
  }
}

TEST(FootprintTest, RadiiBoundTheOutline) {
  const Footprint footprint = Footprint::Rectangle(0.6, 0.2, 0.25);
  for (int i = 0; i != 360; ++i) {
    const double angle = i * kPi / 180.;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    EXPECT_LE(footprint.Distance(
                  Pose2(), 0.999 * footprint.inscribed_radius() * direction),
              0.);
    EXPECT_GE(
        footprint.Distance(
            Pose2(), 1.001 * footprint.circumscribed_radius() * direction),
        0.);
  }
}

TEST(FootprintTest, TurnsWithThePose) {
  const Footprint footprint = Footprint::Rectangle(0.9, 0.1, 0.2);
  const Eigen::Vector2d ahead(0., 0.8);
  EXPECT_GT(footprint.Distance(Pose2(), ahead), 0.);
  EXPECT_LT(footprint.Distance(Pose2(0., 0., kPi / 2.), ahead), 0.);
}

TEST(FootprintTest, NothingIsInfinitelyFarAway) {
  EXPECT_TRUE(std::isinf(Footprint().Distance(Pose2(), {0., 0.})));
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
