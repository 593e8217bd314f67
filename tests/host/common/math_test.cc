// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/math.h"

#include <cmath>
#include <limits>

#include "ceres/jet.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

TEST(MathTest, Clamp) {
  EXPECT_EQ(Clamp(5, -1, 3), 3);
  EXPECT_EQ(Clamp(-5, -1, 3), -1);
  EXPECT_EQ(Clamp(2, -1, 3), 2);
  EXPECT_EQ(Clamp(0.5, 0., 1.), 0.5);
}

TEST(MathTest, PowersAreConstantExpressions) {
  static_assert(Power(3, 0) == 1, "");
  static_assert(Power(3, 4) == 81, "");
  static_assert(Pow2(-7) == 49, "");
  EXPECT_EQ(Power(0.5, 3), 0.125);
}

TEST(MathTest, Degrees) {
  EXPECT_DOUBLE_EQ(DegToRad(180.), M_PI);
  EXPECT_DOUBLE_EQ(RadToDeg(M_PI / 2.), 90.);
}

TEST(MathTest, NormalizeAngleDifference) {
  EXPECT_EQ(NormalizeAngleDifference(0.5), 0.5);
  EXPECT_EQ(NormalizeAngleDifference(M_PI), M_PI);
  EXPECT_EQ(NormalizeAngleDifference(-M_PI), -M_PI);
  EXPECT_NEAR(NormalizeAngleDifference(1.5 * M_PI), -0.5 * M_PI, 1e-15);
  EXPECT_NEAR(NormalizeAngleDifference(-1.5 * M_PI), 0.5 * M_PI, 1e-15);
  EXPECT_NEAR(NormalizeAngleDifference(0.25 + 200. * M_PI), 0.25, 1e-12);
  EXPECT_NEAR(NormalizeAngleDifference(0.25 - 200. * M_PI), 0.25, 1e-12);
}

TEST(MathTest, NormalizeAngleDifferenceEndsForFarAngles) {
  const double far = NormalizeAngleDifference(1e300);
  EXPECT_LE(std::abs(far), M_PI);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(NormalizeAngleDifference(infinity), infinity);
  EXPECT_TRUE(std::isnan(NormalizeAngleDifference(std::nan(""))));
}

TEST(MathTest, NormalizeAngleDifferenceKeepsDerivatives) {
  using Jet = ceres::Jet<double, 1>;
  const Jet wrapped = NormalizeAngleDifference(Jet(4., 0) * 2.);
  EXPECT_NEAR(wrapped.a, 8. - 2. * M_PI, 1e-15);
  EXPECT_EQ(wrapped.v[0], 2.);
}

TEST(MathTest, DirectionOfVector) {
  EXPECT_DOUBLE_EQ(atan2(Eigen::Vector2d(0., 2.)), M_PI / 2.);
  EXPECT_DOUBLE_EQ(atan2(Eigen::Vector2d(-1., 0.)), M_PI);
}

TEST(MathTest, QuaternionProductOfUnits) {
  // i * j = k, j * i = -k.
  const double i[4] = {0., 1., 0., 0.};
  const double j[4] = {0., 0., 1., 0.};
  double product[4];
  QuaternionProduct(i, j, product);
  EXPECT_EQ(product[0], 0.);
  EXPECT_EQ(product[3], 1.);
  QuaternionProduct(j, i, product);
  EXPECT_EQ(product[3], -1.);
  // In place: (1 + 2i + 3j + 4k)^2 = -28 + 4i + 6j + 8k.
  double q[4] = {1., 2., 3., 4.};
  const double z[4] = {1., 2., 3., 4.};
  QuaternionProduct(z, q, q);
  EXPECT_EQ(q[0], -28.);
  EXPECT_EQ(q[1], 4.);
  EXPECT_EQ(q[2], 6.);
  EXPECT_EQ(q[3], 8.);
}

}  // namespace
}  // namespace common
}  // namespace cartographer
