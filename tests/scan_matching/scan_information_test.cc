// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/scan_information.h"

#include <cmath>
#include <limits>
#include <vector>

#include "Eigen/Eigenvalues"
#include "Eigen/LU"
#include "cartographer_ext/uncertainty/uncertain_pose.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

using uncertainty::ScaledMotion;
using uncertainty::ScanCurvature;

const std::vector<Eigen::Vector2d>& Square() {
  static const auto* const points = new std::vector<Eigen::Vector2d>{
      {2., 2.}, {-2., 2.}, {2., -2.}, {-2., -2.}};
  return *points;
}

// A corridor along x: curvature across and of the turn.
ScanInformation Corridor(const ScanInformationOptions& options) {
  ScanCurvature curvature;
  curvature.values << 0., 0.06, 0.12;
  curvature.rises = curvature.values;
  curvature.axes << 1., 0., 0., 0., 0., 1., 0., 1., 0.;
  const ScaledMotion motion(Square(), 0.05, Pose2());
  return AnalyzeScan(options, motion, curvature, 200,
                     Eigen::Vector3d(4., 100., 50.).asDiagonal());
}

TEST(ScanInformationTest, CorridorKnowsNothingAlongItself) {
  const ScanInformationOptions options;
  const ScanInformation scan = Corridor(options);
  EXPECT_EQ(scan.degeneracy.state, DegeneracyState::kTranslation);
  EXPECT_NEAR(std::sin(scan.degeneracy.direction), 0., 1e-12);
  EXPECT_EQ(scan.information(0, 0), 0.);
  const double noise = options.map_noise * options.map_noise +
                       options.point_noise * options.point_noise / 200.;
  // 0.12 per squared cell of 5 cm.
  EXPECT_NEAR(scan.information(1, 1), 0.12 / noise / 0.0025, 1e-6);
  // The points are sqrt 8 m from their centroid.
  EXPECT_NEAR(scan.information(2, 2), 0.06 / noise * 8. / 0.0025, 1e-6);
  EXPECT_NEAR(scan.degeneracy.eigenvalues(1), scan.information(1, 1), 1e-6);
}

TEST(ScanInformationTest, RemapTakesThePredictionAlongTheCorridorOnly) {
  const ScanInformation scan = Corridor(ScanInformationOptions());
  const Pose2 result =
      Remap(scan, nullptr, Pose2(1., 2., 0.1), Pose2(1.5, 2.2, 0.15));
  EXPECT_NEAR(result.x, 1., 1e-12);
  EXPECT_NEAR(result.y, 2.2, 1e-12);
  EXPECT_EQ(result.theta, 0.15);
}

TEST(ScanInformationTest, PaperLiteralIsByTheRatioOfTheHessian) {
  ScanInformationOptions options;
  options.mode = DegeneracyMode::kPaperLiteral;
  options.paper_ratio = 30.;  // 100 / 4 is below
  EXPECT_EQ(Corridor(options).degeneracy.state, DegeneracyState::kNone);
  options.paper_ratio = 20.;
  const ScanInformation scan = Corridor(options);
  EXPECT_EQ(scan.degeneracy.state, DegeneracyState::kTranslation);
  const Pose2 result =
      Remap(scan, nullptr, Pose2(1., 2., 0.1), Pose2(1.5, 2.2, 0.15));
  EXPECT_NEAR(result.x, 1., 1e-12);
  EXPECT_NEAR(result.y, 2.2, 1e-12);
  EXPECT_EQ(result.theta, 0.15);
  // The covariance of the prediction plays no part in the paper.
  const Eigen::Matrix3d prior = Eigen::Matrix3d::Identity();
  const Pose2 same =
      Remap(scan, &prior, Pose2(1., 2., 0.1), Pose2(1.5, 2.2, 0.15));
  EXPECT_EQ(same.x, result.x);
  EXPECT_EQ(same.y, result.y);
}

// Eq. 19 with matrices, as corrected, against the sum over eigenvectors.
TEST(ScanInformationTest, EquationNineteenWithMatrices) {
  ScanInformation scan;
  scan.mode = DegeneracyMode::kPaperLiteral;
  DegeneracyOptions options;
  options.mode = DegeneracyMode::kPaperLiteral;
  const Eigen::Vector2d normal(std::cos(0.7), std::sin(0.7));
  Eigen::Matrix3d wall = Eigen::Matrix3d::Zero();
  wall.topLeftCorner<2, 2>() = 1e4 * normal * normal.transpose();
  wall(2, 2) = 1e4;
  scan.degeneracy = AnalyzeDegeneracy(options, wall);
  const Eigen::Matrix2d c_f = scan.degeneracy.eigenvectors.transpose();
  Eigen::Matrix2d c_d = Eigen::Matrix2d::Zero(), c_n = Eigen::Matrix2d::Zero();
  c_d.row(0) = c_f.row(0);
  c_n.row(1) = c_f.row(1);
  const Eigen::Vector2d x_0(0.3, -0.4), x_s(1.1, 0.6);
  const Eigen::Vector2d expected =
      c_f.transpose() * c_d * x_0 + c_f.transpose() * c_n * x_s;
  const Pose2 remapped = Remap(scan, nullptr, Pose2(x_0.x(), x_0.y(), 0.),
                               Pose2(x_s.x(), x_s.y(), 0.));
  EXPECT_NEAR(remapped.x, expected.x(), 1e-12);
  EXPECT_NEAR(remapped.y, expected.y(), 1e-12);
}

TEST(ScanInformationTest, WhatIsObservedInFullIsReturnedToTheBit) {
  ScanInformation scan;
  scan.direction_weights.setOnes();
  const Pose2 match(1.7, 2.3, -3.1);
  const Pose2 result = Remap(scan, nullptr, Pose2(1., 2., 3.1), match);
  EXPECT_EQ(result.x, match.x);
  EXPECT_EQ(result.y, match.y);
  EXPECT_EQ(result.theta, match.theta);
}

TEST(ScanInformationTest, HeadingIsCorrectedTheShortWay) {
  ScanCurvature curvature;
  curvature.values << 0.03, 0.06, 0.12;
  curvature.rises = curvature.values;
  const ScanInformation scan = AnalyzeScan(
      ScanInformationOptions(), ScaledMotion(Square(), 0.05, Pose2()),
      curvature, 200, Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d prior = scan.information;
  // Both know the same: half of the difference of 0.2 over pi.
  const Pose2 result =
      Remap(scan, &prior, Pose2(0., 0., kPi - 0.1), Pose2(0., 0., -kPi + 0.1));
  EXPECT_NEAR(std::abs(result.theta), kPi, 1e-9);
}

// In a round room of radius 6 m, 3 m from its centre, driving along the wall
// while turning along changes nothing.
TEST(ScanInformationTest, RoundRoom) {
  // The points are about the centre of the room, which is at (-3, 0) from the
  // node: turning about their centroid is the motion nobody sees.
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 100; ++i) {
    const double angle = 2. * kPi * i / 100.;
    points.emplace_back(-3. + 6. * std::cos(angle), 6. * std::sin(angle));
  }
  ScanCurvature curvature;
  curvature.values << 0., 0.1, 0.1;
  curvature.rises = curvature.values;
  curvature.axes << 0., 1., 0., 0., 0., 1., 1., 0., 0.;
  const ScaledMotion motion(points, 0.05, Pose2(3., 0., 0.));
  const ScanInformation scan =
      AnalyzeScan(ScanInformationOptions(), motion, curvature, 100,
                  Eigen::Matrix3d::Identity());
  // Neither the position along the wall nor the heading is observed alone.
  EXPECT_EQ(scan.degeneracy.state, DegeneracyState::kTranslationAndRotation);
  EXPECT_NEAR(std::abs(std::sin(scan.degeneracy.direction)), 1., 1e-9);
  // The information does not see the motion around the centre, and sees each of
  // its parts.
  const Eigen::Vector3d around(0., 3., 1.);
  EXPECT_NEAR(around.dot(scan.information * around), 0., 1e-6);
  EXPECT_GT(scan.information(1, 1), 1e3);
  EXPECT_GT(scan.information(2, 2), 1e3);
  // Given the heading, the place is known: with the match's heading its place
  // is right, too.
  EXPECT_EQ(scan.direction_weights, Eigen::Vector2d(1., 1.));
  // The prediction's heading with its covariance: place and heading move
  // together, so that the walls still fit.
  const Eigen::Matrix3d prior = Eigen::Vector3d(1., 1., 1e8).asDiagonal();
  const Pose2 fused =
      Remap(scan, &prior, Pose2(3., 0.02, 0.03), Pose2(3., 0., 0.));
  EXPECT_NEAR(fused.theta, 0.03, 1e-5);
  EXPECT_NEAR(fused.y, 0.09, 1e-3);
}

TEST(ScanInformationTest, RemapWithACovarianceIsTheKalmanUpdate) {
  ScanCurvature curvature;
  curvature.values << 0.03, 0.06, 0.12;
  curvature.rises = curvature.values;
  const ScaledMotion motion(Square(), 0.05, Pose2(0.5, 0.6, 0.2));
  const ScanInformation scan =
      AnalyzeScan(ScanInformationOptions(), motion, curvature, 200,
                  Eigen::Matrix3d::Identity());
  ASSERT_EQ(scan.weights, Eigen::Vector3d(1., 1., 1.));
  Eigen::Matrix3d covariance;
  covariance << 1e-4, 2e-5, 0., 2e-5, 4e-4, 1e-5, 0., 1e-5, 1e-4;
  Eigen::Matrix3d prior;
  ASSERT_TRUE(uncertainty::InvertCovariance(covariance, &prior));
  EXPECT_TRUE(prior.isApprox(Eigen::Matrix3d(covariance.inverse()), 1e-9));
  const Pose2 prediction(1., 2., 0.3), match(1.02, 1.97, 0.31);
  const Eigen::Vector3d innovation(0.02, -0.03, 0.01);
  const Eigen::Matrix3d gain =
      covariance * (covariance + scan.information.inverse()).inverse();
  const Eigen::Vector3d expected =
      Eigen::Vector3d(1., 2., 0.3) + gain * innovation;
  const Pose2 fused = Remap(scan, &prior, prediction, match);
  EXPECT_NEAR(fused.x, expected.x(), 1e-9);
  EXPECT_NEAR(fused.y, expected.y(), 1e-9);
  EXPECT_NEAR(fused.theta, expected.z(), 1e-9);

  MatchReport report;
  Compare(scan, prediction, &covariance, match, &report);
  EXPECT_EQ(report.degrees_of_freedom, 3);
  EXPECT_NEAR((report.disagreement - innovation).norm(), 0., 1e-12);
  EXPECT_NEAR(
      report.mahalanobis,
      innovation.dot((covariance + scan.information.inverse()).inverse() *
                     innovation),
      1e-9);
}

TEST(ScanInformationTest, OnlyDeterminedDirectionsAreCompared) {
  const ScanInformation scan = Corridor(ScanInformationOptions());
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  MatchReport report;
  Compare(scan, Pose2(), &covariance, Pose2(5., 0., 0.), &report);
  EXPECT_EQ(report.degrees_of_freedom, 2);
  EXPECT_NEAR(report.mahalanobis, 0., 1e-9);
  EXPECT_NEAR(report.disagreement.norm(), 0., 1e-9);
  Compare(scan, Pose2(), &covariance, Pose2(5., 0.1, 0.), &report);
  EXPECT_NEAR(report.disagreement.y(), 0.1, 1e-9);
  EXPECT_GT(report.mahalanobis, 50.);
  Compare(scan, Pose2(), nullptr, Pose2(5., 0.1, 0.), &report);
  EXPECT_EQ(report.mahalanobis, 0.);
}

// What the scan hardly determines it still moves: a direction is compared as far
// as it has a share in the result.
TEST(ScanInformationTest, HalfDeterminedDirectionsAreCompared) {
  ScanCurvature curvature;
  curvature.values << 0.06, 0.06, 0.12;
  curvature.axes.setIdentity();
  curvature.rises << 0.06, 0.06, 0.0012;
  const ScanInformation scan = AnalyzeScan(
      ScanInformationOptions(), ScaledMotion(Square(), 0.05, Pose2()),
      curvature, 200, Eigen::Matrix3d::Identity());
  int half = 0;
  for (int k = 0; k < 3; ++k) {
    half += scan.weights(k) > 0.01 && scan.weights(k) < 0.5 ? 1 : 0;
  }
  ASSERT_EQ(half, 1);
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d prior;
  ASSERT_TRUE(uncertainty::InvertCovariance(covariance, &prior));
  const Pose2 match(0.1, 0.1, 0.4);
  MatchReport report;
  Compare(scan, Pose2(), &covariance, match, &report);
  EXPECT_EQ(report.degrees_of_freedom, 3);
  const Eigen::Vector3d innovation(0.1, 0.1, 0.4);
  EXPECT_NEAR(
      report.mahalanobis,
      innovation.dot((covariance + scan.information.inverse()).inverse() *
                     innovation),
      1e-6 * report.mahalanobis);
  // A result that the match has moved this far has a statistic that tells.
  EXPECT_GT(std::abs(Remap(scan, &prior, Pose2(), match).theta), 0.1);
  EXPECT_GT(report.mahalanobis, 100.);
}

TEST(ScanInformationTest, ElongatedAlongTheCorridor) {
  for (double angle = 0.1; angle < kPi; angle += 0.3) {
    ScanCurvature curvature;
    curvature.values << 0.0005, 0.06, 0.12;
    curvature.rises = curvature.values;
    curvature.axes << std::cos(angle), 0., -std::sin(angle), std::sin(angle),
        0., std::cos(angle), 0., 1., 0.;
    const ScanInformation scan = AnalyzeScan(
        ScanInformationOptions(), ScaledMotion(Square(), 0.05, Pose2()),
        curvature, 200, Eigen::Matrix3d::Identity());
    const Eigen::Matrix3d prior = Eigen::Vector3d(1e4, 1e4, 1e4).asDiagonal();
    Eigen::Matrix3d covariance;
    ASSERT_TRUE(
        uncertainty::InvertCovariance(scan.information + prior, &covariance));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
        Eigen::Matrix2d(covariance.topLeftCorner<2, 2>()));
    const Eigen::Vector2d longest = solver.eigenvectors().col(1);
    EXPECT_NEAR(std::abs(longest.dot(
                    Eigen::Vector2d(std::cos(angle), std::sin(angle)))),
                1., 1e-6);
    EXPECT_NEAR(solver.eigenvalues()(1), 1e-4, 1e-9);
  }
}

TEST(ScanInformationTest, BadInputKnowsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ScanCurvature curvature;
  curvature.values << nan, 1., 1.;
  const ScaledMotion motion(Square(), 0.05, Pose2());
  for (const int num_points : {0, 200}) {
    const ScanInformation scan =
        AnalyzeScan(ScanInformationOptions(), motion, curvature, num_points,
                    Eigen::Matrix3d::Identity());
    EXPECT_EQ(scan.degeneracy.state, DegeneracyState::kEverything);
    EXPECT_EQ(scan.information, Eigen::Matrix3d::Zero());
    const Pose2 kept =
        Remap(scan, nullptr, Pose2(1., 2., 0.), Pose2(3., 4., 0.));
    EXPECT_EQ(kept.x, 1.);
    EXPECT_EQ(kept.y, 2.);
  }
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
