// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/degeneracy.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

DegeneracyOptions Options() {
  DegeneracyOptions options;
  options.translation_floor = 10.;
  options.rotation_floor = 10.;
  options.full_ratio = 10.;
  return options;
}

// Information of a wall whose normal has the given angle.
Eigen::Matrix3d Wall(const double angle, const double information) {
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  h.topLeftCorner<2, 2>() = information * normal * normal.transpose();
  h(2, 2) = information;
  return h;
}

TEST(DegeneracyTest, WorkedExampleOfTheHeader) {
  const Eigen::Vector3d diagonal(4., 400., 50.);
  const DegeneracyResult result =
      AnalyzeDegeneracy(Options(), diagonal.asDiagonal());
  EXPECT_EQ(result.translation_weights(0), 0.);
  EXPECT_EQ(result.translation_weights(1), 1.);
  EXPECT_EQ(result.state, DegeneracyState::kTranslation);
  EXPECT_NEAR(result.direction, 0., 1e-12);
  EXPECT_NEAR(result.ratio, 0.01, 1e-12);
}

TEST(DegeneracyTest, CorridorDirectionIsAlongTheWalls) {
  for (double angle = 0.05; angle < M_PI; angle += 0.2) {
    const DegeneracyResult result =
        AnalyzeDegeneracy(Options(), Wall(angle, 1e4));
    double along = angle + M_PI / 2.;
    if (along >= M_PI) along -= M_PI;
    EXPECT_NEAR(std::sin(result.direction - along), 0., 1e-9);
    EXPECT_GE(result.direction, 0.);
    EXPECT_LT(result.direction, M_PI);
    EXPECT_EQ(result.state, DegeneracyState::kTranslation);
  }
}

TEST(DegeneracyTest, SchurComplementRemovesWhatRotationExplains) {
  // y and theta are seen only together: neither is determined alone.
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  h(0, 0) = 1000.;
  h(1, 1) = 1000.;
  h(1, 2) = h(2, 1) = 1000.;
  h(2, 2) = 1000.;
  const DegeneracyResult result = AnalyzeDegeneracy(Options(), h);
  EXPECT_NEAR(result.eigenvalues(0), 0., 1e-9);
  EXPECT_NEAR(result.eigenvalues(1), 1000., 1e-9);
  EXPECT_NEAR(result.rotation_information, 0., 1e-9);
  EXPECT_EQ(result.rotation_weight, 0.);
}

TEST(DegeneracyTest, WeightIsSmoothAndMonotonic) {
  double last = -1.;
  for (double information = 5.; information < 200.; information *= 1.02) {
    const Eigen::Vector3d diagonal(information, 1e6, 1e6);
    const double weight = AnalyzeDegeneracy(Options(), diagonal.asDiagonal())
                              .translation_weights(0);
    EXPECT_GE(weight, last);
    if (last >= 0.) {
      EXPECT_LT(weight - last, 0.02);
    }
    last = weight;
  }
  EXPECT_EQ(last, 1.);
}

TEST(DegeneracyTest, NothingSeenMeansNoBelief) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d bad = Eigen::Matrix3d::Identity();
  bad(0, 1) = nan;
  for (const Eigen::Matrix3d& h :
       {Eigen::Matrix3d(Eigen::Matrix3d::Zero()), bad}) {
    const DegeneracyResult result = AnalyzeDegeneracy(Options(), h);
    EXPECT_EQ(result.state, DegeneracyState::kEverything);
    EXPECT_TRUE(result.eigenvectors.allFinite());
    EXPECT_EQ(result.translation_weights, Eigen::Vector2d(0., 0.));
    EXPECT_EQ(result.rotation_weight, 0.);
  }
}

TEST(DegeneracyTest, CircularRoomLosesOnlyTheHeading) {
  const Eigen::Vector3d diagonal(1e4, 1e4, 1.);
  EXPECT_EQ(AnalyzeDegeneracy(Options(), diagonal.asDiagonal()).state,
            DegeneracyState::kRotation);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
