// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"

#include <array>
#include <cmath>
#include <memory>

#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Pose = PoseGraphInterface::Constraint::Pose;
using Values = std::array<double, 3>;

struct Evaluation {
  Values residuals;
  std::array<double, 9> start_jacobian;
  std::array<double, 9> end_jacobian;
};

Evaluation Evaluate(ceres::CostFunction* const raw_cost_function,
                    const Values& start, const Values& end) {
  const std::unique_ptr<ceres::CostFunction> cost_function(raw_cost_function);
  Evaluation result;
  const double* parameters[] = {start.data(), end.data()};
  double* jacobians[] = {result.start_jacobian.data(),
                         result.end_jacobian.data()};
  EXPECT_TRUE(
      cost_function->Evaluate(parameters, result.residuals.data(), jacobians));
  return result;
}

const Pose kPose{transform::Rigid3d(Eigen::Vector3d(1.1, -0.4, 9.),
                                    Eigen::Quaterniond(Eigen::AngleAxisd(
                                        0.2, Eigen::Vector3d::UnitZ()))),
                 10., 5.};

TEST(SpaCostFunction2DTest, HandComputedResidual) {
  // Seen from (0, 0) heading along y, (0, 1) is one metre ahead.
  const auto evaluation =
      Evaluate(CreateAnalyticalSpaCostFunction(kPose), {{0., 0., M_PI / 2}},
               {{0., 1., M_PI / 2 + 0.3}});
  EXPECT_NEAR(evaluation.residuals[0], 10. * (1.1 - 1.), 1e-9);
  EXPECT_NEAR(evaluation.residuals[1], 10. * -0.4, 1e-9);
  EXPECT_NEAR(evaluation.residuals[2], 5. * (0.2 - 0.3), 1e-9);
}

TEST(SpaCostFunction2DTest, AngleIsWrapped) {
  const auto evaluation = Evaluate(CreateAnalyticalSpaCostFunction(kPose),
                                   {{0., 0., 3.}}, {{1., 0., -3.}});
  EXPECT_NEAR(evaluation.residuals[2], 5. * (0.2 - (2. * M_PI - 6.)), 1e-9);
}

TEST(SpaCostFunction2DTest, AnalyticalAgreesWithAutoDiff) {
  const std::array<Values, 4> poses{
      {{{0., 0., 0.}}, {{1., 1., 1.}}, {{-3., 2., -2.5}}, {{100., -50., 40.}}}};
  for (const Values& start : poses) {
    for (const Values& end : poses) {
      const auto analytical =
          Evaluate(CreateAnalyticalSpaCostFunction(kPose), start, end);
      const auto auto_diff =
          Evaluate(CreateAutoDiffSpaCostFunction(kPose), start, end);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(analytical.residuals[i], auto_diff.residuals[i], 1e-9);
      }
      for (int i = 0; i < 9; ++i) {
        EXPECT_NEAR(analytical.start_jacobian[i], auto_diff.start_jacobian[i],
                    1e-9);
        EXPECT_NEAR(analytical.end_jacobian[i], auto_diff.end_jacobian[i],
                    1e-9);
      }
    }
  }
}

TEST(SpaCostFunction2DTest, JacobianByFiniteDifferences) {
  const Values start{{0.3, -0.2, 0.7}};
  const Values end{{1.2, 0.5, 1.1}};
  const auto center =
      Evaluate(CreateAnalyticalSpaCostFunction(kPose), start, end);
  for (int k = 0; k < 3; ++k) {
    constexpr double kStep = 1e-6;
    Values moved = start;
    moved[k] += kStep;
    const auto by_start =
        Evaluate(CreateAnalyticalSpaCostFunction(kPose), moved, end);
    moved = end;
    moved[k] += kStep;
    const auto by_end =
        Evaluate(CreateAnalyticalSpaCostFunction(kPose), start, moved);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(center.start_jacobian[3 * i + k],
                  (by_start.residuals[i] - center.residuals[i]) / kStep, 1e-4);
      EXPECT_NEAR(center.end_jacobian[3 * i + k],
                  (by_end.residuals[i] - center.residuals[i]) / kStep, 1e-4);
    }
  }
}

TEST(SpaCostFunction2DTest, WorksWithoutJacobians) {
  const std::unique_ptr<ceres::CostFunction> cost_function(
      CreateAnalyticalSpaCostFunction(kPose));
  const Values start{{0., 0., 0.}};
  const double* parameters[] = {start.data(), start.data()};
  Values residuals;
  EXPECT_TRUE(cost_function->Evaluate(parameters, residuals.data(), nullptr));
  EXPECT_NEAR(residuals[0], 11., 1e-9);
  double* jacobians[] = {nullptr, nullptr};
  EXPECT_TRUE(cost_function->Evaluate(parameters, residuals.data(), jacobians));
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
