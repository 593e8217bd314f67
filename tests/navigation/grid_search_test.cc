// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/grid_search.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// Costs from the start to all cells, by relaxing until nothing changes.
std::vector<uint32_t> BruteForceCosts(const WeightGrid& grid,
                                      const Cell& start) {
  std::vector<uint32_t> costs(grid.weights.size(), kNone);
  costs[start.y * grid.width + start.x] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y != grid.height; ++y) {
      for (int x = 0; x != grid.width; ++x) {
        const uint32_t cost = costs[y * grid.width + x];
        if (cost == kNone) continue;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const Cell next{x + dx, y + dy};
            if (!grid.Contains(next) || grid.at(next) == kBlocked) continue;
            if (grid.at({x + dx, y}) == kBlocked ||
                grid.at({x, y + dy}) == kBlocked) {
              continue;
            }
            const uint32_t step =
                dx != 0 && dy != 0 ? kDiagonalStep : kStraightStep;
            uint32_t& known = costs[next.y * grid.width + next.x];
            if (cost + step * grid.at(next) < known) {
              known = cost + step * grid.at(next);
              changed = true;
            }
          }
        }
      }
    }
  }
  return costs;
}

WeightGrid RandomGrid(Random* const random) {
  WeightGrid grid;
  grid.width = random->UniformInt(1, 25);
  grid.height = random->UniformInt(1, 25);
  grid.weights.resize(grid.width * grid.height);
  const double blocked = random->Uniform(0., 0.45);
  const int highest = random->Uniform() < 0.3 ? kMinWeight : kMaxWeight;
  for (uint8_t& weight : grid.weights) {
    weight = random->Uniform() < blocked
                 ? kBlocked
                 : random->UniformInt(kMinWeight, highest);
  }
  return grid;
}

TEST(GridSearchTest, FindsCostsOfBruteForceOnRandomGrids) {
  Random random(7);
  GridSearch search;
  int found = 0, not_found = 0;
  for (int trial = 0; trial != 300; ++trial) {
    const WeightGrid grid = RandomGrid(&random);
    const Cell start{static_cast<int>(random.UniformInt(0, grid.width - 1)),
                     static_cast<int>(random.UniformInt(0, grid.height - 1))};
    const Cell goal{static_cast<int>(random.UniformInt(0, grid.width - 1)),
                    static_cast<int>(random.UniformInt(0, grid.height - 1))};
    const GridPath path = search.Search(grid, start, goal);
    if (grid.at(start) == kBlocked || grid.at(goal) == kBlocked) {
      EXPECT_FALSE(path.found);
      continue;
    }
    const uint32_t cost =
        BruteForceCosts(grid, start)[goal.y * grid.width + goal.x];
    ASSERT_EQ(path.found, cost != kNone) << "trial " << trial;
    ++(path.found ? found : not_found);
    if (!path.found) continue;
    EXPECT_EQ(path.cost, cost) << "trial " << trial;
    // The path is one: neighbours, free, and of that cost.
    ASSERT_TRUE(path.cells.front() == start && path.cells.back() == goal);
    uint32_t sum = 0;
    for (size_t i = 1; i < path.cells.size(); ++i) {
      const Cell a = path.cells[i - 1], b = path.cells[i];
      const int dx = b.x - a.x, dy = b.y - a.y;
      ASSERT_TRUE(std::abs(dx) <= 1 && std::abs(dy) <= 1 && a != b);
      ASSERT_NE(grid.at(b), kBlocked);
      ASSERT_NE(grid.at({a.x, b.y}), kBlocked);
      ASSERT_NE(grid.at({b.x, a.y}), kBlocked);
      sum += grid.at(b) * (dx != 0 && dy != 0 ? kDiagonalStep : kStraightStep);
    }
    EXPECT_EQ(sum, path.cost);
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(not_found, 20);
}

TEST(GridSearchTest, RefusesCellsOutside) {
  WeightGrid grid;
  grid.width = grid.height = 3;
  grid.weights.assign(9, kMinWeight);
  GridSearch search;
  EXPECT_FALSE(search.Search(grid, {-1, 0}, {2, 2}).found);
  EXPECT_FALSE(search.Search(grid, {0, 0}, {2, 3}).found);
  EXPECT_TRUE(search.Search(grid, {1, 1}, {1, 1}).found);
  EXPECT_EQ(search.Search(grid, {1, 1}, {1, 1}).cells.size(), 1u);
}

TEST(GridSearchTest, BreaksTiesTowardsTheGoal) {
  // In the open, only the cells of one path are expanded.
  WeightGrid grid;
  grid.width = grid.height = 200;
  grid.weights.assign(200 * 200, kMinWeight);
  const GridPath path = GridSearch().Search(grid, {10, 20}, {180, 150});
  EXPECT_EQ(path.expanded, static_cast<int64_t>(path.cells.size()));
}

// A serpentine: walls across nearly the whole map, gaps at alternate ends.
WeightGrid Serpentine(const int side, const int pitch) {
  WeightGrid grid;
  grid.width = grid.height = side;
  grid.weights.assign(static_cast<size_t>(side) * side, kMinWeight);
  for (int row = pitch; row < side - 1; row += pitch) {
    for (int x = 0; x != side; ++x) {
      const bool gap = (row / pitch) % 2 ? x >= side - 20 : x < 20;
      if (!gap) grid.weights[static_cast<size_t>(row) * side + x] = kBlocked;
    }
  }
  return grid;
}

// The time it takes is measured in tests/benchmark; the work is bounded by the
// number of cells.
TEST(GridSearchTest, ExpandsNoCellOfALargeMapTwice) {
  const WeightGrid grid = Serpentine(4000, 100);
  GridSearch search;
  const GridPath path = search.Search(grid, {1, 1}, {3990, 3990});
  ASSERT_TRUE(path.found);
  EXPECT_LE(path.expanded, 4000 * 4000);
}

// Costs far beyond those of any costmap end a search instead of wrapping around.
TEST(GridSearchTest, GivesUpPathsOfAbsurdCost) {
  WeightGrid grid;
  grid.width = 501;
  const auto cost = [&](const int height) {
    // Passages of one cell and the highest weight, joined at alternate ends.
    grid.height = height;
    grid.weights.assign(grid.width * height, kMaxWeight);
    for (int y = 1; y < height; y += 2) {
      for (int x = 0; x != grid.width; ++x) {
        if (x != (y % 4 == 1 ? grid.width - 1 : 0)) {
          grid.weights[y * grid.width + x] = kBlocked;
        }
      }
    }
    const GridPath path = GridSearch().Search(
        grid, {0, 0}, {height % 4 == 1 ? grid.width - 1 : 0, height - 1});
    return path.found ? path.cost : kNone;
  };
  // Straight steps only: 502 for each passage and its end but for the first.
  const auto expected = [](const int height) {
    return kStraightStep * kMaxWeight *
           (501u * (height + 1) / 2 - 1 + height / 2);
  };
  ASSERT_LT(expected(401), GridSearch::kMaxCost);
  EXPECT_EQ(cost(401), expected(401));
  ASSERT_GT(expected(501), GridSearch::kMaxCost);
  EXPECT_EQ(cost(501), kNone);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
