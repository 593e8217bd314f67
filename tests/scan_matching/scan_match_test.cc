// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/scan_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "Eigen/Eigenvalues"
#include "gtest/gtest.h"
#include "tests/scan_matching/test_cells.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// Walls x = -2 and x = 2.5, y = -1.5 and y = 2.
TestCells Room() {
  TestCells cells = EmptyCells();
  Random random(1);
  cells.Draw(
      [](const double x, const double y) {
        double d = 10.;
        if (y > -1.6 && y < 2.1) {
          d = std::min({d, std::abs(x + 2.), std::abs(x - 2.5)});
        }
        if (x > -2.1 && x < 2.6) {
          d = std::min({d, std::abs(y + 1.5), std::abs(y - 2.)});
        }
        return d;
      },
      0.02, &random);
  return cells;
}

std::vector<Eigen::Vector2d> RoomPoints() {
  std::vector<Eigen::Vector2d> points;
  for (double x = -1.95; x < 2.5; x += 0.07) {
    points.emplace_back(x, -1.5);
    points.emplace_back(x, 2.);
  }
  for (double y = -1.45; y < 2.; y += 0.07) {
    points.emplace_back(-2., y);
    points.emplace_back(2.5, y);
  }
  return points;
}

// Walls y = 1.2 and y = -1.2 turned by `angle`, without ends.
TestCells Corridor(const double angle) {
  TestCells cells = EmptyCells();
  Random random(2);
  const double c = std::cos(angle), s = std::sin(angle);
  cells.Draw(
      [=](const double x, const double y) {
        return std::abs(std::abs(-s * x + c * y) - 1.2);
      },
      0.05, &random);
  return cells;
}

std::vector<Eigen::Vector2d> CorridorPoints(const double angle,
                                            Random* const random) {
  std::vector<Eigen::Vector2d> points;
  for (double x = -2.5; x < 2.5; x += 0.05) {
    for (const double y : {-1.2, 1.2}) {
      points.push_back(Pose2(0., 0., angle) *
                       Eigen::Vector2d(x, y + 0.01 * random->Normal()));
    }
  }
  return points;
}

Prediction Predict(const Pose2& pose) {
  Prediction prediction;
  prediction.pose = pose;
  return prediction;
}

Prediction Predict(const Pose2& pose, const double translation_sigma,
                   const double rotation_sigma) {
  Prediction prediction = Predict(pose);
  prediction.covariance.diagonal() << translation_sigma * translation_sigma,
      translation_sigma * translation_sigma, rotation_sigma * rotation_sigma;
  return prediction;
}

void ExpectSane(const Pose2& pose, const MatchReport& report) {
  EXPECT_TRUE(internal::IsFinite(pose));
  EXPECT_TRUE(report.covariance.allFinite());
  EXPECT_TRUE(report.information.allFinite());
  EXPECT_TRUE(report.scan_information.allFinite());
  EXPECT_GT(report.covariance.diagonal().minCoeff(), 0.);
  EXPECT_TRUE(report.degeneracy.eigenvalues.allFinite());
  EXPECT_TRUE(report.degeneracy.eigenvectors.allFinite());
  EXPECT_TRUE(report.disagreement.allFinite());
  EXPECT_TRUE(std::isfinite(report.mahalanobis));
  EXPECT_TRUE(std::isfinite(report.initial_cost));
  EXPECT_TRUE(std::isfinite(report.final_cost));
  EXPECT_TRUE(internal::IsFinite(report.match));
}

TEST(ScanMatchTest, FindsARoom) {
  const TestCells cells = Room();
  ScanMatchOptions options;
  options.occupied_space_weight = 20.;
  options.translation_weight = 0.1;
  options.rotation_weight = 0.1;
  const Pose2 truth(0.07, -0.04, 0.03);
  const std::vector<Eigen::Vector2d> seen = SeenFrom(truth, RoomPoints());
  MatchReport report;
  const Pose2 start(0.03, 0.01, 0.01);
  const Pose2 pose =
      MatchScan(options, Predict(start), start, seen, cells, &report);
  EXPECT_NEAR(pose.x, truth.x, 0.004);
  EXPECT_NEAR(pose.y, truth.y, 0.004);
  EXPECT_NEAR(pose.theta, truth.theta, 0.003);
  ExpectSane(pose, report);
  EXPECT_EQ(report.degeneracy.state, DegeneracyState::kNone);
  EXPECT_LT(report.final_cost, report.initial_cost);
  EXPECT_EQ(report.degrees_of_freedom, 3);
  EXPECT_NEAR(report.disagreement.x(), pose.x - start.x, 1e-9);
  EXPECT_LT(std::sqrt(report.covariance(0, 0)), 0.01);
  // The report changes nothing, and the same again is the same.
  const Pose2 again =
      MatchScan(options, Predict(start), start, seen, cells, nullptr);
  EXPECT_EQ(again.x, pose.x);
  EXPECT_EQ(again.theta, pose.theta);
}

// The start comes from a search, and the prediction knows nothing.
TEST(ScanMatchTest, AStartFarFromThePredictionIsNotPulledBack) {
  const TestCells cells = Room();
  Prediction prediction = Predict(Pose2(0.4, 0.3, 1.4));
  prediction.covariance = Eigen::Vector3d(200., 200., 200.).asDiagonal();
  const Pose2 found =
      MatchScan(ScanMatchOptions(), prediction, Pose2(0.04, -0.03, 0.02),
                RoomPoints(), cells, nullptr);
  EXPECT_NEAR(found.x, 0., 0.015);
  EXPECT_NEAR(found.y, 0., 0.015);
  EXPECT_NEAR(found.theta, 0., 0.01);
}

TEST(ScanMatchTest, CorridorKeepsThePredictionAlongItself) {
  for (const double angle : {0., 0.3, 0.9, 2.}) {
    const TestCells cells = Corridor(angle);
    Random random(3);
    const Pose2 along(0., 0., angle);
    // 0.2 m ahead and 3 cm off to the side, turned by 0.01.
    const Pose2 truth = along * Pose2(0.2, 0.03, 0.01 - angle);
    const std::vector<Eigen::Vector2d> seen =
        SeenFrom(truth, CorridorPoints(angle, &random));
    const Pose2 start = along * Pose2(0.15, 0., -angle);
    ScanMatchOptions options;
    options.translation_weight = 1.;
    options.rotation_weight = 1.;
    MatchReport report;
    const Pose2 pose =
        MatchScan(options, Predict(start), start, seen, cells, &report);
    ExpectSane(pose, report);
    EXPECT_EQ(report.degeneracy.state, DegeneracyState::kTranslation);
    EXPECT_NEAR(std::sin(report.degeneracy.direction - angle), 0.,
                DegToRad(5.));
    const Pose2 in_corridor = along.Inverse() * pose;
    EXPECT_NEAR(in_corridor.x, 0.15, 0.003) << angle;
    EXPECT_NEAR(in_corridor.y, 0.03, 0.006) << angle;
    EXPECT_NEAR(NormalizeAngle(pose.theta - 0.01), 0., 0.004) << angle;
    // Elongated along the corridor, as far as the prediction is unsure.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
        Eigen::Matrix2d(report.covariance.topLeftCorner<2, 2>()));
    const Eigen::Vector2d longest = solver.eigenvectors().col(1);
    EXPECT_GT(std::abs(longest.dot(
                  Eigen::Vector2d(std::cos(angle), std::sin(angle)))),
              std::cos(DegToRad(5.)));
    EXPECT_NEAR(std::sqrt(solver.eigenvalues()(1)), 0.1, 0.02);

    // With its covariance the prediction counts along the corridor, too.
    const Pose2 fused = MatchScan(options, Predict(start, 0.05, 0.02), start,
                                  seen, cells, &report);
    ExpectSane(fused, report);
    EXPECT_NEAR((along.Inverse() * fused).x, 0.15, 0.003) << angle;
    EXPECT_NEAR((along.Inverse() * fused).y, 0.03, 0.006) << angle;
    EXPECT_NEAR(
        report.covariance.determinant() * report.information.determinant(), 1.,
        1e-6);
  }
}

TEST(ScanMatchTest, SwitchedOffReturnsTheMatch) {
  const TestCells cells = Corridor(0.4);
  Random random(5);
  const std::vector<Eigen::Vector2d> seen =
      SeenFrom(Pose2(0.1, 0.02, 0.01), CorridorPoints(0.4, &random));
  ScanMatchOptions options;
  options.remap = false;
  MatchReport report;
  const Pose2 pose =
      MatchScan(options, Predict(Pose2()), Pose2(), seen, cells, &report);
  EXPECT_EQ(pose.x, report.match.x);
  EXPECT_EQ(pose.y, report.match.y);
  EXPECT_EQ(report.degeneracy.state, DegeneracyState::kTranslation);
}

TEST(ScanMatchTest, PaperLiteralSwitchesHard) {
  const TestCells cells = Corridor(0.);
  Random random(6);
  const std::vector<Eigen::Vector2d> seen =
      SeenFrom(Pose2(0.1, 0.02, 0.), CorridorPoints(0., &random));
  ScanMatchOptions options;
  options.translation_weight = 0.1;
  options.information.mode = DegeneracyMode::kPaperLiteral;
  options.information.paper_ratio = 1.5;
  MatchReport report;
  const Pose2 pose = MatchScan(options, Predict(Pose2(0.05, 0., 0.)),
                               Pose2(0.05, 0., 0.), seen, cells, &report);
  EXPECT_EQ(report.degeneracy.translation_weights(0), 0.);
  EXPECT_EQ(report.degeneracy.translation_weights(1), 1.);
  EXPECT_NEAR(pose.x, 0.05, 0.004);
  EXPECT_NEAR(pose.y, 0.02, 0.006);
  options.information.paper_ratio = 1e9;
  const Pose2 believed = MatchScan(options, Predict(Pose2(0.05, 0., 0.)),
                                   Pose2(0.05, 0., 0.), seen, cells, &report);
  EXPECT_NEAR(believed.x, report.match.x, 1e-12);
}

TEST(ScanMatchTest, AlwaysFiniteWhateverComesIn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const TestCells room = Room();
  const TestCells unknown = EmptyCells();
  const TestCells tiny(0.05, 0., 0., 1, 1, 0.1f);
  std::vector<Eigen::Vector2d> line;
  for (double x = -2.; x < 2.; x += 0.1) line.emplace_back(x, 2.);
  std::vector<Eigen::Vector2d> mixed = RoomPoints();
  mixed.emplace_back(nan, 0.);
  mixed.emplace_back(0., inf);
  mixed.emplace_back(1e300, 1e300);
  const std::vector<std::vector<Eigen::Vector2d>> clouds = {
      {},
      {{2.5, 0.}},
      {{2.5, 0.}, {0., 2.}},
      {{2.5, 0.}, {2.5, 0.}},
      {{nan, nan}},
      line,
      mixed,
      RoomPoints()};
  const std::vector<Pose2> poses = {Pose2(),
                                    Pose2(0.02, 0.01, 0.01),
                                    Pose2(nan, 0., 0.),
                                    Pose2(0., inf, 0.),
                                    Pose2(0., 0., nan),
                                    Pose2(1e8, -1e8, 3.),
                                    Pose2(0., 0., 100.)};
  std::vector<Prediction> predictions;
  for (const Pose2& pose : poses) {
    predictions.push_back(Predict(pose));
    predictions.push_back(Predict(pose, 0.05, 0.01));
    predictions.push_back(Predict(pose, nan, 1.));
    predictions.push_back(Predict(pose, 1e-12, 1e12));
  }
  for (const DegeneracyMode mode :
       {DegeneracyMode::kNoiseFloor, DegeneracyMode::kPaperLiteral}) {
    for (const TestCells* const cells : {&room, &unknown, &tiny}) {
      for (const auto& cloud : clouds) {
        for (const Prediction& prediction : predictions) {
          for (const Pose2& initial : poses) {
            ScanMatchOptions options;
            options.solver.max_iterations = 5;
            options.information.mode = mode;
            MatchReport report;
            const Pose2 pose =
                MatchScan(options, prediction, initial, cloud, *cells, &report);
            ASSERT_NO_FATAL_FAILURE(ExpectSane(pose, report));
          }
        }
      }
    }
  }
}

TEST(ScanMatchTest, WithoutInformationThePredictionIsTheResult) {
  const TestCells unknown = EmptyCells();
  ScanMatchOptions options;
  const Pose2 predicted(0.3, -0.2, 0.1);
  for (const auto& cloud : {std::vector<Eigen::Vector2d>{}, RoomPoints()}) {
    for (const Prediction& prediction :
         {Predict(predicted), Predict(predicted, 0.02, 0.01)}) {
      MatchReport report;
      const Pose2 pose =
          MatchScan(options, prediction, predicted, cloud, unknown, &report);
      EXPECT_NEAR(pose.x, 0.3, 1e-9);
      EXPECT_NEAR(pose.y, -0.2, 1e-9);
      EXPECT_NEAR(pose.theta, 0.1, 1e-9);
      EXPECT_EQ(report.degeneracy.state, DegeneracyState::kEverything);
      EXPECT_EQ(report.degrees_of_freedom, 0);
    }
  }
}

TEST(ScanMatchTest, AngleStaysOnTheTurnOfTheInitialOne) {
  const TestCells cells = Room();
  ScanMatchOptions options;
  options.rotation_weight = 0.1;
  const Pose2 truth(0.02, 0.01, 0.02);
  const std::vector<Eigen::Vector2d> seen = SeenFrom(truth, RoomPoints());
  for (const double turn : {-2. * kPi, 2. * kPi}) {
    const Pose2 pose =
        MatchScan(options, Predict(Pose2(0., 0., 0.), 0.05, 0.02),
                  Pose2(0., 0., turn), seen, cells, nullptr);
    EXPECT_NEAR(pose.theta, turn + 0.02, 0.01);
  }
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
