// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/scan_curvature.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

TEST(ScaledMotionTest, TurnsAboutTheCentroid) {
  const std::vector<Eigen::Vector2d> points = {
      {1., 2.}, {3., 2.}, {1., 4.}, {3., 4.}};
  const Pose2 pose(0.5, -0.3, 0.7);
  const ScaledMotion motion(points, 0.05, pose);
  const Eigen::Vector2d centroid(2., 3.);
  const Pose2 turned = motion.Moved(Eigen::Vector3d(0., 0., 3.));
  EXPECT_NEAR(((turned * centroid) - (pose * centroid)).norm(), 0., 1e-12);
  // One cell of turning moves the points one cell (root mean square).
  EXPECT_NEAR(turned.theta - pose.theta, 3. * 0.05 / std::sqrt(2.), 1e-12);
  const Pose2 moved = motion.Moved(Eigen::Vector3d(2., -4., 0.));
  EXPECT_NEAR(moved.x - pose.x, 0.1, 1e-12);
  EXPECT_NEAR(moved.y - pose.y, -0.2, 1e-12);
  EXPECT_EQ(moved.theta, pose.theta);
}

TEST(ScaledMotionTest, LinearPartAgreesWithDifferences) {
  const ScaledMotion motion({{1., 2.}, {3., 7.}, {-4., 1.}}, 0.05,
                            Pose2(1., 2., -0.4));
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
    const Pose2 ahead = motion.Moved(step), behind = motion.Moved(-step);
    const Eigen::Vector3d slope =
        Eigen::Vector3d(ahead.x - behind.x, ahead.y - behind.y,
                        ahead.theta - behind.theta) /
        2e-6;
    EXPECT_NEAR((slope - motion.ToPose().col(k)).norm(), 0., 1e-8);
  }
  EXPECT_TRUE((motion.ToPose() * motion.FromPose())
                  .isApprox(Eigen::Matrix3d::Identity()));
}

TEST(ScaledMotionTest, FewPointsStayFinite) {
  for (const auto& points : {std::vector<Eigen::Vector2d>{},
                             std::vector<Eigen::Vector2d>{{2., 1.}}}) {
    const ScaledMotion motion(points, 0.05, Pose2(1., 2., 3.));
    EXPECT_TRUE(motion.ToPose().allFinite());
    EXPECT_TRUE(motion.FromPose().allFinite());
    // The spread counts as four cells at least.
    EXPECT_NEAR(motion.ToPose()(2, 2), 0.25, 1e-12);
  }
}

TEST(MeasureCurvatureTest, QuadraticIsExact) {
  Eigen::Matrix3d q;
  q << 3., 1., 0.5, 1., 2., -0.3, 0.5, -0.3, 1.;
  int calls = 0;
  const auto half_mean_squares = [&](const Eigen::Vector3d& motion) {
    ++calls;
    return 7. + 0.5 * motion.dot(q * motion);
  };
  // Whatever the first guess of the axes.
  for (const Eigen::Matrix3d& guess :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), q,
        Eigen::Matrix3d(Eigen::Vector3d(3., 1., 2.).asDiagonal())}) {
    calls = 0;
    const ScanCurvature curvature =
        MeasureCurvature(half_mean_squares, guess, 2.);
    EXPECT_EQ(calls, 25);
    const Eigen::Matrix3d again = curvature.axes *
                                  curvature.values.asDiagonal() *
                                  curvature.axes.transpose();
    EXPECT_NEAR((again - q).norm(), 0., 1e-10);
    EXPECT_LE(curvature.values(0), curvature.values(1));
    EXPECT_LE(curvature.values(1), curvature.values(2));
    // At a minimum both measures are one.
    EXPECT_NEAR((curvature.rises - curvature.values).norm(), 0., 1e-10);
  }
}

TEST(MeasureCurvatureTest, RiseSeesASlopeWithoutCurvature) {
  const auto slope = [](const Eigen::Vector3d& motion) {
    return 0.3 * motion.x() + 0.5 * motion.y() * motion.y();
  };
  const ScanCurvature curvature =
      MeasureCurvature(slope, Eigen::Vector3d(1., 2., 0.5).asDiagonal(), 2.);
  bool found = false;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(curvature.axes(0, k)) < 0.9) continue;
    found = true;
    EXPECT_NEAR(curvature.values(k), 0., 1e-12);
    EXPECT_NEAR(curvature.rises(k), 2. * 0.3 * 2. / 4., 1e-9);
  }
  EXPECT_TRUE(found);
}

TEST(MeasureCurvatureTest, NonsenseGivesFiniteAxes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto bad = [nan](const Eigen::Vector3d&) { return nan; };
  const ScanCurvature curvature =
      MeasureCurvature(bad, nan * Eigen::Matrix3d::Identity(), 2.);
  EXPECT_TRUE(curvature.axes.allFinite());
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
