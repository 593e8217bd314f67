// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"

#include <limits>

#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

class RangeDataInserterTest : public ::testing::Test {
 protected:
  // One-metre cells; cell (ix, iy) covers x in (4 - iy, 5 - iy), y in
  // (4 - ix, 5 - ix).
  RangeDataInserterTest()
      : grid_(MapLimits(1., Eigen::Vector2d(5., 5.), CellLimits(5, 5)),
              &tables_) {}

  Eigen::Array2i Index(const float x, const float y) const {
    return grid_.limits().GetCellIndex({x, y});
  }
  float Probability(const float x, const float y) const {
    return grid_.GetProbability(Index(x, y));
  }

  ValueConversionTables tables_;
  ProbabilityGrid grid_;
};

TEST_F(RangeDataInserterTest, HitsAndMissesOncePerInsertion) {
  const ProbabilityGridRangeDataInserter2D inserter(
      test::InserterOptions(0.7, 0.4));
  // The second ray passes the first one's hit, the third ends in the same cell.
  const sensor::RangeData range_data{
      Eigen::Vector3f(0.5f, 0.5f, 0.f),
      test::Cloud({{2.5f, 0.5f}, {4.5f, 0.5f}, {2.6f, 0.6f}}),
      test::Cloud({{0.5f, 3.5f}})};
  inserter.Insert(range_data, &grid_);
  EXPECT_NEAR(Probability(2.5f, 0.5f), 0.7, 2e-5);
  EXPECT_NEAR(Probability(4.5f, 0.5f), 0.7, 2e-5);
  for (const float x : {0.5f, 1.5f, 3.5f}) {
    EXPECT_NEAR(Probability(x, 0.5f), 0.4, 2e-5) << x;
  }
  for (const float y : {1.5f, 2.5f, 3.5f}) {
    EXPECT_NEAR(Probability(0.5f, y), 0.4, 2e-5) << y;
  }
  EXPECT_FALSE(grid_.IsKnown(Index(0.5f, 4.5f)));
  EXPECT_FALSE(grid_.IsKnown(Index(1.5f, 1.5f)));

  inserter.Insert(range_data, &grid_);
  // Odds (7/3)^2 = 49/9 and (2/3)^2 = 4/9.
  EXPECT_NEAR(Probability(2.5f, 0.5f), 49. / 58., 4e-5);
  EXPECT_NEAR(Probability(1.5f, 0.5f), 4. / 13., 4e-5);
  // Nothing is left marked.
  const proto::Grid2D proto = grid_.ToProto();
  for (const int cell : proto.cells()) EXPECT_LT(cell, 32768);
}

TEST_F(RangeDataInserterTest, KnownBoxIsTight) {
  const ProbabilityGridRangeDataInserter2D inserter(
      test::InserterOptions(0.7, 0.4));
  inserter.Insert(
      {Eigen::Vector3f(1.5f, 1.5f, 0.f), test::Cloud({{3.5f, 2.5f}}), {}},
      &grid_);
  Eigen::Array2i offset;
  CellLimits size;
  grid_.ComputeCroppedLimits(&offset, &size);
  EXPECT_TRUE((offset == Index(3.5f, 2.5f)).all());
  EXPECT_EQ(size.num_x_cells, 2);
  EXPECT_EQ(size.num_y_cells, 3);
}

TEST_F(RangeDataInserterTest, WithoutFreeSpace) {
  auto options = test::InserterOptions(0.7, 0.4);
  options.set_insert_free_space(false);
  const ProbabilityGridRangeDataInserter2D inserter(options);
  inserter.Insert({Eigen::Vector3f(0.5f, 0.5f, 0.f),
                   test::Cloud({{2.5f, 0.5f}}), test::Cloud({{0.5f, 3.5f}})},
                  &grid_);
  int known = 0;
  for (const Eigen::Array2i& index : XYIndexRangeIterator(CellLimits(5, 5))) {
    if (grid_.IsKnown(index)) ++known;
  }
  EXPECT_EQ(known, 1);
  EXPECT_NEAR(Probability(2.5f, 0.5f), 0.7, 2e-5);
}

TEST_F(RangeDataInserterTest, GrowsForEverythingInTheRangeData) {
  const ProbabilityGridRangeDataInserter2D inserter(
      test::InserterOptions(0.7, 0.4));
  inserter.Insert({Eigen::Vector3f(-2.5f, 0.5f, 0.f),
                   test::Cloud({{6.5f, 0.5f}}), test::Cloud({{-2.5f, -3.5f}})},
                  &grid_);
  EXPECT_EQ(grid_.limits().cell_limits().num_x_cells, 20);
  EXPECT_NEAR(Probability(6.5f, 0.5f), 0.7, 2e-5);
  EXPECT_NEAR(Probability(0.5f, 0.5f), 0.4, 2e-5);
  EXPECT_NEAR(Probability(-2.5f, -3.5f), 0.4, 2e-5);
}

TEST_F(RangeDataInserterTest, SkipsWhatIsNotFinite) {
  const ProbabilityGridRangeDataInserter2D inserter(
      test::InserterOptions(0.7, 0.4));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  inserter.Insert({Eigen::Vector3f(0.5f, 0.5f, 0.f),
                   test::Cloud({{nan, 1.f}, {2.5f, 0.5f}}),
                   test::Cloud({{1.f, -infinity}})},
                  &grid_);
  EXPECT_EQ(grid_.limits().cell_limits().num_x_cells, 5);
  EXPECT_NEAR(Probability(2.5f, 0.5f), 0.7, 2e-5);
  inserter.Insert(
      {Eigen::Vector3f(nan, 0.f, 0.f), test::Cloud({{2.5f, 0.5f}}), {}},
      &grid_);
  EXPECT_NEAR(Probability(2.5f, 0.5f), 0.7, 2e-5);
}

TEST_F(RangeDataInserterTest, NothingToInsert) {
  const ProbabilityGridRangeDataInserter2D inserter(
      test::InserterOptions(0.7, 0.4));
  inserter.Insert({Eigen::Vector3f(2.5f, 2.5f, 0.f), {}, {}}, &grid_);
  EXPECT_FALSE(grid_.IsKnown(Index(2.5f, 2.5f)));
}

TEST(RangeDataInserterOptionsTest, FreeSpaceIsOptional) {
  const auto with = test::Lua(
      "return { hit_probability = 0.55, miss_probability = 0.49,"
      " insert_free_space = false }");
  auto options = CreateProbabilityGridRangeDataInserterOptions2D(with.get());
  EXPECT_EQ(options.hit_probability(), 0.55);
  EXPECT_EQ(options.miss_probability(), 0.49);
  EXPECT_FALSE(options.insert_free_space());
  const auto without =
      test::Lua("return { hit_probability = 0.55, miss_probability = 0.49 }");
  options = CreateProbabilityGridRangeDataInserterOptions2D(without.get());
  EXPECT_TRUE(options.insert_free_space());
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
