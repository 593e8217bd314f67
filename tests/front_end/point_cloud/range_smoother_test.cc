// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/range_smoother.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using Surface = std::function<double(double)>;  // range by bearing

constexpr double kHalfACell = 0.025;

double Noise(const double range) { return std::hypot(0.004, 0.008 * range); }

// A wall across the x axis.
double Wall(const double bearing) { return 8. / std::cos(bearing); }

// The corner of a room.
double Corner(const double bearing) {
  return 6. /
         std::max(std::cos(bearing - kPi / 4.), std::cos(bearing + kPi / 4.));
}

double WallWithPost(const double bearing) {
  return std::abs(bearing) < 0.04 ? 7. : Wall(bearing);
}

// Beams every degree over 120 degrees.
std::vector<Eigen::Vector2f> Scan(const Surface& surface, const double scale,
                                  Random* const random) {
  std::vector<Eigen::Vector2f> points;
  for (int i = -60; i <= 60; ++i) {
    const double bearing = i * kPi / 180.;
    const double range =
        surface(bearing) + scale * Noise(surface(bearing)) * random->Normal();
    points.emplace_back(range * std::cos(bearing), range * std::sin(bearing));
  }
  return points;
}

// Root mean squares of the errors of the ranges over the middle beams.
struct Errors {
  double raw = 0.;
  double smoothed = 0.;
};

Errors ErrorsOver(const Surface& surface, const int half_width,
                  const double scale = 1.) {
  constexpr int kLearning = 200;
  constexpr int kMeasured = 100;
  Random random(3);
  RangeSmoother smoother(kHalfACell);
  Errors sums;
  int count = 0;
  for (int n = 0; n < kLearning + kMeasured; ++n) {
    const auto points = Scan(surface, scale, &random);
    const auto factors = smoother.Smooth(points);
    for (int i = -half_width; n >= kLearning && i <= half_width; ++i) {
      const double truth = surface(i * kPi / 180.);
      const double range = points[60 + i].norm();
      sums.raw += (range - truth) * (range - truth);
      sums.smoothed += std::pow(factors[60 + i] * range - truth, 2);
      ++count;
    }
  }
  return {std::sqrt(sums.raw / count), std::sqrt(sums.smoothed / count)};
}

TEST(RangeSmootherTest, LearnsTheNoiseOfTheLaser) {
  Random random(1);
  RangeSmoother smoother(kHalfACell);
  for (int n = 0; n < 100; ++n) smoother.Smooth(Scan(Wall, 1., &random));
  for (const double range : {9., 13.}) {
    EXPECT_NEAR(smoother.noise().At(range), Noise(range), 0.2 * Noise(range));
  }
}

TEST(RangeSmootherTest, LeavesStepsOfTheRangesAlone) {
  Random random(1);
  RangeSmoother smoother(kHalfACell);
  for (int n = 0; n < 100; ++n) {
    auto points = Scan(Wall, 0.05, &random);
    for (Eigen::Vector2f& point : points) {
      const float range = point.norm();
      point *= 0.1f * std::round(10.f * range) / range;
    }
    for (const float factor : smoother.Smooth(points)) ASSERT_EQ(factor, 1.f);
  }
  EXPECT_EQ(smoother.noise().At(9.), 0.);
}

TEST(RangeSmootherTest, TakesMostOfTheNoiseFromAWall) {
  const Errors errors = ErrorsOver(Wall, 40);
  EXPECT_GT(errors.raw, 0.06);
  EXPECT_LT(errors.smoothed, 0.5 * errors.raw);
}

TEST(RangeSmootherTest, KeepsACorner) {
  const Errors errors = ErrorsOver(Corner, 3);
  EXPECT_LT(errors.smoothed, 1.1 * errors.raw);
}

TEST(RangeSmootherTest, KeepsAPost) {
  const Errors post = ErrorsOver(WallWithPost, 2);
  EXPECT_LT(post.smoothed, 1.1 * post.raw);
  // And the wall beside it.
  const Errors beside = ErrorsOver(WallWithPost, 6);
  EXPECT_LT(beside.smoothed, 1.1 * beside.raw);
}

TEST(RangeSmootherTest, LeavesALaserAloneThatIsBetterThanTheGrid) {
  Random random(2);
  RangeSmoother smoother(kHalfACell);
  for (int n = 0; n < 400; ++n) {
    for (const float factor : smoother.Smooth(Scan(Wall, 0.1, &random))) {
      ASSERT_EQ(factor, 1.f);
    }
  }
  EXPECT_GT(smoother.noise().At(9.), 0.);
}

TEST(RangeSmootherTest, SkipsWhatIsNoReturn) {
  Random random(2);
  RangeSmoother smoother(kHalfACell);
  for (int n = 0; n < 200; ++n) smoother.Smooth(Scan(Wall, 1., &random));
  EXPECT_TRUE(smoother.Smooth({}).empty());
  auto points = Scan(Wall, 1., &random);
  points[60] = Eigen::Vector2f::Zero();
  points[61].x() = std::numeric_limits<float>::quiet_NaN();
  const auto factors = smoother.Smooth(points);
  EXPECT_EQ(factors[60], 1.f);
  EXPECT_EQ(factors[61], 1.f);
  // Its neighbours are smoothed across it.
  EXPECT_NE(factors[59], 1.f);
  // A single point and one that repeats.
  EXPECT_EQ(smoother.Smooth({points[0]}), std::vector<float>{1.f});
  EXPECT_EQ(smoother.Smooth({points[0], points[0], points[0]}),
            std::vector<float>(3, 1.f));
}

TEST(RangeSmootherTest, DoesNotDependOnWhichSideTheBeamsBegin) {
  Random one(2), other(2);
  RangeSmoother forwards(kHalfACell), backwards(kHalfACell);
  for (int n = 0; n < 200; ++n) {
    const auto points = Scan(Wall, 1., &one);
    const auto factors = forwards.Smooth(points);
    auto reversed = Scan(Wall, 1., &other);
    std::reverse(reversed.begin(), reversed.end());
    const auto factors_reversed = backwards.Smooth(reversed);
    for (size_t i = 0; i < factors.size(); ++i) {
      ASSERT_NEAR(factors[i], factors_reversed[factors.size() - 1 - i], 1e-6f);
    }
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
