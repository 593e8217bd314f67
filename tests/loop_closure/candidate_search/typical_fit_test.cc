// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TypicalFitOptions Options() {
  TypicalFitOptions options;
  options.reference = 0.6;
  options.least_scale = 0.8;
  options.window = 4;
  options.min_fits = 2;
  return options;
}

TEST(TypicalFitTest, SaysNothingBeforeThereAreEnough) {
  TypicalFit fit(Options());
  EXPECT_EQ(fit.Scale(0), 1.);
  fit.Add(0, 0.5, kPi);
  EXPECT_EQ(fit.Scale(0), 1.);
  fit.Add(0, 0.52, kPi);
  EXPECT_DOUBLE_EQ(fit.Scale(0), 0.51 / 0.6);
}

TEST(TypicalFitTest, StaysWithinItsBounds) {
  TypicalFit fit(Options());
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.3, kPi);
  EXPECT_EQ(fit.Scale(0), 0.8);
  for (int i = 0; i < 4; ++i) fit.Add(1, 0.75, kPi);
  EXPECT_EQ(fit.Scale(1), 1.);
}

TEST(TypicalFitTest, NarrowScansKeepAHigherMinimum) {
  TypicalFitOptions options = Options();
  options.least_scale_of_narrow = 0.9;
  options.narrow_sector = 1.5;
  TypicalFit fit(options);
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.3, 1.);
  EXPECT_EQ(fit.Scale(0), 0.9);
  for (int i = 0; i < 3; ++i) fit.Add(0, 0.3, 1.8);  // mean 1.6
  EXPECT_EQ(fit.Scale(0), 0.8);
}

TEST(TypicalFitTest, SectorSeenByHand) {
  EXPECT_EQ(SectorSeen({}), 0.);
  EXPECT_NEAR(SectorSeen({{1.f, 0.01f}}), 2. * kPi / 72., 1e-9);
  // From -60 to 65 degrees: 25 bins of five degrees, across the x axis.
  std::vector<Eigen::Vector2f> points;
  for (int degrees = -60; degrees <= 60; degrees += 5) {
    const double angle = (degrees + 2.5) * kPi / 180.;
    points.push_back(Eigen::Vector2d(3. * std::cos(angle), 3. * std::sin(angle))
                         .cast<float>());
  }
  EXPECT_NEAR(SectorSeen(points), 25. * 2. * kPi / 72., 1e-9);
  // The same behind the robot, where the angle jumps.
  for (Eigen::Vector2f& point : points) point = -point;
  EXPECT_NEAR(SectorSeen(points), 25. * 2. * kPi / 72., 1e-9);
  points.emplace_back(1.f, 0.01f);
  EXPECT_GT(SectorSeen(points), kPi);
}

TEST(TypicalFitTest, OldFitsAreForgotten) {
  TypicalFit fit(Options());
  for (int i = 0; i < 100; ++i) fit.Add(0, 0.2, kPi);
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.57, kPi);
  EXPECT_DOUBLE_EQ(fit.Scale(0), 0.57 / 0.6);
}

TEST(TypicalFitTest, RunsAreApart) {
  TypicalFit fit(Options());
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.5, kPi);
  EXPECT_EQ(fit.Scale(1), 1.);
}

TEST(TypicalFitTest, OffWithoutAReference) {
  TypicalFitOptions options = Options();
  options.reference = 0.;
  TypicalFit fit(options);
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.1, kPi);
  EXPECT_EQ(fit.Scale(0), 1.);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
