// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/probability_grid.h"

#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

class ProbabilityGridTest : public ::testing::Test {
 protected:
  static MapLimits Limits(const int num_x, const int num_y) {
    return MapLimits(0.5, Eigen::Vector2d(1., 2.), CellLimits(num_x, num_y));
  }
  ValueConversionTables tables_;
};

TEST_F(ProbabilityGridTest, StartsUnknown) {
  const ProbabilityGrid grid(Limits(4, 6), &tables_);
  EXPECT_EQ(grid.GetGridType(), GridType::PROBABILITY_GRID);
  for (const Eigen::Array2i& index : XYIndexRangeIterator(CellLimits(4, 6))) {
    EXPECT_FALSE(grid.IsKnown(index));
    EXPECT_FLOAT_EQ(grid.GetProbability(index), kMinProbability);
    EXPECT_FLOAT_EQ(grid.GetCorrespondenceCost(index), kMaxCorrespondenceCost);
  }
  EXPECT_FALSE(grid.IsKnown({-1, 0}));
  EXPECT_FALSE(grid.IsKnown({0, 6}));
  EXPECT_FLOAT_EQ(grid.GetProbability({4, 0}), kMinProbability);
  EXPECT_FLOAT_EQ(grid.GetCorrespondenceCost({4, 0}), kMaxCorrespondenceCost);
  EXPECT_EQ(grid.GetMinCorrespondenceCost(), kMinCorrespondenceCost);
  EXPECT_EQ(grid.GetMaxCorrespondenceCost(), kMaxCorrespondenceCost);
}

TEST_F(ProbabilityGridTest, SetProbability) {
  ProbabilityGrid grid(Limits(4, 6), &tables_);
  grid.SetProbability({1, 2}, 0.7f);
  grid.SetProbability({3, 5}, 1.f);
  EXPECT_TRUE(grid.IsKnown({1, 2}));
  EXPECT_NEAR(grid.GetProbability({1, 2}), 0.7, 2e-5);
  EXPECT_NEAR(grid.GetCorrespondenceCost({1, 2}), 0.3, 2e-5);
  EXPECT_FLOAT_EQ(grid.GetProbability({3, 5}), kMaxProbability);
}

TEST_F(ProbabilityGridTest, AppliesATableOncePerUpdate) {
  ProbabilityGrid grid(Limits(4, 6), &tables_);
  const auto table =
      ComputeLookupTableToApplyCorrespondenceCostOdds(Odds(0.6f));
  EXPECT_TRUE(grid.ApplyLookupTable({2, 3}, table));
  EXPECT_FALSE(grid.ApplyLookupTable({2, 3}, table));
  EXPECT_NEAR(grid.GetProbability({2, 3}), 0.6, 2e-5);
  grid.FinishUpdate();
  EXPECT_NEAR(grid.GetProbability({2, 3}), 0.6, 2e-5);
  EXPECT_TRUE(grid.ApplyLookupTable({2, 3}, table));
  grid.FinishUpdate();
  // Odds (3/2)^2 = 9/4.
  EXPECT_NEAR(grid.GetProbability({2, 3}), 9. / 13., 4e-5);
}

TEST_F(ProbabilityGridTest, CropsToKnownCells) {
  ProbabilityGrid grid(Limits(8, 10), &tables_);
  Eigen::Array2i offset;
  CellLimits size;
  grid.ComputeCroppedLimits(&offset, &size);
  EXPECT_EQ(size.num_x_cells, 1);
  EXPECT_EQ(size.num_y_cells, 1);

  grid.SetProbability({2, 3}, 0.3f);
  grid.SetProbability({6, 5}, 0.8f);
  grid.ComputeCroppedLimits(&offset, &size);
  EXPECT_TRUE((offset == Eigen::Array2i(2, 3)).all());
  EXPECT_EQ(size.num_x_cells, 5);
  EXPECT_EQ(size.num_y_cells, 3);

  const auto cropped = grid.ComputeCroppedGrid();
  EXPECT_EQ(cropped->limits().cell_limits().num_x_cells, 5);
  EXPECT_EQ(cropped->limits().cell_limits().num_y_cells, 3);
  // Three cells of half a metre less in x, two in y.
  EXPECT_EQ(cropped->limits().max(), Eigen::Vector2d(-0.5, 1.));
  EXPECT_EQ(cropped->GetCorrespondenceCost({0, 0}),
            grid.GetCorrespondenceCost({2, 3}));
  EXPECT_EQ(cropped->GetCorrespondenceCost({4, 2}),
            grid.GetCorrespondenceCost({6, 5}));
  EXPECT_FALSE(cropped->IsKnown({2, 1}));
  cropped->ComputeCroppedLimits(&offset, &size);
  EXPECT_TRUE((offset == Eigen::Array2i(0, 0)).all());
  EXPECT_EQ(size.num_x_cells, 5);
  EXPECT_EQ(size.num_y_cells, 3);
}

TEST_F(ProbabilityGridTest, GrowsAroundItsMiddle) {
  ProbabilityGrid grid(Limits(4, 6), &tables_);
  grid.SetProbability({1, 2}, 0.7f);
  const Eigen::Vector2f place = grid.limits().GetCellCenter({1, 2});
  grid.GrowLimits(place);
  EXPECT_EQ(grid.limits().cell_limits().num_x_cells, 4);

  // The grid spans x in (-2, 1) and y in (0, 2). Doubled once it reaches
  // (-3.5, 2.5) and (-1, 3), twice (-6.5, 5.5) and (-3, 5).
  grid.GrowLimits({2.f, 1.f});
  EXPECT_EQ(grid.limits().cell_limits().num_x_cells, 8);
  EXPECT_EQ(grid.limits().cell_limits().num_y_cells, 12);
  EXPECT_EQ(grid.limits().max(), Eigen::Vector2d(2.5, 3.));
  grid.GrowLimits({2.f, -2.5f});
  EXPECT_EQ(grid.limits().cell_limits().num_x_cells, 16);
  EXPECT_EQ(grid.limits().max(), Eigen::Vector2d(5.5, 5.));
  EXPECT_NEAR(grid.GetProbability(grid.limits().GetCellIndex(place)), 0.7,
              2e-5);
  int known = 0;
  for (const Eigen::Array2i& index : XYIndexRangeIterator(CellLimits(16, 24))) {
    if (grid.IsKnown(index)) ++known;
  }
  EXPECT_EQ(known, 1);
  Eigen::Array2i offset;
  CellLimits size;
  grid.ComputeCroppedLimits(&offset, &size);
  EXPECT_TRUE((offset == grid.limits().GetCellIndex(place)).all());
  EXPECT_EQ(size.num_x_cells, 1);
}

TEST_F(ProbabilityGridTest, ProtoRoundTrip) {
  ProbabilityGrid grid(Limits(4, 6), &tables_);
  grid.SetProbability({1, 2}, 0.7f);
  grid.SetProbability({2, 4}, 0.2f);
  const proto::Grid2D proto = grid.ToProto();
  EXPECT_TRUE(proto.has_probability_grid_2d());
  EXPECT_EQ(proto.cells_size(), 24);
  EXPECT_EQ(proto.cells(4 * 2 + 1), CorrespondenceCostToValue(1.f - 0.7f));
  EXPECT_EQ(proto.known_cells_box().min_x(), 1);
  EXPECT_EQ(proto.known_cells_box().max_y(), 4);
  EXPECT_EQ(proto.min_correspondence_cost(), kMinCorrespondenceCost);

  const ProbabilityGrid read(proto, &tables_);
  EXPECT_EQ(read.ToProto().SerializeAsString(), proto.SerializeAsString());
  EXPECT_EQ(read.GetProbability({1, 2}), grid.GetProbability({1, 2}));
}

TEST_F(ProbabilityGridTest, OldFilesHaveNoCostRangeAndNoBox) {
  proto::Grid2D proto = ProbabilityGrid(Limits(2, 2), &tables_).ToProto();
  EXPECT_FALSE(proto.has_known_cells_box());
  proto.clear_min_correspondence_cost();
  proto.clear_max_correspondence_cost();
  proto.set_cells(3, 1);
  const ProbabilityGrid read(proto, &tables_);
  EXPECT_EQ(read.GetMinCorrespondenceCost(), kMinCorrespondenceCost);
  EXPECT_EQ(read.GetMaxCorrespondenceCost(), kMaxCorrespondenceCost);
  EXPECT_NEAR(read.GetCorrespondenceCost({1, 1}), 0.1, 1e-6);
}

TEST_F(ProbabilityGridTest, Texture) {
  ProbabilityGrid grid(Limits(4, 6), &tables_);
  grid.SetProbability({1, 2}, kMaxProbability);
  grid.SetProbability({2, 3}, kMinProbability);
  grid.SetProbability({2, 2}, 0.5f);
  proto::SubmapQuery::Response::SubmapTexture texture;
  EXPECT_TRUE(grid.DrawToSubmapTexture(
      &texture, transform::Rigid3d::Translation(Eigen::Vector3d(1., 1., 0.))));
  EXPECT_EQ(texture.width(), 2);
  EXPECT_EQ(texture.height(), 2);
  EXPECT_EQ(texture.resolution(), 0.5);
  // The corner is 2 and 1 cells inside (1, 2), seen from (1, 1).
  EXPECT_NEAR(texture.slice_pose().translation().x(), -1., 1e-12);
  EXPECT_NEAR(texture.slice_pose().translation().y(), 0.5, 1e-12);
  std::string cells;
  common::FastGunzipString(texture.cells(), &cells);
  // Occupied darkens by 127, undecided does nothing but be there, unknown is
  // transparent, free brightens by 127.
  const std::string expected("\0\x7f\0\1\0\0\x7f\0", 8);
  EXPECT_EQ(cells, expected);
}

TEST(GridOptionsTest, ReadsEachKeyOnce) {
  const auto lua =
      test::Lua("return { grid_type = 'TSDF', resolution = 0.05 }");
  const proto::GridOptions2D options = CreateGridOptions2D(lua.get());
  EXPECT_EQ(options.grid_type(), proto::GridOptions2D::TSDF);
  EXPECT_FLOAT_EQ(options.resolution(), 0.05f);
}

TEST(GridOptionsDeathTest, NamesTheBadValue) {
  EXPECT_DEATH(
      {
        const auto lua =
            test::Lua("return { grid_type = 'HEXAGONS', resolution = 1. }");
        CreateGridOptions2D(lua.get());
      },
      "HEXAGONS");
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
