// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_painter.h"

#include <cmath>
#include <cstdint>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;

// Three cells along the ix axis (against y) and two along iy (against x), one
// metre each, corner at (2, 3).
Grid2D SmallGrid() {
  Grid2D grid;
  grid.mutable_limits()->set_resolution(1.);
  grid.mutable_limits()->mutable_max()->set_x(2.);
  grid.mutable_limits()->mutable_max()->set_y(3.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(3);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(2);
  grid.mutable_probability_grid_2d();
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  for (int i = 0; i < 6; ++i) grid.add_cells(0);
  return grid;
}

absl::StatusOr<io::OccupancyMap> Paint(
    const std::vector<std::pair<Grid2D, Pose2>>& grids,
    const double resolution) {
  std::deque<SubmapGrid> made;
  std::vector<PlacedGrid> placed;
  for (const auto& grid : grids) {
    made.push_back(*SubmapGrid::Make(grid.first));
    placed.push_back({&made.back(), grid.second});
  }
  return PaintMap(placed, resolution);
}

TEST(MapPainterTest, CellsLieWhereTheLimitsSay) {
  Grid2D grid = SmallGrid();
  // Cell (0, 0) has its centre at (1.5, 2.5), cell (2, 1) at (0.5, 0.5).
  grid.set_cells(0, 1);
  grid.set_cells(3 * 1 + 2, 32767);
  const auto map = Paint({{grid, Pose2()}}, 1.);
  ASSERT_TRUE(map.ok()) << map.status();
  ASSERT_EQ(map->width, 2);
  ASSERT_EQ(map->height, 3);
  EXPECT_EQ(map->origin.x, 0.);
  EXPECT_EQ(map->origin.y, 0.);
  EXPECT_NEAR(map->at(1, 2), 0.9, 1e-6);
  EXPECT_NEAR(map->at(0, 0), 0.1, 1e-6);
  EXPECT_TRUE(std::isnan(map->at(0, 2)));
}

TEST(MapPainterTest, PlacesGridsByTheirPoses) {
  Grid2D grid = SmallGrid();
  grid.set_cells(0, 1);
  // A quarter turn: (1.5, 2.5) goes to (-2.5, 1.5), then 10 m to the right.
  const auto map = Paint({{grid, Pose2(10., 0., kPi / 2.)}}, 1.);
  ASSERT_TRUE(map.ok());
  double x = 0., y = 0.;
  for (int j = 0; j < map->height; ++j) {
    for (int i = 0; i < map->width; ++i) {
      if (std::isnan(map->at(i, j))) continue;
      x = map->origin.x + i + 0.5;
      y = map->origin.y + j + 0.5;
    }
  }
  EXPECT_NEAR(x, 7.5, 1e-9);
  EXPECT_NEAR(y, 1.5, 1e-9);
}

TEST(MapPainterTest, OverlappingGridsAddTheirEvidence) {
  Grid2D occupied = SmallGrid(), free = SmallGrid();
  occupied.set_cells(0, 1);
  free.set_cells(0, 32767);
  const auto twice = Paint({{occupied, Pose2()}, {occupied, Pose2()}}, 1.);
  ASSERT_TRUE(twice.ok());
  // Odds of 9 squared.
  EXPECT_NEAR(twice->at(0, 0), 81. / 82., 1e-5);
  const auto mixed = Paint({{occupied, Pose2()}, {free, Pose2()}}, 1.);
  ASSERT_TRUE(mixed.ok());
  EXPECT_NEAR(mixed->at(0, 0), 0.5, 1e-5);
}

// Grids of many tiles of which few are known, at any pose and resolution.
TEST(MapPainterTest, NoKnownCellIsPassedOver) {
  std::mt19937 random(3);
  const auto uniform = [&random](const double from, const double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int64_t painted = 0, all = 0;
  for (int round = 0; round < 120; ++round) {
    Grid2D grid = SmallGrid();
    const int num_x = static_cast<int>(uniform(1., 120.));
    const int num_y = static_cast<int>(uniform(1., 120.));
    grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(num_x);
    grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(num_y);
    grid.mutable_cells()->Clear();
    grid.mutable_cells()->Resize(num_x * num_y, 0);
    for (int known = static_cast<int>(uniform(1., 30.)); known > 0; --known) {
      grid.set_cells(static_cast<int>(uniform(0., num_x * num_y)), 1 + known);
    }
    const Pose2 pose(uniform(-9., 9.), uniform(-9., 9.), uniform(-4., 4.));
    const double resolution = uniform(0.3, 2.5);
    const auto map = Paint({{grid, pose}}, resolution);
    ASSERT_TRUE(map.ok()) << map.status();
    const auto submap = SubmapGrid::Make(grid);
    const Pose2 local_from_map = pose.Inverse();
    for (int y = 0; y < map->height; ++y) {
      for (int x = 0; x < map->width; ++x) {
        const Eigen::Vector2d place =
            local_from_map *
            Eigen::Vector2d(map->origin.x + (x + 0.5) * resolution,
                            map->origin.y + (y + 0.5) * resolution);
        const double iy = std::floor(submap->max_corner().x() - place.x());
        const double ix = std::floor(submap->max_corner().y() - place.y());
        const bool is_known =
            ix >= 0. && iy >= 0. && ix < num_x && iy < num_y &&
            submap->Value(static_cast<int>(ix), static_cast<int>(iy)) != 0;
        ASSERT_EQ(std::isnan(map->at(x, y)), !is_known);
        painted += is_known;
        ++all;
      }
    }
  }
  EXPECT_GT(painted, 1000);
  EXPECT_LT(painted, all / 10);
}

TEST(MapPainterTest, RefusesNonsense) {
  Grid2D grid = SmallGrid();
  EXPECT_THAT(Paint({{grid, Pose2()}}, 1.).status().message(),
              testing::HasSubstr("no submap"));
  grid.set_cells(0, 1);
  EXPECT_FALSE(Paint({{grid, Pose2()}}, 0.).ok());
  EXPECT_THAT(Paint({{grid, Pose2()}}, 1e-5).status().message(),
              testing::HasSubstr("coarser"));
}

TEST(MapPainterTest, TheMapOfFarSubmapsIsRefused) {
  Grid2D grid = SmallGrid();
  for (int i = 0; i < 6; ++i) grid.set_cells(i, 1);
  const auto paint = [&](const double distance) {
    return Paint({{grid, Pose2()}, {grid, Pose2(distance, distance, 0.)}}, 1.)
        .status();
  };
  EXPECT_TRUE(paint(1000.).ok());
  // 2.5e7 cells for the sake of 12.
  EXPECT_THAT(std::string(paint(5000.).message()),
              testing::HasSubstr("the submaps are too far apart"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
