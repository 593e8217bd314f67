// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer_ext/scan_matching/correlative_search/correlative_search_run.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

constexpr float kToTheEnd = -std::numeric_limits<float>::infinity();
// More cells than any grid has; the search reduces it to offsets at which
// points can be in the grid.
constexpr double kFullWindowCells = 1e6;
constexpr int64_t kMostCells = int64_t{1} << 30;

std::unique_ptr<const PreparedGrid> Prepare(
    const SearchGrid2D& grid, const FastCorrelativeSearchOptions& options) {
  const int64_t num_cells = static_cast<int64_t>(grid.num_x) * grid.num_y;
  if (grid.num_x < 1 || grid.num_y < 1 || num_cells > kMostCells ||
      static_cast<int64_t>(grid.values.size()) != num_cells ||
      !(grid.resolution > 0.) || !std::isfinite(grid.resolution) ||
      !std::isfinite(grid.max_x) || !std::isfinite(grid.max_y)) {
    return nullptr;
  }
  return absl::make_unique<PreparedGrid>(
      grid, options.branch_and_bound_depth,
      options.kernels == nullptr ? BestSearchKernels() : *options.kernels);
}

Pose2 Middle(const GridGeometry& geometry) {
  const double half = 0.5 * geometry.resolution;
  return Pose2(geometry.max_x - half * geometry.num_y,
               geometry.max_y - half * geometry.num_x, 0.);
}

SearchWindow FullWindow(const GridGeometry& geometry) {
  SearchWindow window;
  window.linear = kFullWindowCells * geometry.resolution;
  window.angular = kPi;
  return window;
}

bool Searchable(const PreparedGrid* const grid, const PlanarCloud& cloud) {
  return grid != nullptr && !cloud.empty() && cloud.x.size() == cloud.y.size();
}

std::unique_ptr<CorrelativeSearchRun> Start(const SearchTask& task) {
  if (task.grid == nullptr || task.cloud == nullptr) return nullptr;
  const PreparedGrid* const grid = task.grid->prepared();
  if (!Searchable(grid, *task.cloud)) return nullptr;
  return absl::make_unique<CorrelativeSearchRun>(
      *grid, *task.cloud,
      task.full_submap ? Middle(grid->geometry) : task.initial,
      task.full_submap ? FullWindow(grid->geometry) : task.window,
      task.min_score);
}

}  // namespace

void SearchStatistics::Add(const SearchStatistics& other) {
  num_poses += other.num_poses;
  coarse_scored += other.coarse_scored;
  coarse_pruned += other.coarse_pruned;
  blocks_scored += other.blocks_scored;
  blocks_pruned += other.blocks_pruned;
  blocks_opened += other.blocks_opened;
  blocks_cut += other.blocks_cut;
  rejected_early = rejected_early && other.rejected_early;
}

FastCorrelativeSearch2D::FastCorrelativeSearch2D(
    SearchGrid2D grid, const FastCorrelativeSearchOptions& options)
    : options_(options), grid_(Prepare(grid, options)) {}

FastCorrelativeSearch2D::~FastCorrelativeSearch2D() = default;

SearchResult FastCorrelativeSearch2D::Match(const Pose2& initial,
                                            const PlanarCloud& cloud,
                                            const float min_score) const {
  return Match(initial, cloud, options_.window, min_score, SearchBudget());
}

SearchResult FastCorrelativeSearch2D::Match(const Pose2& initial,
                                            const PlanarCloud& cloud,
                                            const SearchWindow& window,
                                            const float min_score,
                                            const SearchBudget& budget) const {
  if (!Searchable(grid_.get(), cloud)) return SearchResult();
  CorrelativeSearchRun run(*grid_, cloud, initial, window, min_score);
  BudgetMeter meter(budget);
  run.Run(kToTheEnd, &meter);
  return run.Result();
}

SearchResult FastCorrelativeSearch2D::MatchFullSubmap(
    const PlanarCloud& cloud, const float min_score,
    const SearchBudget& budget) const {
  if (!Searchable(grid_.get(), cloud)) return SearchResult();
  return Match(Middle(grid_->geometry), cloud, FullWindow(grid_->geometry),
               min_score, budget);
}

size_t FastCorrelativeSearch2D::MemoryBytes() const {
  return sizeof(*this) + (grid_ == nullptr ? 0 : grid_->MemoryBytes());
}

const FastCorrelativeSearchOptions& FastCorrelativeSearch2D::options() const {
  return options_;
}

std::vector<SearchTaskResult> MatchBestFew(const std::vector<SearchTask>& tasks,
                                           const int num_best,
                                           const SearchBudget& budget,
                                           SearchStatistics* const total) {
  std::vector<std::unique_ptr<CorrelativeSearchRun>> runs;
  for (const SearchTask& task : tasks) runs.push_back(Start(task));
  BudgetMeter meter(budget);
  SearchStatistics sum;
  sum.rejected_early = true;
  std::vector<SearchTaskResult> results;
  const auto take = [&results, &runs, &sum](const size_t i) {
    SearchTaskResult result;
    result.task = i;
    result.result = runs[i]->Result();
    runs[i].reset();
    sum.Add(result.result.statistics);
    if (result.result.found) results.push_back(result);
  };
  while (static_cast<int>(results.size()) < num_best && !meter.used_up()) {
    // The run with the largest bound, and the largest bound of the others.
    int best = -1;
    float best_bound = 0.f;
    float next_bound = kToTheEnd;
    for (size_t i = 0; i != runs.size(); ++i) {
      if (runs[i] == nullptr) continue;
      const float bound = runs[i]->UpperBound();
      if (best == -1 || bound > best_bound) {
        if (best != -1) next_bound = std::max(next_bound, best_bound);
        best = static_cast<int>(i);
        best_bound = bound;
      } else {
        next_bound = std::max(next_bound, bound);
      }
    }
    if (best == -1) break;
    if (runs[best]->done()) {
      take(best);
    } else {
      runs[best]->Run(next_bound, &meter);
    }
  }
  // Without a budget left, what was found so far; else those left alone.
  const bool used_up = meter.used_up();
  for (size_t i = 0; i != runs.size(); ++i) {
    if (runs[i] == nullptr) continue;
    if (used_up) {
      take(i);
    } else {
      sum.Add(runs[i]->Result().statistics);
    }
  }
  if (used_up) {
    std::stable_sort(results.begin(), results.end(),
                     [](const SearchTaskResult& a, const SearchTaskResult& b) {
                       return a.result.score > b.result.score;
                     });
    if (static_cast<int>(results.size()) > num_best) {
      results.resize(std::max(0, num_best));
    }
  }
  if (total != nullptr) *total = sum;
  return results;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
