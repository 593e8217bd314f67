// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/occupied_space_cost_function_2d.h"

#include <cmath>
#include <limits>

#include "cartographer/mapping/internal/2d/scan_matching/rotation_delta_cost_functor_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/translation_delta_cost_functor_2d.h"
#include "ceres/cubic_interpolation.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

// The grid as ceres::BiCubicInterpolator wants it, with all indices shifted.
class Samples {
 public:
  enum { DATA_DIMENSION = 1 };
  enum { kShift = std::numeric_limits<int>::max() / 4 };
  explicit Samples(const Grid2D& grid) : grid_(grid) {}
  void GetValue(const int row, const int column, double* const value) const {
    const Eigen::Array2i index(column - kShift, row - kShift);
    *value = grid_.limits().Contains(index) ? grid_.GetCorrespondenceCost(index)
                                            : kMaxCorrespondenceCost;
  }

 private:
  const Grid2D& grid_;
};

class OccupiedSpaceCostFunctionTest : public ::testing::Test {
 protected:
  OccupiedSpaceCostFunctionTest() : grid_(test::RoomGrid(&tables_, 0.05, 2)) {}

  double Residual(const sensor::PointCloud& cloud, const double x,
                  const double y, const double theta) {
    const std::unique_ptr<ceres::CostFunction> cost(
        CreateOccupiedSpaceCostFunction2D(1., cloud, *grid_));
    const double pose[3] = {x, y, theta};
    const double* parameters[] = {pose};
    double residual = -1.;
    EXPECT_TRUE(cost->Evaluate(parameters, &residual, nullptr));
    return residual;
  }

  ValueConversionTables tables_;
  std::unique_ptr<ProbabilityGrid> grid_;
};

TEST_F(OccupiedSpaceCostFunctionTest, CellCentresHaveTheirCells) {
  const sensor::PointCloud origin = test::Cloud({{0.f, 0.f}});
  for (const Eigen::Array2i& index :
       XYIndexRangeIterator(Eigen::Array2i(50, 30), Eigen::Array2i(90, 60))) {
    const double x = grid_->limits().max().x() - 0.05 * (index.y() + 0.5);
    const double y = grid_->limits().max().y() - 0.05 * (index.x() + 0.5);
    EXPECT_NEAR(Residual(origin, x, y, 0.), grid_->GetCorrespondenceCost(index),
                1e-6);
  }
}

TEST_F(OccupiedSpaceCostFunctionTest, OutsideIsUnlikely) {
  const sensor::PointCloud origin = test::Cloud({{0.f, 0.f}});
  EXPECT_FLOAT_EQ(Residual(origin, 1000., 0., 0.), 0.9f);
  EXPECT_FLOAT_EQ(Residual(origin, 0., -1e30, 0.), 0.9f);
  EXPECT_FLOAT_EQ(
      Residual(origin, std::numeric_limits<double>::quiet_NaN(), 0., 0.), 0.9f);
}

// To the last bit: Jets through the homogeneous transform and the shifted,
// interpolated grid are how Cartographer evaluates the same cost.
TEST_F(OccupiedSpaceCostFunctionTest, AgreesWithCeresInterpolation) {
  const Samples samples(*grid_);
  const ceres::BiCubicInterpolator<Samples> interpolator(samples);
  const MapLimits& limits = grid_->limits();
  const sensor::PointCloud cloud = test::Room();
  const std::unique_ptr<ceres::CostFunction> cost(
      CreateOccupiedSpaceCostFunction2D(2.5, cloud, *grid_));
  ASSERT_EQ(cost->num_residuals(), static_cast<int>(cloud.size()));
  const double pose[3] = {0.43, -0.61, 0.3};
  const double* parameters[] = {pose};
  std::vector<double> residuals(cloud.size());
  std::vector<double> jacobian(3 * cloud.size());
  double* jacobians[] = {jacobian.data()};
  ASSERT_TRUE(cost->Evaluate(parameters, residuals.data(), jacobians));

  using Jet = ceres::Jet<double, 3>;
  Eigen::Matrix<Jet, 3, 3> transform;
  transform << Eigen::Rotation2D<Jet>(Jet(pose[2], 2)).toRotationMatrix(),
      Eigen::Matrix<Jet, 2, 1>(Jet(pose[0], 0), Jet(pose[1], 1)), Jet(0.),
      Jet(0.), Jet(1.);
  for (size_t i = 0; i != cloud.size(); ++i) {
    const Eigen::Matrix<Jet, 3, 1> point(Jet(cloud[i].position.x()),
                                         Jet(cloud[i].position.y()), Jet(1.));
    const Eigen::Matrix<Jet, 3, 1> world = transform * point;
    Jet expected;
    interpolator.Evaluate((limits.max().x() - world[0]) / limits.resolution() -
                              0.5 + static_cast<double>(Samples::kShift),
                          (limits.max().y() - world[1]) / limits.resolution() -
                              0.5 + static_cast<double>(Samples::kShift),
                          &expected);
    expected = 2.5 * expected;
    ASSERT_EQ(residuals[i], expected.a) << i;
    for (int k = 0; k != 3; ++k) {
      ASSERT_EQ(jacobian[3 * i + k], expected.v[k]) << i;
    }
  }

  // The same without Jacobian, where Cartographer calculates in doubles.
  ASSERT_TRUE(cost->Evaluate(parameters, residuals.data(), nullptr));
  Eigen::Matrix3d transform_of_doubles;
  transform_of_doubles << Eigen::Rotation2Dd(pose[2]).toRotationMatrix(),
      Eigen::Vector2d(pose[0], pose[1]), 0., 0., 1.;
  for (size_t i = 0; i != cloud.size(); ++i) {
    const Eigen::Vector3d world =
        transform_of_doubles *
        Eigen::Vector3d(cloud[i].position.x(), cloud[i].position.y(), 1.);
    double expected;
    interpolator.Evaluate((limits.max().x() - world[0]) / limits.resolution() -
                              0.5 + static_cast<double>(Samples::kShift),
                          (limits.max().y() - world[1]) / limits.resolution() -
                              0.5 + static_cast<double>(Samples::kShift),
                          &expected);
    ASSERT_EQ(residuals[i], 2.5 * expected) << i;
  }
}

TEST(DeltaCostFunctorsTest, ScaledDifferences) {
  const std::unique_ptr<ceres::CostFunction> translation(
      TranslationDeltaCostFunctor2D::CreateAutoDiffCostFunction(
          3., Eigen::Vector2d(1., 2.)));
  const std::unique_ptr<ceres::CostFunction> rotation(
      RotationDeltaCostFunctor2D::CreateAutoDiffCostFunction(4., 0.5));
  const double pose[3] = {1.5, 1., 7.};
  const double* parameters[] = {pose};
  double residuals[2];
  double jacobian[6];
  double* jacobians[] = {jacobian};
  ASSERT_TRUE(translation->Evaluate(parameters, residuals, jacobians));
  EXPECT_DOUBLE_EQ(residuals[0], 1.5);
  EXPECT_DOUBLE_EQ(residuals[1], -3.);
  const double expected[6] = {3., 0., 0., 0., 3., 0.};
  for (int i = 0; i != 6; ++i) EXPECT_DOUBLE_EQ(jacobian[i], expected[i]);
  ASSERT_TRUE(rotation->Evaluate(parameters, residuals, jacobians));
  // Not wrapped.
  EXPECT_DOUBLE_EQ(residuals[0], 26.);
  EXPECT_DOUBLE_EQ(jacobian[2], 4.);
}

}  // namespace
}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
