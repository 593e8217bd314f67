// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/node_weights.h"

#include <cmath>
#include <limits>

#include "Eigen/Geometry"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

Eigen::Matrix3d Diagonal(const double x, const double y, const double theta) {
  return Eigen::Vector3d(x, y, theta).asDiagonal();
}

// Turned by 30 degrees in the plane.
Eigen::Matrix3d Turned(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.5236, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return turn * matrix * turn.transpose();
}

TEST(NodeWeightsTest, TwoSigmasAreThoseOfTheWorstDirection) {
  const Eigen::Vector2d sigmas =
      TwoSigmas(Turned(Diagonal(0.09, 0.0001, 0.0004)));
  EXPECT_NEAR(sigmas(0), 0.3, 1e-9);
  EXPECT_NEAR(sigmas(1), 0.02, 1e-12);
}

TEST(NodeWeightsTest, OnlyWhatIsNotKnownIsWeakened) {
  NodeWeightOptions options;
  options.translation_sigma = 0.01;
  options.rotation_sigma = 0.002;
  // Along 0.1 m, across 0.005 m, heading 0.004 rad.
  const Eigen::Matrix3d covariance = Diagonal(1e-2, 2.5e-5, 1.6e-5);
  EXPECT_LT(
      (RelativeInformation(options, covariance) - Diagonal(0.01, 1., 0.25))
          .norm(),
      1e-12);
  EXPECT_LT((RelativeInformation(options, Turned(covariance)) -
             Turned(Diagonal(0.01, 1., 0.25)))
                .norm(),
            1e-12);
  options.form = NodeWeightForm::kTwoScalars;
  EXPECT_LT((RelativeInformation(options, Turned(covariance)) -
             Diagonal(0.01, 0.01, 0.25))
                .norm(),
            1e-9);
}

TEST(NodeWeightsTest, BoundedAndFinite) {
  NodeWeightOptions options;
  options.min_ratio = 0.01;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const NodeWeightForm form :
       {NodeWeightForm::kFull, NodeWeightForm::kTwoScalars}) {
    options.form = form;
    EXPECT_LT((RelativeInformation(options, Diagonal(1e6, 1e6, 1e6)) -
               Diagonal(0.01, 0.01, 0.01))
                  .norm(),
              1e-12);
    EXPECT_LT((RelativeInformation(options, Eigen::Matrix3d::Zero()) -
               Eigen::Matrix3d::Identity())
                  .norm(),
              1e-12);
    EXPECT_LT((RelativeInformation(options, Diagonal(infinity, 1., 1.)) -
               Diagonal(0.01, 0.01, 0.01))
                  .norm(),
              1e-12);
  }
}

TEST(NodeWeightsTest, UncertaintyGrowsWhereScansAreBlind) {
  ScanUncertainty uncertainty;
  const Eigen::Matrix3d motion = Diagonal(0.02 * 0.02, 0.02 * 0.02, 1e-4);
  // Nothing along x; across and in heading as good as a scan is.
  const Eigen::Matrix3d scan = Diagonal(0., 1. / (0.005 * 0.005), 1e6);
  for (int i = 1; i <= 25; ++i) {
    // Two scans a node: the motion is since the node.
    uncertainty.Add(0.25 * motion, scan);
    uncertainty.Add(motion, scan);
    uncertainty.Keep();
    EXPECT_NEAR(uncertainty.covariance()(0, 0), i * 0.0004, 1e-6);
    EXPECT_LT(uncertainty.covariance()(1, 1), 0.005 * 0.005);
    EXPECT_LT(uncertainty.covariance()(2, 2), 1e-6);
  }
  // 25 steps of 2 cm: 10 cm. A scan that sees the end of the corridor ends it.
  EXPECT_NEAR(TwoSigmas(uncertainty.covariance())(0), 0.1, 1e-3);
  uncertainty.Add(motion, Diagonal(1e4, 4e4, 1e6));
  EXPECT_NEAR(TwoSigmas(uncertainty.covariance())(0), 0.01, 1e-3);
}

TEST(NodeWeightsTest, WhatIsNotFiniteCountsAsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ScanUncertainty uncertainty;
  uncertainty.Add(Diagonal(1e-4, 1e-4, 1e-4), Diagonal(nan, 1., 1.));
  EXPECT_NEAR(uncertainty.covariance()(0, 0), 1e-4, 1e-8);
  uncertainty.Add(Diagonal(nan, 1., 1.), Diagonal(4e4, 4e4, 1e6));
  EXPECT_TRUE(uncertainty.covariance().allFinite());
  EXPECT_NEAR(uncertainty.covariance()(0, 0), 1. / 4e4, 1e-7);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
