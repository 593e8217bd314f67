// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Times of our correlative matchers beside the host's, in a simulated building:
// rooms along a corridor, 180 beams, cells of 5 cm, Cartographer's default
// options. Golden pairs: cartographer_ext_benchmark_search.
//
//   cmake --preset release -DCARTOGRAPHER_EXT_BUILD_BENCHMARKS=ON
//   ninja -C build/release correlative_search_benchmark
//   build/release/tests/benchmark/correlative_search_benchmark
#include <cmath>
#include <vector>

#include "benchmark/benchmark.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/scan_matching/dropin/fast_correlative_matcher_2d.h"
#include "cartographer_ext/scan_matching/dropin/real_time_matcher_2d.h"

namespace cartographer_ext {
namespace {

namespace mapping = cartographer::mapping;
namespace stock = cartographer::mapping::scan_matching;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid2d;

constexpr double kResolution = 0.05;

bool IsWall(const double x, const double y) {
  if (std::abs(y) < 1.25) return false;
  if (std::abs(y) > 9.) return true;
  const double room = y > 0. ? 5.3 : 6.7;
  const double in_room = x - room * std::floor(x / room);
  return in_room < 0.15 ||
         (std::abs(y) < 1.4 && (in_room < 1.5 || in_room > 2.5));
}

struct World {
  World()
      : grid(mapping::MapLimits(kResolution, Eigen::Vector2d(15., 10.),
                                mapping::CellLimits(400, 600)),
             &tables) {
    // Only what was seen from the corridor is known.
    for (const Eigen::Array2i& cell :
         mapping::XYIndexRangeIterator(grid.limits().cell_limits())) {
      const Eigen::Vector2f place = grid.limits().GetCellCenter(cell);
      bool wall_near = false;
      bool free_near = false;
      for (int i = -2; i != 3; ++i) {
        for (int j = -2; j != 3; ++j) {
          (IsWall(place.x() + 0.05 * i, place.y() + 0.05 * j) ? wall_near
                                                              : free_near) =
              true;
        }
      }
      if (!free_near) continue;
      grid.SetProbability(
          cell, wall_near && IsWall(place.x(), place.y()) ? 0.8f : 0.2f);
    }
    Random random(1);
    for (int i = 0; i != 30; ++i) {
      poses.push_back(Rigid2d({-10. + 0.6 * i, 0.3 * std::sin(0.5 * i)},
                              0.3 * std::sin(0.7 * i)));
      PointCloud cloud;
      for (int beam = 0; beam != 180; ++beam) {
        const double angle = kPi * (beam - 90) / 180.;
        const double heading = poses.back().rotation().angle() + angle;
        double range = 0.;
        while (range < 25. && !IsWall(poses.back().translation().x() +
                                          range * std::cos(heading),
                                      poses.back().translation().y() +
                                          range * std::sin(heading))) {
          range += 0.02;
        }
        range += random.Normal() * 0.01;
        cloud.push_back({Eigen::Vector3d(range * std::cos(angle),
                                         range * std::sin(angle), 0.)
                             .cast<float>()});
      }
      scans.push_back(cloud);
    }
  }

  mapping::ValueConversionTables tables;
  mapping::ProbabilityGrid grid;
  std::vector<Rigid2d> poses;
  std::vector<PointCloud> scans;
};

const World& GetWorld() {
  static const World* const world = new World;
  return *world;
}

stock::proto::FastCorrelativeScanMatcherOptions2D SearchOptions() {
  stock::proto::FastCorrelativeScanMatcherOptions2D options;
  options.set_linear_search_window(7.);
  options.set_angular_search_window(DegToRad(30.));
  options.set_branch_and_bound_depth(7);
  return options;
}

template <typename Matcher>
void BM_Prepare(benchmark::State& state) {
  for (auto _ : state) {
    const Matcher matcher(GetWorld().grid, SearchOptions());
    benchmark::DoNotOptimize(&matcher);
  }
}

template <typename Matcher>
void BM_Search(benchmark::State& state) {
  const World& world = GetWorld();
  const Matcher matcher(world.grid, SearchOptions());
  const bool full_submap = state.range(0) != 0;
  const Rigid2d error({1.5, -0.8}, 0.2);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = 7 * i++ % world.scans.size();
    float score = 0.f;
    Rigid2d pose;
    benchmark::DoNotOptimize(
        full_submap
            ? matcher.MatchFullSubmap(world.scans[k], 0.6f, &score, &pose)
            : matcher.Match(world.poses[k] * error, world.scans[k], 0.55f,
                            &score, &pose));
  }
}

template <typename Matcher>
void BM_RealTime(benchmark::State& state) {
  const World& world = GetWorld();
  stock::proto::RealTimeCorrelativeScanMatcherOptions options;
  options.set_linear_search_window(0.1);
  options.set_angular_search_window(DegToRad(20.));
  options.set_translation_delta_cost_weight(0.1);
  options.set_rotation_delta_cost_weight(0.1);
  const Matcher matcher(options);
  const Rigid2d error({0.04, -0.03}, 0.05);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = 7 * i++ % world.scans.size();
    Rigid2d pose;
    benchmark::DoNotOptimize(matcher.Match(world.poses[k] * error,
                                           world.scans[k], world.grid, &pose));
  }
}

BENCHMARK_TEMPLATE(BM_Prepare, stock::FastCorrelativeScanMatcher2D)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(BM_Prepare, scan_matching::FastCorrelativeMatcher2D)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(BM_Search, stock::FastCorrelativeScanMatcher2D)
    ->ArgName("full_submap")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(BM_Search, scan_matching::FastCorrelativeMatcher2D)
    ->ArgName("full_submap")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(BM_RealTime, stock::RealTimeCorrelativeScanMatcher2D)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(BM_RealTime, scan_matching::RealTimeMatcher2D)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cartographer_ext
