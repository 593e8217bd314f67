// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/pose_solver.h"

#include <cmath>
#include <limits>

#include "Eigen/LU"
#include "ceres/ceres.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

Eigen::Vector3d ToVector(const Pose2& pose) {
  return Eigen::Vector3d(pose.x, pose.y, pose.theta);
}

// 1/2 (p - minimum)^T H (p - minimum).
struct Quadratic {
  Eigen::Matrix3d hessian;
  Eigen::Vector3d minimum;
  PoseCost operator()(const Pose2& pose) const {
    PoseCost result;
    const Eigen::Vector3d difference = ToVector(pose) - minimum;
    result.hessian = hessian;
    result.gradient = hessian * difference;
    result.cost = 0.5 * difference.dot(result.gradient);
    return result;
  }
};

TEST(SolveDampedTest, SolvesWhatEigenSolves) {
  Eigen::Matrix3d hessian;
  hessian << 400., 30., -100., 30., 900., 200., -100., 200., 5000.;
  const Eigen::Vector3d damping(1., 2., 3.), gradient(1., -2., 3.);
  Eigen::Vector3d step;
  ASSERT_TRUE(SolveDamped(hessian, damping, gradient, &step));
  const Eigen::Matrix3d damped =
      hessian + Eigen::Matrix3d(damping.asDiagonal());
  EXPECT_NEAR((step + damped.inverse() * gradient).norm(), 0., 1e-14);
}

TEST(SolveDampedTest, RefusesWhatIsNotPositiveDefinite) {
  Eigen::Vector3d step;
  const Eigen::Vector3d gradient(1., 1., 1.);
  EXPECT_FALSE(SolveDamped(Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero(),
                           gradient, &step));
  EXPECT_FALSE(SolveDamped(Eigen::Matrix3d::Ones(), Eigen::Vector3d::Zero(),
                           gradient, &step));
  EXPECT_FALSE(SolveDamped(-Eigen::Matrix3d::Identity(),
                           Eigen::Vector3d::Zero(), gradient, &step));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d bad = Eigen::Matrix3d::Identity();
  bad(1, 1) = nan;
  EXPECT_FALSE(SolveDamped(bad, Eigen::Vector3d::Zero(), gradient, &step));
  EXPECT_FALSE(SolveDamped(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(),
                           nan * gradient, &step));
}

TEST(SolvePoseTest, FindsTheMinimumOfAQuadratic) {
  Quadratic quadratic;
  quadratic.hessian << 400., 30., -100., 30., 900., 200., -100., 200., 5000.;
  quadratic.minimum << 1., -2., 0.3;
  PoseSolverOptions options;
  const PoseSolution solution = SolvePose(options, Pose2(), quadratic);
  EXPECT_TRUE(solution.converged);
  EXPECT_LE(solution.iterations, 5);
  EXPECT_NEAR((ToVector(solution.pose) - quadratic.minimum).norm(), 0., 1e-4);
  EXPECT_EQ(solution.initial_cost, quadratic(Pose2()).cost);
  EXPECT_EQ(solution.at_pose.cost, quadratic(solution.pose).cost);
}

TEST(SolvePoseTest, RankDeficientCostMovesOnlyWhereItIsKnown) {
  Quadratic quadratic;
  // Only x + y is determined.
  quadratic.hessian << 100., 100., 0., 100., 100., 0., 0., 0., 0.;
  quadratic.minimum << 1., 1., 7.;
  const PoseSolution solution =
      SolvePose(PoseSolverOptions(), Pose2(0., 0., 0.5), quadratic);
  EXPECT_NEAR(solution.pose.x + solution.pose.y, 2., 1e-3);
  EXPECT_NEAR(solution.pose.x, solution.pose.y, 1e-3);
  EXPECT_EQ(solution.pose.theta, 0.5);
  // Nothing at all.
  quadratic.hessian.setZero();
  const PoseSolution still =
      SolvePose(PoseSolverOptions(), Pose2(1., 2., 3.), quadratic);
  EXPECT_TRUE(still.converged);
  EXPECT_EQ(still.iterations, 0);
  EXPECT_EQ(still.pose.x, 1.);
}

// A curved valley; compared with Ceres at the same settings.
struct ValleyResiduals {
  template <typename T>
  bool operator()(const T* const p, T* const residuals) const {
    residuals[0] = T(10.) * (p[1] - p[0] * p[0]);
    residuals[1] = T(1.) - p[0];
    residuals[2] = T(3.) * (p[2] - p[0] * p[1]);
    return true;
  }
};

PoseCost Valley(const Pose2& pose) {
  const Eigen::Vector3d residuals(10. * (pose.y - pose.x * pose.x), 1. - pose.x,
                                  3. * (pose.theta - pose.x * pose.y));
  Eigen::Matrix3d jacobian;
  jacobian << -20. * pose.x, 10., 0., -1., 0., 0., -3. * pose.y, -3. * pose.x,
      3.;
  PoseCost result;
  result.cost = 0.5 * residuals.squaredNorm();
  result.gradient = jacobian.transpose() * residuals;
  result.hessian = jacobian.transpose() * jacobian;
  return result;
}

TEST(SolvePoseTest, FollowsACurvedValleyAsCeresDoes) {
  PoseSolverOptions options;
  options.max_iterations = 100;
  const PoseSolution solution = SolvePose(options, Pose2(-1.2, 1., 0.), Valley);
  EXPECT_NEAR(solution.pose.x, 1., 1e-3);
  EXPECT_NEAR(solution.pose.y, 1., 1e-3);
  EXPECT_NEAR(solution.pose.theta, 1., 1e-3);

  double p[3] = {-1.2, 1., 0.};
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<ValleyResiduals, 3, 3>(
          new ValleyResiduals),
      nullptr, p);
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_QR;
  ceres_options.max_num_iterations = 200;
  ceres_options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, &problem, &summary);
  EXPECT_NEAR(solution.at_pose.cost, summary.final_cost, 1e-6);
  EXPECT_LE(solution.iterations,
            2 * static_cast<int>(summary.iterations.size()));
}

TEST(SolvePoseTest, NeverEndsAboveTheStart) {
  for (double x = -3.; x < 3.; x += 0.37) {
    for (int max_iterations = 0; max_iterations < 6; ++max_iterations) {
      PoseSolverOptions options;
      options.max_iterations = max_iterations;
      const PoseSolution solution =
          SolvePose(options, Pose2(x, 1., 0.), Valley);
      EXPECT_LE(solution.at_pose.cost, solution.initial_cost);
      EXPECT_LE(solution.iterations, 2 * max_iterations);
      EXPECT_LE(solution.successful_iterations, max_iterations);
    }
  }
}

TEST(SolvePoseTest, StopsAtNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto bad_everywhere = [nan](const Pose2&) {
    PoseCost result;
    result.cost = nan;
    return result;
  };
  PoseSolution solution =
      SolvePose(PoseSolverOptions(), Pose2(1., 2., 3.), bad_everywhere);
  EXPECT_EQ(solution.pose.x, 1.);
  EXPECT_FALSE(solution.converged);
  // Good at the start only: stays there.
  const auto bad_elsewhere = [nan](const Pose2& pose) {
    PoseCost result;
    result.cost = pose.x == 1. ? 5. : nan;
    result.gradient << 1., 0., 0.;
    result.hessian.setIdentity();
    return result;
  };
  solution = SolvePose(PoseSolverOptions(), Pose2(1., 2., 3.), bad_elsewhere);
  EXPECT_EQ(solution.pose.x, 1.);
  EXPECT_EQ(solution.at_pose.cost, 5.);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
