// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/field_of_view.h"

#include <cmath>

#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Scans of one beam a degree.
FieldOfView Seen(const double from, const double to, const int scans) {
  FieldOfView field;
  for (int scan = 0; scan < scans; ++scan) {
    for (double degrees = from + 0.5; degrees < to; degrees += 1.) {
      const double angle = DegToRad(degrees);
      field.Add(Eigen::Vector2f(3. * std::cos(angle), 3. * std::sin(angle)));
    }
  }
  return field;
}

TEST(FieldOfViewTest, IsThatOfTheLaser) {
  EXPECT_NEAR(Seen(-28.5, 28.5, 50).angle(), DegToRad(57.), DegToRad(5.));
  EXPECT_NEAR(Seen(-90., 90., 50).angle(), kPi, 1e-9);
  EXPECT_NEAR(Seen(-120., 120., 50).angle(), DegToRad(240.), 1e-9);
  EXPECT_NEAR(Seen(-180., 180., 50).angle(), 2. * kPi, 1e-9);
  // One that looks backwards.
  EXPECT_NEAR(Seen(150., 210., 50).angle(), DegToRad(60.), 1e-9);
}

// A robot of short sight enters a hall with a wall on one side.
TEST(FieldOfViewTest, IsThatOfTheLastSeconds) {
  FieldOfView field = Seen(-120., 120., 50);
  for (int scan = 0; scan < 200; ++scan) {
    field.Advance(0.1);
    for (double degrees = 30.5; degrees < 90.; degrees += 1.) {
      const double angle = DegToRad(degrees);
      field.Add(Eigen::Vector2f(3. * std::cos(angle), 3. * std::sin(angle)));
    }
    if (scan == 1) {
      EXPECT_NEAR(field.angle(), DegToRad(240.), 1e-9);
    }
  }
  EXPECT_NEAR(field.angle(), DegToRad(60.), 1e-9);
}

// After minutes without a return, too.
TEST(FieldOfViewTest, WithoutPointsForLong) {
  FieldOfView field = Seen(-120., 120., 50);
  for (int i = 0; i < 1000; ++i) field.Advance(10.);
  EXPECT_EQ(field.angle(), 0.);
  field.Add(Eigen::Vector2f(1.f, 0.f));
  EXPECT_NEAR(field.angle(), DegToRad(5.), 1e-9);
}

TEST(FieldOfViewTest, IsWideUntilItIsKnown) {
  EXPECT_NEAR(FieldOfView().angle(), 2. * kPi, 1e-9);
  EXPECT_NEAR(Seen(-30., 30., 3).angle(), 2. * kPi, 1e-9);
}

TEST(FieldOfViewTest, StrayPointsDoNotCount) {
  FieldOfView field = Seen(-30., 30., 100);
  field.Add(Eigen::Vector2f(-1.f, 0.1f));
  field.Add(Eigen::Vector2f(std::nanf(""), 0.f));
  EXPECT_NEAR(field.angle(), DegToRad(60.), 1e-9);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
