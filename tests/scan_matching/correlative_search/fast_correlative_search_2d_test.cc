// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// Two walls and noise, 120 x 90 cells of 5 cm.
SearchGrid2D Grid(const int seed) {
  Random random(seed);
  SearchGrid2D grid;
  grid.num_x = 120;
  grid.num_y = 90;
  grid.resolution = 0.05;
  grid.max_x = 3.;
  grid.max_y = 4.;
  grid.min_score = 0.1f;
  grid.max_score = 0.9f;
  for (int y = 0; y != grid.num_y; ++y) {
    for (int x = 0; x != grid.num_x; ++x) {
      const bool wall = x == 30 + seed || y == 50 || (x == 80 && y > 20);
      grid.values.push_back(static_cast<uint8_t>(
          wall ? random.UniformInt(200, 255) : random.UniformInt(0, 60)));
    }
  }
  return grid;
}

// The walls seen from `pose`.
PlanarCloud Scan(const SearchGrid2D& grid, const Pose2& pose,
                 const int num_points) {
  Random random(17);
  PlanarCloud cloud;
  const Pose2 inverse = pose.Inverse();
  while (static_cast<int>(cloud.size()) < num_points) {
    const int x = static_cast<int>(random.UniformInt(0, grid.num_x - 1));
    const int y = static_cast<int>(random.UniformInt(0, grid.num_y - 1));
    if (grid.values[grid.num_x * y + x] < 200) continue;
    const Eigen::Vector2d point =
        inverse * Eigen::Vector2d(grid.max_x - grid.resolution * (y + 0.5),
                                  grid.max_y - grid.resolution * (x + 0.5));
    cloud.x.push_back(static_cast<float>(point.x()));
    cloud.y.push_back(static_cast<float>(point.y()));
  }
  return cloud;
}

SearchWindow Window(const double linear, const double angular) {
  SearchWindow window;
  window.linear = linear;
  window.angular = angular;
  return window;
}

const Pose2 kTruth(0.9, 1.2, 0.4);

// Tries every pose.
float BestScore(const SearchGrid2D& grid, const PlanarCloud& cloud,
                const Pose2& initial, const SearchWindow& window) {
  GridGeometry geometry;
  geometry.num_x = grid.num_x;
  geometry.num_y = grid.num_y;
  geometry.resolution = grid.resolution;
  geometry.max_x = grid.max_x;
  geometry.max_y = grid.max_y;
  RotatedScans scans(cloud, initial, window.linear, window.angular, geometry,
                     *AllSearchKernels().front());
  int best = 0;
  for (int rotation = 0; rotation != scans.num_rotations(); ++rotation) {
    const RotatedScan& scan = scans.Get(rotation);
    for (int y = scan.offsets.min_y; y <= scan.offsets.max_y; ++y) {
      for (int x = scan.offsets.min_x; x <= scan.offsets.max_x; ++x) {
        int sum = 0;
        for (size_t i = 0; i != cloud.size(); ++i) {
          const int column = scan.x[i] + x;
          const int row = scan.y[i] + y;
          if (column < 0 || column >= grid.num_x || row < 0 ||
              row >= grid.num_y) {
            continue;
          }
          sum += grid.values[grid.num_x * row + column];
        }
        best = std::max(best, sum);
      }
    }
  }
  return grid.min_score + static_cast<float>(best) /
                              static_cast<float>(cloud.size()) *
                              ((grid.max_score - grid.min_score) / 255.f);
}

TEST(FastCorrelativeSearchTest, FindsWhatTryingAllFinds) {
  const SearchGrid2D grid = Grid(0);
  const PlanarCloud cloud = Scan(grid, kTruth, 60);
  const FastCorrelativeSearch2D search(grid, FastCorrelativeSearchOptions());
  for (const double linear : {0., 0.05, 0.3, 1.1}) {
    for (const double angular : {0., 0.01, 0.1}) {
      const Pose2 initial(kTruth.x + 0.2, kTruth.y - 0.1, kTruth.theta + 0.05);
      const SearchWindow window = Window(linear, angular);
      const SearchResult result =
          search.Match(initial, cloud, window, 0.f, SearchBudget());
      ASSERT_TRUE(result.found);
      EXPECT_TRUE(result.complete);
      EXPECT_EQ(result.score, BestScore(grid, cloud, initial, window))
          << linear << " " << angular;
      EXPECT_EQ(result.upper_bound, result.score);
      EXPECT_LE(std::abs(result.pose.x - initial.x), linear + 0.05);
      EXPECT_LE(std::abs(result.pose.theta - initial.theta), angular + 0.05);
    }
  }
}

TEST(FastCorrelativeSearchTest, FindsTheTruthInTheFullSubmap) {
  const SearchGrid2D grid = Grid(0);
  const PlanarCloud cloud = Scan(grid, kTruth, 100);
  const FastCorrelativeSearch2D search(grid, FastCorrelativeSearchOptions());
  const SearchResult result = search.MatchFullSubmap(cloud, 0.6f, {});
  ASSERT_TRUE(result.found);
  EXPECT_NEAR(result.pose.x, kTruth.x, 0.05);
  EXPECT_NEAR(result.pose.y, kTruth.y, 0.05);
  EXPECT_NEAR(NormalizeAngle(result.pose.theta - kTruth.theta), 0., 0.03);
  EXPECT_GT(result.statistics.num_poses, result.statistics.coarse_scored);
  EXPECT_GT(result.statistics.coarse_pruned, 0);
}

TEST(FastCorrelativeSearchTest, RejectsEarlyWhatCannotBe) {
  const SearchGrid2D grid = Grid(0);
  const PlanarCloud cloud = Scan(grid, kTruth, 100);
  const FastCorrelativeSearch2D search(grid, FastCorrelativeSearchOptions());
  const SearchResult result =
      search.Match(Pose2(100., 0., 0.), cloud, Window(1., 0.2), 0.5f, {});
  EXPECT_FALSE(result.found);
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.statistics.rejected_early);
  EXPECT_EQ(result.statistics.blocks_scored, 0);
  EXPECT_LE(result.upper_bound, 0.5f);
}

TEST(FastCorrelativeSearchTest, GivesUpWhenTheBudgetIsUsedUp) {
  const SearchGrid2D grid = Grid(0);
  const PlanarCloud cloud = Scan(grid, kTruth, 60);
  const FastCorrelativeSearch2D search(grid, FastCorrelativeSearchOptions());
  const SearchWindow window = Window(2., 0.5);
  SearchBudget budget;
  budget.max_candidates = 1;
  const SearchResult first = search.Match(kTruth, cloud, window, 0.1f, budget);
  EXPECT_FALSE(first.complete);
  const SearchResult full = search.Match(kTruth, cloud, window, 0.1f, {});
  EXPECT_TRUE(full.complete);
  // The bound holds though the search was broken off.
  EXPECT_GE(first.upper_bound, full.score);
  // With enough of it the result is the same, again and again.
  budget.max_candidates = 100000000;
  for (int i = 0; i != 2; ++i) {
    const SearchResult again =
        search.Match(kTruth, cloud, window, 0.1f, budget);
    EXPECT_TRUE(again.complete);
    EXPECT_EQ(again.score, full.score);
    EXPECT_EQ(again.pose.x, full.pose.x);
  }
  budget.max_candidates = 0;
  budget.max_seconds = 1e-9;
  EXPECT_FALSE(search.Match(kTruth, cloud, window, 0.1f, budget).complete);
  budget.max_seconds = 1000.;
  EXPECT_TRUE(search.Match(kTruth, cloud, window, 0.1f, budget).complete);
}

TEST(FastCorrelativeSearchTest, BadInputFindsNothing) {
  const PlanarCloud cloud = Scan(Grid(0), kTruth, 30);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const FastCorrelativeSearch2D search(Grid(0), FastCorrelativeSearchOptions());
  EXPECT_FALSE(search.Match(kTruth, PlanarCloud(), 0.f).found);
  EXPECT_FALSE(search.Match(kTruth, cloud, nan).found);
  EXPECT_FALSE(search.Match(Pose2(nan, 0., 0.), cloud, 0.f).found);
  EXPECT_FALSE(search.Match(Pose2(nan, 0., 0.), cloud, 0.f).complete);
  PlanarCloud uneven = cloud;
  uneven.x.pop_back();
  EXPECT_FALSE(search.Match(kTruth, uneven, 0.f).found);
  // Points that are not finite count as points outside the grid.
  PlanarCloud partly = cloud;
  partly.x.push_back(nan);
  partly.y.push_back(0.f);
  const SearchResult result = search.Match(kTruth, partly, 0.f);
  EXPECT_TRUE(result.found);
  EXPECT_LT(result.score, search.Match(kTruth, cloud, 0.f).score);
  PlanarCloud nowhere;
  nowhere.x.assign(3, nan);
  nowhere.y.assign(3, nan);
  EXPECT_FALSE(search.Match(kTruth, nowhere, 0.11f).found);
  EXPECT_FALSE(search.MatchFullSubmap(nowhere, 0.11f, {}).found);

  SearchGrid2D wrong = Grid(0);
  wrong.values.pop_back();
  EXPECT_FALSE(FastCorrelativeSearch2D(wrong, FastCorrelativeSearchOptions())
                   .Match(kTruth, cloud, 0.f)
                   .found);
  const FastCorrelativeSearch2D empty(SearchGrid2D{},
                                      FastCorrelativeSearchOptions());
  EXPECT_FALSE(empty.MatchFullSubmap(cloud, 0.f, {}).found);
  EXPECT_LT(empty.MemoryBytes(), 1000u);
}

TEST(FastCorrelativeSearchTest, MemoryIsThatOfAFewGrids) {
  const FastCorrelativeSearch2D search(Grid(0), FastCorrelativeSearchOptions());
  EXPECT_GT(search.MemoryBytes(), 120u * 90u);
  // The seven levels of Cartographer's matcher.
  size_t stock = 0;
  for (int level = 0; level != 7; ++level) {
    stock += (120 + (1 << level) - 1) * (90 + (1 << level) - 1);
  }
  EXPECT_LE(search.MemoryBytes(), stock);
}

// Any size of grid, scan and window, with every set of instructions.
TEST(FastCorrelativeSearchTest, RandomInputIsTheSameForAllKernels) {
  Random random(23);
  for (int i = 0; i != 60; ++i) {
    SearchGrid2D grid;
    grid.num_x = static_cast<int>(random.UniformInt(1, 70));
    grid.num_y = static_cast<int>(random.UniformInt(1, 70));
    grid.resolution = 0.1;
    grid.max_x = random.Uniform(-5., 5.);
    grid.max_y = random.Uniform(-5., 5.);
    const int64_t sparse = random.UniformInt(1, 20);
    for (int k = 0; k != grid.num_x * grid.num_y; ++k) {
      grid.values.push_back(static_cast<uint8_t>(
          random.UniformInt(1, sparse) == 1 ? random.UniformInt(0, 255) : 0));
    }
    PlanarCloud cloud;
    const int64_t num_points = random.UniformInt(1, i % 12 == 0 ? 2500 : 60);
    for (int64_t k = 0; k != num_points; ++k) {
      cloud.x.push_back(static_cast<float>(random.Uniform(-6., 6.)));
      cloud.y.push_back(static_cast<float>(random.Uniform(-6., 6.)));
    }
    const Pose2 initial(random.Uniform(-6., 6.), random.Uniform(-6., 6.),
                        random.Uniform(-4., 4.));
    const SearchWindow window =
        Window(random.Uniform(0., 1.), random.Uniform(0., 0.1));
    const float expected = BestScore(grid, cloud, initial, window);
    for (const SearchKernels* const kernels : AllSearchKernels()) {
      FastCorrelativeSearchOptions options;
      options.kernels = kernels;
      const FastCorrelativeSearch2D search(grid, options);
      const SearchResult result =
          search.Match(initial, cloud, window, -1.f, SearchBudget());
      ASSERT_TRUE(result.found) << i << " " << kernels->name;
      ASSERT_EQ(result.score, expected) << i << " " << kernels->name;
    }
  }
}

class MatchBestFewTest : public ::testing::Test {
 protected:
  MatchBestFewTest() : cloud_(Scan(Grid(0), kTruth, 60)) {
    for (int seed = 0; seed != 6; ++seed) {
      searches_.push_back(absl::make_unique<FastCorrelativeSearch2D>(
          Grid(5 - seed), FastCorrelativeSearchOptions()));
      SearchTask task;
      task.grid = searches_.back().get();
      task.cloud = &cloud_;
      task.initial = Pose2(0.8, 1.1, 0.42);
      task.window = Window(0.5, 0.1);
      task.full_submap = seed == 2;
      task.min_score = 0.2f;
      tasks_.push_back(task);
    }
  }

  SearchResult Alone(const SearchTask& task) const {
    return task.full_submap
               ? task.grid->MatchFullSubmap(*task.cloud, task.min_score, {})
               : task.grid->Match(task.initial, *task.cloud, task.window,
                                  task.min_score, {});
  }

  PlanarCloud cloud_;
  std::vector<std::unique_ptr<FastCorrelativeSearch2D>> searches_;
  std::vector<SearchTask> tasks_;
};

TEST_F(MatchBestFewTest, ReturnsTheBestOfAllTasks) {
  std::vector<SearchTaskResult> all;
  for (size_t i = 0; i != tasks_.size(); ++i) {
    SearchTaskResult result;
    result.task = i;
    result.result = Alone(tasks_[i]);
    ASSERT_TRUE(result.result.found);
    all.push_back(result);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const SearchTaskResult& a, const SearchTaskResult& b) {
                     return a.result.score > b.result.score;
                   });
  for (int num_best = 0; num_best != 9; ++num_best) {
    SearchStatistics total;
    const std::vector<SearchTaskResult> best =
        MatchBestFew(tasks_, num_best, SearchBudget(), &total);
    ASSERT_EQ(best.size(), std::min<size_t>(num_best, all.size()));
    for (size_t i = 0; i != best.size(); ++i) {
      EXPECT_EQ(best[i].task, all[i].task);
      EXPECT_EQ(best[i].result.score, all[i].result.score);
      EXPECT_EQ(best[i].result.pose.x, all[i].result.pose.x);
      EXPECT_EQ(best[i].result.pose.theta, all[i].result.pose.theta);
      EXPECT_TRUE(best[i].result.complete);
    }
    EXPECT_GT(total.coarse_scored, 0);
  }
}

TEST_F(MatchBestFewTest, OpensLessThanAllSearchesAlone) {
  SearchStatistics alone;
  for (const SearchTask& task : tasks_) alone.Add(Alone(task).statistics);
  SearchStatistics shared;
  MatchBestFew(tasks_, 1, SearchBudget(), &shared);
  EXPECT_EQ(shared.coarse_scored, alone.coarse_scored);
  EXPECT_LT(shared.blocks_opened, alone.blocks_opened);
}

TEST_F(MatchBestFewTest, OfEqualsTheEarlierTask) {
  const std::vector<SearchTask> same = {tasks_[5], tasks_[5], tasks_[5]};
  const auto best = MatchBestFew(same, 2, SearchBudget(), nullptr);
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0].task, 0u);
  EXPECT_EQ(best[1].task, 1u);
}

TEST_F(MatchBestFewTest, BudgetAndBadTasks) {
  SearchBudget budget;
  budget.max_candidates = 1;
  for (const auto& result : MatchBestFew(tasks_, 3, budget, nullptr)) {
    EXPECT_FALSE(result.result.complete);
  }
  tasks_[5].grid = nullptr;
  tasks_[4].cloud = nullptr;
  tasks_[3].min_score = 0.95f;
  tasks_[2].initial.x = std::numeric_limits<double>::quiet_NaN();
  tasks_[2].full_submap = false;
  const auto best = MatchBestFew(tasks_, 6, SearchBudget(), nullptr);
  ASSERT_EQ(best.size(), 2u);
  EXPECT_LT(best[0].task, 2u);
  EXPECT_TRUE(MatchBestFew({}, 3, SearchBudget(), nullptr).empty());
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
