// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/coarse_grid.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

SearchGrid2D Grid(const int num_x, const int num_y,
                  const std::vector<uint8_t>& values) {
  SearchGrid2D grid;
  grid.num_x = num_x;
  grid.num_y = num_y;
  grid.resolution = 0.05;
  grid.max_x = 3.;
  grid.max_y = -2.;
  grid.min_score = 0.1f;
  grid.max_score = 0.9f;
  grid.values = values;
  return grid;
}

TEST(CoarseGridTest, HasTheLargestOfItsCells) {
  const SearchGrid2D coarse = CoarseGrid(Grid(5, 3,
                                              {1, 2, 3, 4, 9,  //
                                               5, 6, 7, 8, 0,  //
                                               0, 1, 0, 2, 7}),
                                         2);
  EXPECT_EQ(coarse.num_x, 3);
  EXPECT_EQ(coarse.num_y, 2);
  EXPECT_THAT(coarse.values, ElementsAre(6, 8, 9, 1, 2, 7));
  EXPECT_DOUBLE_EQ(coarse.resolution, 0.1);
  // The corner from which cells are counted stays where it is.
  EXPECT_EQ(coarse.max_x, 3.);
  EXPECT_EQ(coarse.max_y, -2.);
  EXPECT_EQ(coarse.min_score, 0.1f);
  EXPECT_EQ(coarse.max_score, 0.9f);
}

TEST(CoarseGridTest, FactorsOneAndBeyondTheGrid) {
  const SearchGrid2D grid = Grid(2, 2, {1, 2, 3, 4});
  EXPECT_EQ(CoarseGrid(grid, 1).values, grid.values);
  EXPECT_THAT(CoarseGrid(grid, 100).values, ElementsAre(4));
}

TEST(CoarseGridTest, EmptyWhereThereIsNothing) {
  EXPECT_THAT(CoarseGrid(Grid(0, 0, {}), 4).values, IsEmpty());
  const SearchGrid2D wrong = CoarseGrid(Grid(2, 2, {1, 2, 3}), 4);
  EXPECT_EQ(wrong.num_x, 0);
  EXPECT_THAT(wrong.values, IsEmpty());
}

// A pose scores no less there than in the grid, half a cell aside.
TEST(CoarseGridTest, FindsWhatTheGridFinds) {
  SearchGrid2D grid = Grid(120, 80, std::vector<uint8_t>(120 * 80, 0));
  PlanarCloud cloud;
  for (int i = 0; i < 60; ++i) {
    // An L of two walls.
    const int x = i < 40 ? 30 + i : 30;
    const int y = i < 40 ? 20 : 20 + i - 39;
    grid.values[grid.num_x * y + x] = 255;
    cloud.x.push_back(static_cast<float>(grid.max_x - 0.05 * (y + 0.5) - 1.));
    cloud.y.push_back(static_cast<float>(grid.max_y - 0.05 * (x + 0.5) + 2.));
  }
  FastCorrelativeSearchOptions options;
  const SearchResult fine = FastCorrelativeSearch2D(grid, options)
                                .MatchFullSubmap(cloud, 0.5f, SearchBudget());
  const SearchResult rough =
      FastCorrelativeSearch2D(CoarseGrid(grid, 4), options)
          .MatchFullSubmap(cloud, 0.5f, SearchBudget());
  ASSERT_TRUE(fine.found);
  ASSERT_TRUE(rough.found);
  EXPECT_GE(rough.score, fine.score - 0.05f);
  EXPECT_NEAR(rough.pose.x, 1., 0.3);
  EXPECT_NEAR(rough.pose.y, -2., 0.3);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
