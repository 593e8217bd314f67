// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/planar_matrix.h"

#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(PlanarMatrixTest, RotationTurnsCovariances) {
  const Eigen::Matrix3d rotation = PlanarRotation(kPi / 2.);
  // What is uncertain along x of the turned frame is so along y.
  const Eigen::Matrix3d covariance =
      Eigen::Vector3d(4., 1., 9.).asDiagonal().toDenseMatrix();
  const Eigen::Matrix3d expected =
      Eigen::Vector3d(1., 4., 9.).asDiagonal().toDenseMatrix();
  EXPECT_TRUE(
      (rotation * covariance * rotation.transpose()).isApprox(expected, 1e-15));
  const Eigen::Matrix3d quarter = PlanarRotation(kPi / 6.);
  EXPECT_NEAR(quarter(0, 0), std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(quarter(0, 1), -0.5, 1e-15);
  EXPECT_NEAR(quarter(1, 0), 0.5, 1e-15);
  EXPECT_EQ(quarter(2, 2), 1.);
  EXPECT_TRUE(quarter.transpose().isApprox(PlanarRotation(-kPi / 6.), 1e-15));
}

TEST(PlanarMatrixTest, Symmetric) {
  Eigen::Matrix3d matrix;
  matrix << 1., 2., 3., 4., 5., 6., 7., 8., 9.;
  Eigen::Matrix3d expected;
  expected << 1., 3., 5., 3., 5., 7., 5., 7., 9.;
  EXPECT_EQ(Symmetric(matrix), expected);
  EXPECT_EQ(Symmetric(expected), expected);
}

}  // namespace
}  // namespace cartographer_ext
