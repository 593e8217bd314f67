// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/map_limits.h"

#include <vector>

#include "cartographer/mapping/2d/xy_index.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

TEST(MapLimitsTest, IndicesRunAgainstTheWorldAxes) {
  const MapLimits limits(2., Eigen::Vector2d(1., 8.), CellLimits(5, 3));
  // Rows of the world's x: (-1, 1), (-3, -1), (-5, -3).
  EXPECT_TRUE((limits.GetCellIndex({0.f, 7.f}) == Eigen::Array2i(0, 0)).all());
  EXPECT_TRUE((limits.GetCellIndex({-4.f, 7.f}) == Eigen::Array2i(0, 2)).all());
  EXPECT_TRUE((limits.GetCellIndex({0.f, -1.f}) == Eigen::Array2i(4, 0)).all());
  EXPECT_TRUE(
      (limits.GetCellIndex({1.5f, 8.5f}) == Eigen::Array2i(-1, -1)).all());
  EXPECT_EQ(limits.GetCellCenter({0, 0}), Eigen::Vector2f(0.f, 7.f));
  EXPECT_EQ(limits.GetCellCenter({4, 2}), Eigen::Vector2f(-4.f, -1.f));
}

TEST(MapLimitsTest, Contains) {
  const MapLimits limits(1., Eigen::Vector2d(0., 0.), CellLimits(5, 3));
  EXPECT_TRUE(limits.Contains({0, 0}));
  EXPECT_TRUE(limits.Contains({4, 2}));
  EXPECT_FALSE(limits.Contains({5, 2}));
  EXPECT_FALSE(limits.Contains({4, 3}));
  EXPECT_FALSE(limits.Contains({-1, 0}));
  EXPECT_FALSE(limits.Contains({0, -1}));
}

TEST(MapLimitsTest, ProtoRoundTrip) {
  const MapLimits limits(0.05, Eigen::Vector2d(3.25, -7.5), CellLimits(11, 13));
  const MapLimits read(ToProto(limits));
  EXPECT_EQ(read.resolution(), 0.05);
  EXPECT_EQ(read.max(), limits.max());
  EXPECT_EQ(read.cell_limits().num_x_cells, 11);
  EXPECT_EQ(read.cell_limits().num_y_cells, 13);
}

TEST(XYIndexTest, IteratesRowByRow) {
  std::vector<std::pair<int, int>> visited;
  for (const Eigen::Array2i& index :
       XYIndexRangeIterator(Eigen::Array2i(3, -1), Eigen::Array2i(4, 1))) {
    visited.emplace_back(index.x(), index.y());
  }
  const std::vector<std::pair<int, int>> expected = {{3, -1}, {4, -1}, {3, 0},
                                                     {4, 0},  {3, 1},  {4, 1}};
  EXPECT_EQ(visited, expected);
}

TEST(XYIndexTest, IteratesLimitsAndNothing) {
  int count = 0;
  for (const Eigen::Array2i& index : XYIndexRangeIterator(CellLimits(7, 5))) {
    EXPECT_LT(index.x(), 7);
    EXPECT_LT(index.y(), 5);
    ++count;
  }
  EXPECT_EQ(count, 35);
  for (const Eigen::Array2i& index : XYIndexRangeIterator(CellLimits(0, 0))) {
    FAIL() << index;
  }
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
