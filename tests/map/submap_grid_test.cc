// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/submap_grid.h"

#include <cmath>
#include <random>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;

// Unknown cells of one metre, corner at (2, 3).
Grid2D UnknownGrid(const int num_x, const int num_y) {
  Grid2D grid;
  grid.mutable_limits()->set_resolution(1.);
  grid.mutable_limits()->mutable_max()->set_x(2.);
  grid.mutable_limits()->mutable_max()->set_y(3.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(num_x);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(num_y);
  grid.mutable_probability_grid_2d();
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  grid.mutable_cells()->Resize(num_x * num_y, 0);
  return grid;
}

SubmapGrid Make(const Grid2D& grid) { return *SubmapGrid::Make(grid); }

TEST(SubmapGridTest, DecodesProbabilities) {
  Grid2D grid = UnknownGrid(3, 2);
  grid.set_cells(0, 1);
  grid.set_cells(1, 32767);
  grid.set_cells(4, 16384);
  EXPECT_NEAR(Make(grid).Occupancy(0, 0), 0.9, 1e-6);
  EXPECT_NEAR(Make(grid).Occupancy(1, 0), 0.1, 1e-6);
  EXPECT_NEAR(Make(grid).Occupancy(1, 1), 0.5, 1e-6);
  EXPECT_TRUE(std::isnan(Make(grid).Occupancy(2, 1)));
  // Files of old do not name the bounds.
  grid.clear_min_correspondence_cost();
  grid.clear_max_correspondence_cost();
  EXPECT_NEAR(Make(grid).Occupancy(0, 0), 0.9, 1e-6);
}

TEST(SubmapGridTest, TsdfCellsAreOccupiedNearTheSurface) {
  Grid2D grid = UnknownGrid(3, 2);
  grid.mutable_tsdf_2d()->set_truncation_distance(3.f);
  grid.set_cells(0, 16384);  // distance 0
  grid.set_cells(1, 32767);  // distance 3
  EXPECT_GT(Make(grid).Occupancy(0, 0), 0.5f);
  EXPECT_LT(Make(grid).Occupancy(1, 0), 0.5f);
  EXPECT_TRUE(std::isnan(Make(grid).Occupancy(2, 0)));
}

// Whatever the size, and with values that no program writes.
TEST(SubmapGridTest, KeepsEveryKnownCell) {
  std::mt19937 random(3);
  const auto uniform = [&random](const int from, const int to) {
    return std::uniform_int_distribution<int>(from, to)(random);
  };
  for (int round = 0; round < 100; ++round) {
    const int num_x = uniform(1, 40), num_y = uniform(1, 40);
    Grid2D grid = UnknownGrid(num_x, num_y);
    for (int i = uniform(0, 10); i > 0; --i) {
      grid.set_cells(uniform(0, num_x * num_y - 1), uniform(-9, 70000));
    }
    const SubmapGrid made = Make(grid);
    CellBox known{num_x, -1, num_y, -1};
    int64_t num_known = 0;
    for (int iy = 0; iy < num_y; ++iy) {
      for (int ix = 0; ix < num_x; ++ix) {
        int value = grid.cells(num_x * iy + ix);
        if (value >= 1 << 15) value -= 1 << 15;  // the mark of an update
        if (value <= 0 || value > 32767) {
          EXPECT_TRUE(std::isnan(made.Occupancy(ix, iy)));
          continue;
        }
        EXPECT_NEAR(made.Occupancy(ix, iy), 0.9 - 0.8 * (value - 1) / 32766.,
                    1e-6);
        EXPECT_TRUE(made.HasTile(made.tiles().TileOf(ix, iy)));
        ++num_known;
        known = {std::min(known.min_x, ix), std::max(known.max_x, ix),
                 std::min(known.min_y, iy), std::max(known.max_y, iy)};
      }
    }
    EXPECT_EQ(made.num_known(), num_known);
    EXPECT_EQ(made.known_box(), num_known > 0 ? known : CellBox());
  }
}

TEST(SubmapGridTest, RefusesWhatDoesNotFit) {
  Grid2D grid = UnknownGrid(3, 2);
  EXPECT_TRUE(SubmapGrid::Make(grid).ok());
  grid.set_min_correspondence_cost(0.9f);
  grid.set_max_correspondence_cost(0.1f);
  EXPECT_FALSE(SubmapGrid::Make(grid).ok());
  grid = UnknownGrid(3, 2);
  grid.add_cells(1);
  EXPECT_THAT(std::string(SubmapGrid::Make(grid).status().message()),
              testing::HasSubstr("7 cells"));
  EXPECT_FALSE(SubmapGrid::Make(UnknownGrid(0, 0)).ok());
  EXPECT_TRUE(Make(UnknownGrid(1, 1)).known_box().empty());
}

TEST(CellBoxTest, GapsAndIntersections) {
  const CellBox box{2, 5, 10, 12};
  EXPECT_TRUE(CellBox().empty());
  EXPECT_EQ(box.Gap({5, 9, 0, 20}), 0);
  EXPECT_EQ(box.Gap({6, 9, 0, 20}), 0);
  EXPECT_EQ(box.Gap({9, 9, 0, 20}), 3);
  EXPECT_EQ(box.Gap({0, 0, 14, 20}), 1);
  EXPECT_EQ(box.Intersection({4, 9, 0, 10}), (CellBox{4, 5, 10, 10}));
  EXPECT_TRUE(box.Intersection({6, 9, 0, 20}).empty());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
