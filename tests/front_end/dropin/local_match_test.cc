// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_match.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Facing north, a metre ahead is a metre north, and what is uncertain ahead is
// uncertain to the north.
TEST(LocalMatchTest, PredictionsAreTurnedIntoTheLocalFrame) {
  const Eigen::Matrix3d ahead =
      Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  const scan_matching::Prediction prediction =
      ToPrediction(Pose2(2., 3., M_PI / 2.), Pose2(1., 0., 0.1), ahead);
  EXPECT_NEAR(prediction.pose.x, 2., 1e-12);
  EXPECT_NEAR(prediction.pose.y, 4., 1e-12);
  EXPECT_NEAR(prediction.pose.theta, M_PI / 2. + 0.1, 1e-12);
  const Eigen::Matrix3d north =
      Eigen::Vector3d(0.01, 0.04, 0.0025).asDiagonal();
  EXPECT_TRUE(prediction.covariance.isApprox(north, 1e-9));
}

TEST(LocalMatchTest, ChiSquareCountsStandardDeviations) {
  scan_matching::Prediction prediction;
  prediction.pose = Pose2(1., 2., M_PI - 0.05);
  prediction.covariance = Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  EXPECT_NEAR(ChiSquare(prediction, prediction.pose), 0., 1e-12);
  // One, two and, across the wrap of angles, two standard deviations.
  EXPECT_NEAR(ChiSquare(prediction, Pose2(1.2, 1.8, -M_PI + 0.05)), 9., 1e-9);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
