// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A* on maps of 4000 x 4000 cells: the bar is half a second in the worst case.
#include <cstdint>
#include <random>

#include "benchmark/benchmark.h"
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

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
