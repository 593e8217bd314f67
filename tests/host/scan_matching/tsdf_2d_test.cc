// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/tsdf_2d.h"

#include <cmath>

#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/interpolated_tsdf_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/tsdf_match_cost_function_2d.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

class TSDF2DTest : public ::testing::Test {
 protected:
  TSDF2DTest()
      : tsdf_(MapLimits(1., Eigen::Vector2d(4., 4.), CellLimits(6, 8)), 2.f,
              10.f, &tables_) {}
  ValueConversionTables tables_;
  TSDF2D tsdf_;
};

TEST_F(TSDF2DTest, UnknownCells) {
  EXPECT_EQ(tsdf_.GetGridType(), GridType::TSDF);
  EXPECT_FLOAT_EQ(tsdf_.GetTSD({1, 1}), -2.f);
  EXPECT_FLOAT_EQ(tsdf_.GetWeight({1, 1}), 0.f);
  EXPECT_FLOAT_EQ(tsdf_.GetCorrespondenceCost({1, 1}), 2.f);
  EXPECT_FLOAT_EQ(tsdf_.GetTSD({-1, 1}), -2.f);
  EXPECT_FLOAT_EQ(tsdf_.GetWeight({6, 1}), 0.f);
  EXPECT_FLOAT_EQ(tsdf_.GetCorrespondenceCost({6, 1}), 2.f);
}

TEST_F(TSDF2DTest, SetsEachCellOncePerUpdate) {
  tsdf_.SetCell({2, 3}, 0.5f, 4.f);
  EXPECT_TRUE(tsdf_.CellIsUpdated({2, 3}));
  EXPECT_FALSE(tsdf_.CellIsUpdated({2, 4}));
  tsdf_.SetCell({2, 3}, 1.5f, 8.f);
  EXPECT_NEAR(tsdf_.GetTSD({2, 3}), 0.5, 1e-4);
  EXPECT_NEAR(tsdf_.GetWeight({2, 3}), 4., 1e-3);
  tsdf_.FinishUpdate();
  EXPECT_FALSE(tsdf_.CellIsUpdated({2, 3}));
  tsdf_.SetCell({2, 3}, -7.f, 80.f);
  EXPECT_FLOAT_EQ(tsdf_.GetTSDAndWeight({2, 3}).first, -2.f);
  EXPECT_FLOAT_EQ(tsdf_.GetTSDAndWeight({2, 3}).second, 10.f);
}

TEST_F(TSDF2DTest, GrowsAndCropsBothArrays) {
  tsdf_.SetCell({2, 3}, 0.5f, 4.f);
  tsdf_.SetCell({3, 3}, -0.25f, 2.f);
  tsdf_.FinishUpdate();
  const Eigen::Vector2f place = tsdf_.limits().GetCellCenter({2, 3});
  tsdf_.GrowLimits({5.f, 0.f});
  EXPECT_EQ(tsdf_.limits().cell_limits().num_x_cells, 12);
  const Eigen::Array2i index = tsdf_.limits().GetCellIndex(place);
  EXPECT_NEAR(tsdf_.GetTSD(index), 0.5, 1e-4);
  EXPECT_NEAR(tsdf_.GetWeight(index), 4., 1e-3);

  const auto cropped = tsdf_.ComputeCroppedGrid();
  ASSERT_EQ(cropped->GetGridType(), GridType::TSDF);
  const TSDF2D& small = static_cast<const TSDF2D&>(*cropped);
  EXPECT_EQ(small.limits().cell_limits().num_x_cells, 2);
  EXPECT_EQ(small.limits().cell_limits().num_y_cells, 1);
  EXPECT_NEAR(small.GetTSD({1, 0}), -0.25, 1e-4);
  EXPECT_NEAR(small.GetWeight({1, 0}), 2., 1e-3);
}

TEST_F(TSDF2DTest, ProtoRoundTripThroughASubmap) {
  tsdf_.SetCell({2, 3}, 0.5f, 4.f);
  tsdf_.FinishUpdate();
  proto::Submap2D proto;
  *proto.mutable_local_pose() =
      transform::ToProto(transform::Rigid3d::Identity());
  *proto.mutable_grid() = tsdf_.ToProto();
  EXPECT_FLOAT_EQ(proto.grid().tsdf_2d().truncation_distance(), 2.f);
  EXPECT_FLOAT_EQ(proto.grid().tsdf_2d().max_weight(), 10.f);
  EXPECT_FLOAT_EQ(proto.grid().min_correspondence_cost(), -2.f);
  const Submap2D submap(proto, &tables_);
  ASSERT_EQ(submap.grid()->GetGridType(), GridType::TSDF);
  EXPECT_EQ(submap.ToProto(true).submap_2d().SerializeAsString(),
            proto.SerializeAsString());
  proto::SubmapQuery::Response response;
  submap.ToResponseProto(transform::Rigid3d::Identity(), &response);
  EXPECT_EQ(response.textures(0).width(), 1);
}

// Distances to the line x = 1, all with weight 5.
class TSDFMatchingTest : public TSDF2DTest {
 protected:
  TSDFMatchingTest() {
    for (const Eigen::Array2i& index : XYIndexRangeIterator(CellLimits(6, 8))) {
      const float x = tsdf_.limits().GetCellCenter(index).x();
      tsdf_.SetCell(index, 1.f - x, 5.f);
    }
    tsdf_.FinishUpdate();
  }
};

TEST_F(TSDFMatchingTest, InterpolatesBetweenCentres) {
  const scan_matching::InterpolatedTSDF2D interpolated(tsdf_);
  EXPECT_NEAR(interpolated.GetCorrespondenceCost(1.5, 0.5), -0.5, 1e-3);
  EXPECT_NEAR(interpolated.GetCorrespondenceCost(0.7, 0.9), 0.3, 1e-3);
  EXPECT_NEAR(interpolated.GetWeight(0.7, 0.9), 5., 1e-3);
  using Jet = ceres::Jet<double, 2>;
  const Jet cost = interpolated.GetCorrespondenceCost(Jet(0.7, 0), Jet(0.9, 1));
  EXPECT_NEAR(cost.a, 0.3, 1e-3);
  EXPECT_NEAR(cost.v[0], -1., 1e-3);
  EXPECT_NEAR(cost.v[1], 0., 1e-3);
  // Half of the four cells are outside.
  EXPECT_EQ(interpolated.GetCorrespondenceCost(3.9, 0.9), 2.);
  EXPECT_NEAR(interpolated.GetWeight(3.9, 0.5), 3., 1e-3);
}

TEST_F(TSDFMatchingTest, CostIsTheDistance) {
  const sensor::PointCloud cloud = test::Cloud({{0.f, 0.f}, {0.f, 1.f}});
  const std::unique_ptr<ceres::CostFunction> cost(
      scan_matching::CreateTSDFMatchCostFunction2D(3., cloud, tsdf_));
  ASSERT_EQ(cost->num_residuals(), 2);
  const double pose[3] = {0.25, 0.5, 0.};
  const double* parameters[] = {pose};
  double residuals[2];
  double jacobian[6];
  double* jacobians[] = {jacobian};
  ASSERT_TRUE(cost->Evaluate(parameters, residuals, jacobians));
  for (int i = 0; i != 2; ++i) {
    EXPECT_NEAR(residuals[i], 3. * 0.75, 1e-3);
    EXPECT_NEAR(jacobian[3 * i], -3., 1e-3);
    EXPECT_NEAR(jacobian[3 * i + 1], 0., 1e-3);
    // Turning moves the second point by -1 in x.
    EXPECT_NEAR(jacobian[3 * i + 2], i == 0 ? 0. : 3., 1e-3);
  }
}

TEST_F(TSDFMatchingTest, FailsWithoutAnyWeight) {
  const sensor::PointCloud cloud = test::Cloud({{0.f, 0.f}});
  const std::unique_ptr<ceres::CostFunction> cost(
      scan_matching::CreateTSDFMatchCostFunction2D(3., cloud, tsdf_));
  const double pose[3] = {100., 0., 0.};
  const double* parameters[] = {pose};
  double residual;
  EXPECT_FALSE(cost->Evaluate(parameters, &residual, nullptr));
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
