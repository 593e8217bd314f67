// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/landmark_cost_function_2d.h"

#include <array>
#include <cmath>
#include <memory>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Values = std::array<double, 3>;

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
