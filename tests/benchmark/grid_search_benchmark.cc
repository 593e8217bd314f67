// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A* on maps of 4000 x 4000 cells: half a second is what a robot can wait for.
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "benchmark/benchmark.h"
#include "cartographer_ext/common/distance_transform.h"
#include "cartographer_ext/navigation/grid_search.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr int kSide = 4000;

WeightGrid Open() {
  WeightGrid grid;
  grid.width = grid.height = kSide;
  grid.weights.assign(static_cast<size_t>(kSide) * kSide, kMinWeight);
  return grid;
}

// Walls across nearly the whole map, gaps at alternate ends: every cell is
// expanded.
WeightGrid Serpentine() {
  WeightGrid grid = Open();
  const int pitch = 100;
  for (int row = pitch; row < kSide - 1; row += pitch) {
    for (int x = 0; x != kSide; ++x) {
      const bool gap = (row / pitch) % 2 ? x >= kSide - 20 : x < 20;
      if (!gap) grid.weights[static_cast<size_t>(row) * kSide + x] = kBlocked;
    }
  }
  return grid;
}

// Every weight its own, so that nearly every relaxation changes something.
WeightGrid RandomWeights() {
  WeightGrid grid = Open();
  std::mt19937 random(1);
  for (uint8_t& weight : grid.weights) {
    weight = static_cast<uint8_t>(kMinWeight +
                                  random() % (kMaxWeight - kMinWeight + 1));
  }
  return grid;
}

// The goal is walled in: all of the map is searched in vain.
WeightGrid WalledGoal() {
  WeightGrid grid = Open();
  for (int i = 0; i != 20; ++i) {
    grid.weights[static_cast<size_t>(kSide - 20) * kSide + kSide - 1 - i] =
        grid.weights[static_cast<size_t>(kSide - 1 - i) * kSide + kSide - 20] =
            kBlocked;
  }
  return grid;
}

// 200 m by 200 m with a pillar every three metres or so, weights as those of a
// costmap, and the goal walled in.
WeightGrid WalledGoalAmongPillars() {
  std::vector<uint8_t> occupied(static_cast<size_t>(kSide) * kSide);
  std::mt19937 random(2);
  for (int i = 0; i != 4500; ++i) {
    const int x = random() % (kSide - 10), y = random() % (kSide - 10);
    for (int j = 0; j != 64; ++j) {
      occupied[static_cast<size_t>(y + j / 8) * kSide + x + j % 8] = 1;
    }
  }
  const std::vector<float> distances =
      DistanceTransform(occupied, kSide, kSide, 0.05);
  WeightGrid grid = WalledGoal();
  for (size_t i = 0; i != distances.size(); ++i) {
    const double ratio = std::max(0., (0.9 - distances[i]) / 0.6);
    if (grid.weights[i] == kBlocked || ratio >= 1.) {
      grid.weights[i] = kBlocked;
    } else {
      grid.weights[i] =
          static_cast<uint8_t>(kMinWeight * (1. + 4. * ratio * ratio));
    }
  }
  grid.weights[kSide + 1] = kMinWeight;
  grid.weights[static_cast<size_t>(kSide - 10) * kSide + kSide - 10] =
      kMinWeight;
  return grid;
}

void Search(benchmark::State& state, const WeightGrid& grid) {
  GridSearch search;
  int64_t expanded = 0;
  for (auto _ : state) {
    const GridPath path = search.Search(grid, {1, 1}, {kSide - 10, kSide - 10});
    expanded = path.expanded;
    benchmark::DoNotOptimize(expanded);
  }
  state.counters["expanded"] = static_cast<double>(expanded);
}

BENCHMARK_CAPTURE(Search, open, Open())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Search, serpentine, Serpentine())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Search, random_weights, RandomWeights())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Search, walled_goal, WalledGoal())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Search, among_pillars, WalledGoalAmongPillars())
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
