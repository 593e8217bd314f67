// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/submap_cells.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gtest/gtest.h"
#include "tests/map/probability_grid.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;
using cartographer_ext::test::FreeGrid;
using cartographer_ext::test::SetCell;

SubmapCells CellsOf(const Grid2D& grid, const double margin) {
  return SubmapCells(*SubmapGrid::Make(grid), margin);
}

TEST(SubmapCellsTest, CellsSayWhatIsSure) {
  Grid2D grid = FreeGrid();
  SetCell(2, 1, 1, &grid);      // x 1.8 to 1.9, y 2.7 to 2.8: occupied
  SetCell(2, 5, 16384, &grid);  // x 1.4 to 1.5: as likely as not
  SetCell(2, 8, 0, &grid);      // x 1.1 to 1.2: unknown
  const SubmapCells cells = CellsOf(grid, 0.1);
  EXPECT_EQ(cells.resolution(), 0.1);
  EXPECT_EQ(cells.grid().num_x(), 6);
  EXPECT_EQ(cells.grid().num_y(), 10);
  EXPECT_NEAR(cells.min_corner().x(), 1., 1e-12);
  EXPECT_NEAR(cells.min_corner().y(), 2.4, 1e-12);
  EXPECT_NEAR(cells.max_corner().y(), 3., 1e-12);
  EXPECT_EQ(cells.At({1.85, 2.75}), CellEvidence::kOccupied);
  // Within the margin of what is not free.
  EXPECT_EQ(cells.At({1.75, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.75, 2.65}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.45, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.15, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.65, 2.45}), CellEvidence::kFree);
  // Outside.
  EXPECT_EQ(cells.At({2.05, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.5, 3.05}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({std::nan(""), 2.5}), CellEvidence::kUnsure);
  EXPECT_TRUE(cells.NearOccupied({1.85, 2.75}));
  EXPECT_TRUE(cells.NearOccupied({1.95, 2.85}));
  EXPECT_FALSE(cells.NearOccupied({1.65, 2.75}));
  EXPECT_FALSE(cells.NearOccupied({1.15, 2.75}));
  EXPECT_FALSE(cells.NearOccupied({5., 5.}));
  ASSERT_EQ(cells.OccupiedCells().size(), 1u);
  EXPECT_NEAR((cells.OccupiedCells()[0] - Eigen::Vector2d(1.85, 2.75)).norm(),
              0., 1e-9);
}

TEST(SubmapCellsTest, WithoutMarginEveryCellStandsForItself) {
  Grid2D grid = FreeGrid();
  SetCell(2, 1, 1, &grid);
  const SubmapCells cells = CellsOf(grid, 0.);
  EXPECT_EQ(cells.At({1.75, 2.75}), CellEvidence::kFree);
  EXPECT_FALSE(cells.NearOccupied({1.75, 2.75}));
}

// In grids with some occupied cells, no point within reach of another lies in
// one of them, and in the middle of an empty grid most points are within reach.
TEST(SubmapCellsTest, NoWallIsWithinReach) {
  std::mt19937 random(7);
  const auto uniform = [&](const double from, const double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int skipped = 0;
  for (int round = 0; round < 300; ++round) {
    Grid2D grid = FreeGrid();
    for (int i = round % 4; i > 0; --i) {
      SetCell(static_cast<int>(uniform(0., 6.)),
              static_cast<int>(uniform(0., 10.)), 1, &grid);
    }
    const SubmapCells cells = CellsOf(grid, 0.1);
    const Eigen::Vector2d from(uniform(0., 3.), uniform(1.5, 4.));
    const CellView view = cells.View(from);
    EXPECT_EQ(view.evidence, cells.At(from));
    EXPECT_TRUE(view.reach < 0. || view.evidence != CellEvidence::kOccupied);
    const double reach = 0.1 * std::min(view.reach, 30.);
    for (int i = 0; i < 20 && reach > 0.; ++i) {
      // Some of them at the corners and edges.
      const Eigen::Vector2d point =
          from +
          Eigen::Vector2d(std::max(-1., std::min(1., uniform(-2., 2.))),
                          std::max(-1., std::min(1., uniform(-2., 2.)))) *
              reach;
      EXPECT_NE(cells.At(point), CellEvidence::kOccupied);
      ++skipped;
    }
  }
  EXPECT_GT(skipped, 1000);
  const SubmapCells cells = CellsOf(FreeGrid(), 0.1);
  EXPECT_EQ(cells.View({std::nan(""), 2.5}).reach, 0.);
}

TEST(SubmapCellsTest, ScoresAreMeansOfProbabilities) {
  Grid2D grid = FreeGrid();
  SetCell(2, 1, 1, &grid);      // 0.9
  SetCell(2, 5, 16384, &grid);  // 0.5
  const SubmapCells cells = CellsOf(grid, 0.1);
  const Pose2 at_corner(1., 2.4, 0.);
  EXPECT_EQ(cells.Score({}, at_corner), 0.);
  EXPECT_NEAR(cells.Score({{0.85, 0.35}}, at_corner), 0.9, 3e-3);
  // Occupied, half, free (0.1), outside (0.1).
  EXPECT_NEAR(cells.Score({{0.85, 0.35}, {0.45, 0.35}, {0.25, 0.05}, {9., 9.}},
                          at_corner),
              (0.9 + 0.5 + 0.1 + 0.1) / 4., 3e-3);
  // Turned by a quarter: (0.35, -0.85) comes to lie at (0.85, 0.35).
  EXPECT_NEAR(cells.Score({{0.35, -0.85}}, Pose2(1., 2.4, kPi / 2.)), 0.9,
              3e-3);
}

// A grid of random size, cells of 0.05 m, with some walls, free space around
// them and the rest unknown.
Grid2D RandomGrid(std::mt19937* const random) {
  const auto uniform = [random](const int from, const int to) {
    return std::uniform_int_distribution<int>(from, to)(*random);
  };
  Grid2D grid = FreeGrid();
  grid.clear_cells();
  const int num_x = uniform(1, 90), num_y = uniform(1, 90);
  grid.mutable_limits()->set_resolution(0.05);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(num_x);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(num_y);
  grid.mutable_cells()->Resize(num_x * num_y, 0);
  for (int wall = uniform(0, 3); wall > 0; --wall) {
    const int x = uniform(0, num_x - 1), y = uniform(0, num_y - 1);
    const int length = uniform(1, 30), side = uniform(0, 15);
    for (int iy = std::max(0, y - side); iy < std::min(num_y, y + side); ++iy) {
      for (int ix = x; ix < std::min(num_x, x + length); ++ix) {
        const int values[] = {0, 1, 9000, 16384, 24000};
        grid.set_cells(iy * num_x + ix, iy == y ? 1
                                        : uniform(0, 99) == 0
                                            ? values[uniform(0, 4)]
                                            : 32767);
      }
    }
  }
  return grid;
}

// By its definition.
int DistanceToOccupied(const SubmapGrid& grid, const int ix, const int iy) {
  int distance = 1000;
  for (int y = 0; y < grid.num_y(); ++y) {
    for (int x = 0; x < grid.num_x(); ++x) {
      if (!(grid.Occupancy(x, y) >= 0.6f)) continue;
      distance =
          std::min(distance, std::max(std::abs(x - ix), std::abs(y - iy)));
    }
  }
  return distance;
}

bool HasFreeSurroundings(const SubmapGrid& grid, const int ix, const int iy,
                         const int radius) {
  for (int y = iy - radius; y <= iy + radius; ++y) {
    for (int x = ix - radius; x <= ix + radius; ++x) {
      if (x < 0 || y < 0 || x >= grid.num_x() || y >= grid.num_y()) continue;
      if (!(grid.Occupancy(x, y) <= 0.4f)) return false;
    }
  }
  return true;
}

// Most tiles of the random grids are unknown or partly known.
TEST(SubmapCellsTest, TilesSayWhatEveryCellWouldSay) {
  std::mt19937 random(11);
  int free = 0, near = 0;
  for (int round = 0; round < 40; ++round) {
    const SubmapCells cells = CellsOf(RandomGrid(&random), 0.15);
    const SubmapGrid& grid = cells.grid();
    for (int iy = 0; iy < grid.num_y(); ++iy) {
      for (int ix = 0; ix < grid.num_x(); ++ix) {
        const Eigen::Vector2d center =
            grid.max_corner() - 0.05 * Eigen::Vector2d(iy + 0.5, ix + 0.5);
        const int distance = DistanceToOccupied(grid, ix, iy);
        const bool is_free =
            distance > 0 && HasFreeSurroundings(grid, ix, iy, 3);
        ASSERT_EQ(cells.At(center), distance == 0 ? CellEvidence::kOccupied
                                    : is_free     ? CellEvidence::kFree
                                                  : CellEvidence::kUnsure);
        ASSERT_EQ(cells.NearOccupied(center), distance <= 3);
        for (const int tolerance : {0, 2, 4}) {
          ASSERT_EQ(cells.CountNearOccupied({center}, {{0., 0.}},
                                            0.05 * (tolerance + 0.5))[0],
                    distance <= tolerance ? 1 : 0);
        }
        ASSERT_LT(cells.View(center).reach, distance - 1);
        free += is_free;
        near += distance > 3 && distance <= 4;
      }
    }
  }
  EXPECT_GT(free, 100);
  EXPECT_GT(near, 100);
}

TEST(SubmapCellsTest, AnUnknownGridSaysNothing) {
  Grid2D grid = FreeGrid();
  for (int i = 0; i < 60; ++i) grid.set_cells(i, 0);
  const SubmapCells cells = CellsOf(grid, 0.1);
  EXPECT_EQ(cells.At({1.5, 2.7}), CellEvidence::kUnsure);
  EXPECT_FALSE(cells.NearOccupied({1.5, 2.7}));
  EXPECT_TRUE(cells.OccupiedCells().empty());
}

// What is passed over where no wall is near counts for nothing.
TEST(SubmapCellsTest, CountsAreThoseOfEachShiftAlone) {
  std::mt19937 random(11);
  const auto uniform = [&](const double from, const double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int64_t near = 0, far = 0;
  for (int round = 0; round < 200; ++round) {
    const Grid2D grid = RandomGrid(&random);
    const SubmapCells cells = CellsOf(grid, 0.1);
    const Eigen::Vector2d middle =
        0.5 * (cells.min_corner() + cells.max_corner());
    std::vector<Eigen::Vector2d> points, shifts;
    for (int i = 0; i < 20; ++i) {
      points.push_back(middle +
                       Eigen::Vector2d(uniform(-3., 3.), uniform(-3., 3.)));
    }
    // A turned lattice, then shifts at random and a repeated one.
    const Pose2 turn(0., 0., uniform(-kPi, kPi));
    for (int x = -8; x <= 8; ++x) {
      for (int y = -8; y <= 8; ++y) {
        shifts.push_back(turn * Eigen::Vector2d(0.1 * x, 0.1 * y));
      }
    }
    for (int i = 0; i < 20; ++i) {
      shifts.emplace_back(uniform(-2., 2.), uniform(-2., 2.));
    }
    shifts.push_back(shifts.back());
    const double tolerance = uniform(0., 0.25);
    const std::vector<int> counts =
        cells.CountNearOccupied(points, shifts, tolerance);
    ASSERT_EQ(counts.size(), shifts.size());
    for (size_t i = 0; i < shifts.size(); ++i) {
      EXPECT_EQ(counts[i],
                cells.CountNearOccupied(points, {shifts[i]}, tolerance)[0]);
      near += counts[i];
      far += static_cast<int64_t>(points.size()) - counts[i];
    }
  }
  EXPECT_GT(near, 5000);
  EXPECT_GT(far, 5000);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
