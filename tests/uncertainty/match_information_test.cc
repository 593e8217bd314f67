// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/match_information.h"

#include <cmath>
#include <limits>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

// The corners of a square, sqrt(8) m from their centroid.
const std::vector<Eigen::Vector2d>& Square() {
  static const auto* const points = new std::vector<Eigen::Vector2d>{
      {2., 2.}, {-2., 2.}, {2., -2.}, {-2., -2.}};
  return *points;
}

// A corridor along x: curvature of the turn and across.
ScanCurvature Corridor() {
  ScanCurvature curvature;
  curvature.values << 0., 0.06, 0.12;
  curvature.rises = curvature.values;
  curvature.axes << 1., 0., 0., 0., 0., 1., 0., 1., 0.;
  return curvature;
}

TEST(MatchInformationTest, CorridorByHand) {
  const MatchInformationOptions options;
  const MatchInformation match = EstimateMatchInformation(
      options, ScaledMotion(Square(), 0.05, Pose2()), Corridor(), 200);
  const double noise = 0.018 * 0.018 + 0.165 * 0.165 / 200.;
  EXPECT_EQ(match.information(0, 0), 0.);
  EXPECT_TRUE(std::isinf(match.variances(0)));
  // 0.12 per squared cell of 5 cm.
  EXPECT_NEAR(match.information(1, 1), 0.12 / noise / 0.0025, 1e-6);
  EXPECT_NEAR(match.information(2, 2), 0.06 / noise * 8. / 0.0025, 1e-6);
  EXPECT_NEAR(match.variances(2), noise / 0.12, 1e-12);
  // Shares of the largest curvature.
  EXPECT_NEAR(match.translation_floor, 0.05 * 0.12 / noise / 0.0025, 1e-6);
  EXPECT_NEAR(match.rotation_floor, 0.015 * 0.12 / noise * 8. / 0.0025, 1e-6);
}

TEST(MatchInformationTest, MorePointsReduceTheirPartOfTheNoiseOnly) {
  const MatchInformationOptions options;
  const ScaledMotion motion(Square(), 0.05, Pose2());
  const auto variance = [&](const int num_points) {
    return EstimateMatchInformation(options, motion, Corridor(), num_points)
        .variances(2);
  };
  EXPECT_GT(variance(50), variance(200));
  EXPECT_NEAR(variance(1000000000), 0.018 * 0.018 / 0.12, 1e-9);
}

TEST(MatchInformationTest, InformationTurnsWithTheAxes) {
  const ScaledMotion motion(Square(), 0.05, Pose2());
  for (double angle = 0.1; angle < kPi; angle += 0.3) {
    ScanCurvature curvature = Corridor();
    curvature.axes << std::cos(angle), 0., -std::sin(angle), std::sin(angle),
        0., std::cos(angle), 0., 1., 0.;
    const MatchInformation match = EstimateMatchInformation(
        MatchInformationOptions(), motion, curvature, 200);
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0.);
    EXPECT_NEAR((match.information * along).norm(), 0., 1e-6);
  }
}

TEST(MatchInformationTest, WithoutPointsOrNumbersThereIsNone) {
  const ScaledMotion motion(Square(), 0.05, Pose2());
  ScanCurvature bad = Corridor();
  bad.values(0) = std::numeric_limits<double>::quiet_NaN();
  for (const MatchInformation& match :
       {EstimateMatchInformation(MatchInformationOptions(), motion, bad, 200),
        EstimateMatchInformation(MatchInformationOptions(), motion, Corridor(),
                                 0)}) {
    EXPECT_TRUE(match.information.isZero(0.));
    EXPECT_TRUE(match.weights.isZero(0.));
    EXPECT_TRUE(std::isinf(match.variances(1)));
  }
}

TEST(BeliefTest, RisesSmoothlyFromTheFloor) {
  EXPECT_EQ(Belief(0., 10., 10.), 0.);
  EXPECT_EQ(Belief(10., 10., 10.), 0.);
  EXPECT_NEAR(Belief(std::sqrt(1000.), 10., 10.), 0.5, 1e-12);
  EXPECT_EQ(Belief(100., 10., 10.), 1.);
  EXPECT_EQ(Belief(1., 0., 10.), 1.);
  EXPECT_EQ(Belief(std::numeric_limits<double>::quiet_NaN(), 10., 10.), 0.);
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
