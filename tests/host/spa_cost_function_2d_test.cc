// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"

#include <array>
#include <cmath>
#include <memory>

#include "cartographer/mapping/internal/optimization/cost_functions/landmark_cost_function_2d.h"
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

// Landmarks.

common::Time At(const int64 ticks) { return common::FromUniversal(ticks); }

NodeSpec2D Node(const int64 ticks) {
  return NodeSpec2D{At(ticks), transform::Rigid2d::Identity(),
                    transform::Rigid2d::Identity(),
                    Eigen::Quaterniond::Identity()};
}

TEST(LandmarkCostFunction2DTest, HalfWayBetweenTwoNodes) {
  const LandmarkCostFunction2D::LandmarkObservation observation{
      0, At(5), transform::Rigid3d::Translation(Eigen::Vector3d(1., 1., 1.)),
      1., 2.};
  const std::unique_ptr<ceres::CostFunction> cost_function(
      LandmarkCostFunction2D::CreateAutoDiffCostFunction(observation, Node(0),
                                                         Node(10)));
  const Values previous{{2., 0., 0.}};
  const Values next{{0., 2., 0.}};
  const std::array<double, 4> rotation{{1., 0., 0., 0.}};
  const Values translation{{1., 2., 2.}};
  const double* parameters[] = {previous.data(), next.data(), rotation.data(),
                                translation.data()};
  std::array<double, 6> residuals;
  EXPECT_TRUE(cost_function->Evaluate(parameters, residuals.data(), nullptr));
  // The robot is at (1, 1, 0), so the landmark should be at (2, 2, 1).
  const std::array<double, 6> expected{{1., 0., -1., 0., 0., 0.}};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(residuals[i], expected[i], 1e-9);
}

TEST(LandmarkCostFunction2DTest, RotationCountsByItsWeight) {
  const LandmarkCostFunction2D::LandmarkObservation observation{
      0, At(5), transform::Rigid3d::Identity(), 1., 2.};
  const std::unique_ptr<ceres::CostFunction> cost_function(
      LandmarkCostFunction2D::CreateAutoDiffCostFunction(observation, Node(0),
                                                         Node(10)));
  // Half way between headings 0 and 1, the landmark's is 0.7.
  const Values previous{{0., 0., 0.}};
  const Values next{{0., 0., 1.}};
  const std::array<double, 4> rotation{
      {std::cos(0.35), 0., 0., std::sin(0.35)}};
  const Values translation{{0., 0., 0.}};
  const double* parameters[] = {previous.data(), next.data(), rotation.data(),
                                translation.data()};
  std::array<double, 6> residuals;
  EXPECT_TRUE(cost_function->Evaluate(parameters, residuals.data(), nullptr));
  EXPECT_NEAR(std::abs(residuals[5]), 2. * 0.2, 1e-9);
}

TEST(CostHelpersTest, SlerpTakesTheShorterArc) {
  const std::array<double, 4> start{{1., 0., 0., 0.}};
  // The same rotation as (cos 0.5, 0, 0, sin 0.5), written with the other sign.
  const std::array<double, 4> end{{-std::cos(0.5), 0., 0., -std::sin(0.5)}};
  const auto middle = SlerpQuaternions(start.data(), end.data(), 0.5);
  EXPECT_NEAR(middle[0], std::cos(0.25), 1e-12);
  EXPECT_NEAR(middle[3], std::sin(0.25), 1e-12);
  // Nearly equal ones are interpolated linearly.
  const std::array<double, 4> close{{std::cos(1e-4), 0., 0., std::sin(1e-4)}};
  EXPECT_NEAR(SlerpQuaternions(start.data(), close.data(), 0.25)[3], 0.25e-4,
              1e-12);
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
