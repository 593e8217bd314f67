// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/calibration_filter.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A filter of the translation alone.
CalibrationFilter WayFilter(const double sigma, const double floor,
                            const CalibrationFilter::Noise& noise) {
  return CalibrationFilter(Eigen::Vector2d(1., 0.), Eigen::Vector2d(sigma, 0.),
                           Eigen::Vector2d(floor, 0.), noise);
}

TEST(CalibrationFilterTest, TwoMetresByHand) {
  CalibrationFilter filter = WayFilter(0.02, 0., {0.01, 0., 0., 4.});
  // Odometry 1 m, match 1.02 m. Units of 1e-4: y has 1 + 4 of variance, 4 of
  // them with the scale; the match adds 1. Gains 4/6 and 5/6.
  EXPECT_TRUE(filter.Add(Eigen::Vector2d(1., 0.), 1., 1.02, 0.));
  EXPECT_NEAR(filter.value(0), 1. + 0.02 * 4. / 6., 1e-12);
  EXPECT_NEAR(filter.sigma(0), std::sqrt(4e-4 / 3.), 1e-12);
  // Then y is 1/300 m behind the match, with variance 5/6, 2/3 of that with the
  // scale, 4/3. Odometry 1 m, match 1 m: expected is 1.01 m, 3.5 and 2 of
  // variance, gain 2/4.5.
  EXPECT_TRUE(filter.Add(Eigen::Vector2d(1., 0.), 1., 1., 0.));
  EXPECT_NEAR(filter.value(0), 1. + 0.02 * 4. / 6. - 0.01 * 2. / 4.5, 1e-12);
  EXPECT_NEAR(filter.sigma(0), std::sqrt(4e-4 / 9.), 1e-12);
  EXPECT_EQ(filter.value(1), 0.);
  EXPECT_EQ(filter.sigma(1), 0.);
}

TEST(CalibrationFilterTest, MatchesAreComparedOverAllTheWayBetweenThem) {
  CalibrationFilter filter = WayFilter(0.1, 0., {0.01, 0., 0., 4.});
  // Only the last match locates the robot.
  for (int i = 0; i < 10; ++i) {
    filter.Add(Eigen::Vector2d(1., 0.), 1., 1.01, i == 9 ? 0. : 1000.);
  }
  // 1 cm at each end over 10 m, and the first value.
  const double expected = std::sqrt(1. / (1. / 0.01 + 100. / 2e-4));
  EXPECT_NEAR(filter.sigma(0), expected, 1e-6);
  EXPECT_NEAR(filter.value(0), 1.01, 1e-5);
}

TEST(CalibrationFilterTest, WhatAMetreAddsIsNotForgotten) {
  CalibrationFilter filter = WayFilter(0.1, 0., {1e-6, 0.01, 0., 4.});
  for (int i = 0; i < 25; ++i) {
    filter.Add(Eigen::Vector2d(1., 0.), 1., 1., 0.);
  }
  // 1 cm per root metre: 5 cm in 25 m.
  EXPECT_NEAR(filter.sigma(0), 0.05 / 25., 2e-5);
}

TEST(CalibrationFilterTest, AContradictionBeginsAnew) {
  CalibrationFilter filter = WayFilter(0.02, 0., {0.01, 0., 0., 4.});
  filter.Add(Eigen::Vector2d(1., 0.), 1., 1.02, 0.);
  const double value = filter.value(0), sigma = filter.sigma(0);
  EXPECT_FALSE(filter.Add(Eigen::Vector2d(1., 0.), 1., 1.5, 0.));
  EXPECT_FALSE(filter.Add(Eigen::Vector2d(1., 0.), 1., std::nan(""), 0.));
  EXPECT_EQ(filter.value(0), value);
  EXPECT_EQ(filter.sigma(0), sigma);
  // The half metre is forgotten.
  EXPECT_TRUE(filter.Add(Eigen::Vector2d(1., 0.), 1., value, 0.));
  EXPECT_NEAR(filter.value(0), value, 1e-12);
}

TEST(CalibrationFilterTest, TheFactorOfTheNoiseByHand) {
  // Nothing to estimate: y has a variance of 1e-4, the match the same. Of a
  // standard normal, squares limited to 9 are 0.9950 on average.
  CalibrationFilter known = WayFilter(0., 0., {0.01, 0., 0., 4., 5.});
  EXPECT_EQ(known.noise_factor(), 1.);
  EXPECT_TRUE(known.Add(Eigen::Vector2d(1., 0.), 1., 1.02, 0.));
  // 4 / 2, and five that are as assumed.
  double factor = (5. + 2. / 0.9950) / 6.;
  EXPECT_NEAR(known.noise_factor(), factor, 1e-12);
  // Refused: counts like three standard deviations.
  EXPECT_FALSE(known.Add(Eigen::Vector2d(1., 0.), 1., 2., 0.));
  factor = (5. + 2. / 0.9950 + 9. * factor / 0.9950) / 7.;
  EXPECT_NEAR(known.noise_factor(), factor, 1e-12);
  EXPECT_FALSE(known.Add(Eigen::Vector2d(1., 0.), 1., std::nan(""), 0.));
  EXPECT_NEAR(known.noise_factor(), factor, 1e-12);
  // The bound follows.
  EXPECT_TRUE(known.Add(Eigen::Vector2d(1., 0.), 1.,
                        1. + 3.99 * std::sqrt(2e-4 * factor), 0.));
  // Noise that is known stays as it is.
  CalibrationFilter constant = WayFilter(0., 0., {0.01, 0., 0., 4.});
  EXPECT_FALSE(constant.Add(Eigen::Vector2d(1., 0.), 1., 2., 0.));
  EXPECT_EQ(constant.noise_factor(), 1.);

  // 4 of 6 parts of the variance are the scale's: one third of an increment, with
  // a residual of 16 / 6.
  CalibrationFilter filter = WayFilter(0.02, 0., {0.01, 0., 0., 4., 5.});
  EXPECT_TRUE(filter.Add(Eigen::Vector2d(1., 0.), 1., 1.04, 0.));
  factor = (5. + 16. / 18. / 0.9950) / (5. + 1. / 3.);
  EXPECT_NEAR(filter.noise_factor(), factor, 1e-12);
  // The scale was worth 1 / 4e-4, the increment as much as 1 / 2e-4.
  EXPECT_NEAR(filter.sigma(0), std::sqrt(1. / (2500. + 5000. / factor)), 1e-12);
}

TEST(CalibrationFilterTest, NeverBetterThanTheFloor) {
  CalibrationFilter filter = WayFilter(0.02, 0.001, {0.01, 0., 0., 4.});
  for (int i = 0; i < 1000; ++i) {
    filter.Add(Eigen::Vector2d(1., 0.), 1., 1., 0.);
  }
  EXPECT_GT(filter.sigma(0), 0.001);
  EXPECT_NEAR(filter.sigma(0), 0.001, 1e-6);
  // And never worse than at first.
  CalibrationFilter wanders = WayFilter(0.02, 0.001, {1000., 0., 0.01, 4.});
  for (int i = 0; i < 1000; ++i) {
    wanders.Add(Eigen::Vector2d(1., 0.), 1., 1., 0.);
  }
  EXPECT_NEAR(wanders.sigma(0), 0.02, 1e-5);
  EXPECT_LE(wanders.sigma(0), 0.02);
}

// The second parameter is known from elsewhere: what is left is the first one.
TEST(CalibrationFilterTest, AParameterThatIsKnownFromElsewhere) {
  CalibrationFilter filter(Eigen::Vector2d(1., 0.), Eigen::Vector2d(0.1, 0.1),
                           Eigen::Vector2d::Zero(), {1e-6, 0., 0., 1e9});
  filter.Add(Eigen::Vector2d(1., 1.), 1., 1.05, 0.);
  filter.Set(1, 0.05, 0.);
  EXPECT_EQ(filter.value(1), 0.05);
  EXPECT_EQ(filter.sigma(1), 0.);
  for (int i = 0; i < 10; ++i) {
    filter.Add(Eigen::Vector2d(1., 1.), 1., 1.05, 0.);
  }
  EXPECT_NEAR(filter.value(0), 1., 1e-6);
  EXPECT_EQ(filter.value(1), 0.05);
  // Never less certain than at first.
  filter.Set(1, 0., 7.);
  EXPECT_NEAR(filter.sigma(1), 0.1, 1e-12);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
