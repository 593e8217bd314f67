// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Times of the host's scan matchers and range data insertion in a simulated
// building: 180 beams, cells of 5 cm, Cartographer's default options.
//
//   cmake --preset release -DCARTOGRAPHER_EXT_BUILD_BENCHMARKS=ON
//   ninja -C build/release host_matchers_benchmark
//   build/release/tests/benchmark/host_matchers_benchmark
#include <cmath>
#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "benchmark/benchmark.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace {

namespace mapping = cartographer::mapping;
namespace scan_matching = cartographer::mapping::scan_matching;
namespace sensor = cartographer::sensor;
using cartographer::transform::Rigid2d;

constexpr int kBeams = 180;
constexpr double kMaxRange = 30.;

// Rooms of different width left and right of a corridor along x, door openings
// included. Distance to the nearest wall along a ray from a place in it.
double Range(const double x, const double y, const double angle) {
  const auto blocked = [](const double px, const double py) {
    if (std::abs(py) > 9. || std::abs(px) > 40.) return true;
    if (std::abs(py) < 1.25) return false;
    const double room = py > 0. ? 5.3 : 6.7;
    const double in_room = px - room * std::floor(px / room);
    if (in_room < 0.15) return true;
    const bool at_corridor = std::abs(py) < 1.4;
    return at_corridor && (in_room < 1.5 || in_room > 2.5);
  };
  constexpr double kStep = 0.02;
  double range = 0.;
  while (range < kMaxRange &&
         !blocked(x + range * std::cos(angle), y + range * std::sin(angle))) {
    range += kStep;
  }
  return range;
}

// What the laser sees at `pose`, in its own frame.
sensor::PointCloud Scan(const Rigid2d& pose, Random* const random) {
  sensor::PointCloud cloud;
  for (int i = 0; i != kBeams; ++i) {
    const double angle = kPi * (i - kBeams / 2) / kBeams;
    const double range = Range(pose.translation().x(), pose.translation().y(),
                               pose.rotation().angle() + angle) +
                         random->Normal(0., 0.01);
    if (range > kMaxRange) continue;
    cloud.push_back(
        {Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0.)
             .cast<float>()});
  }
  return cloud;
}

sensor::RangeData InLocalFrame(const sensor::PointCloud& cloud,
                               const Rigid2d& pose) {
  const auto transform = cartographer::transform::Embed3D(pose).cast<float>();
  return {transform.translation(),
          sensor::TransformPointCloud(cloud, transform),
          {}};
}

mapping::proto::SubmapsOptions2D SubmapsOptions() {
  mapping::proto::SubmapsOptions2D options;
  options.set_num_range_data(90);
  options.mutable_grid_options_2d()->set_grid_type(
      mapping::proto::GridOptions2D::PROBABILITY_GRID);
  options.mutable_grid_options_2d()->set_resolution(0.05f);
  auto* const inserter = options.mutable_range_data_inserter_options();
  inserter->set_range_data_inserter_type(
      mapping::proto::RangeDataInserterOptions::PROBABILITY_GRID_INSERTER_2D);
  auto* const probabilities =
      inserter->mutable_probability_grid_range_data_inserter_options_2d();
  probabilities->set_hit_probability(0.55);
  probabilities->set_miss_probability(0.49);
  probabilities->set_insert_free_space(true);
  return options;
}

scan_matching::proto::FastCorrelativeScanMatcherOptions2D SearchOptions() {
  scan_matching::proto::FastCorrelativeScanMatcherOptions2D options;
  options.set_linear_search_window(7.);
  options.set_angular_search_window(DegToRad(30.));
  options.set_branch_and_bound_depth(7);
  return options;
}

// A finished submap of a drive along the corridor, and scans from it.
struct World {
  World() {
    Random random(1);
    mapping::ActiveSubmaps2D active(SubmapsOptions());
    for (int i = 0; i != 180; ++i) {
      poses.push_back(Rigid2d({-6. + 0.07 * i, 0.3 * std::sin(0.05 * i)},
                              0.1 * std::sin(0.1 * i)));
      scans.push_back(Scan(poses.back(), &random));
      submap = active.InsertRangeData(InLocalFrame(scans.back(), poses.back()))
                   .front();
    }
  }
  std::vector<Rigid2d> poses;
  std::vector<sensor::PointCloud> scans;
  std::shared_ptr<const mapping::Submap2D> submap;
};

const World& GetWorld() {
  static const World* const world = new World;
  return *world;
}

void BM_InsertRangeData(benchmark::State& state) {
  const World& world = GetWorld();
  const mapping::proto::SubmapsOptions2D options = SubmapsOptions();
  mapping::ActiveSubmaps2D active(options);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = i++ % world.scans.size();
    active.InsertRangeData(InLocalFrame(world.scans[k], world.poses[k]));
  }
}
BENCHMARK(BM_InsertRangeData)->Unit(benchmark::kMicrosecond);

void BM_RealTimeCorrelativeMatch(benchmark::State& state) {
  const World& world = GetWorld();
  scan_matching::proto::RealTimeCorrelativeScanMatcherOptions options;
  options.set_linear_search_window(0.1);
  options.set_angular_search_window(DegToRad(20.));
  options.set_translation_delta_cost_weight(0.1);
  options.set_rotation_delta_cost_weight(0.1);
  const scan_matching::RealTimeCorrelativeScanMatcher2D matcher(options);
  const Rigid2d error({0.04, -0.03}, 0.05);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = i++ % world.scans.size();
    Rigid2d pose;
    benchmark::DoNotOptimize(matcher.Match(
        world.poses[k] * error, world.scans[k], *world.submap->grid(), &pose));
  }
}
BENCHMARK(BM_RealTimeCorrelativeMatch)->Unit(benchmark::kMicrosecond);

void BM_BuildSearchGrids(benchmark::State& state) {
  for (auto _ : state) {
    const scan_matching::FastCorrelativeScanMatcher2D matcher(
        *GetWorld().submap->grid(), SearchOptions());
    benchmark::DoNotOptimize(&matcher);
  }
}
BENCHMARK(BM_BuildSearchGrids)->Unit(benchmark::kMicrosecond);

void BM_Search(benchmark::State& state) {
  const World& world = GetWorld();
  const bool full_submap = state.range(0) != 0;
  const scan_matching::FastCorrelativeScanMatcher2D matcher(
      *world.submap->grid(), SearchOptions());
  const Rigid2d error({1.5, -0.8}, 0.2);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = 17 * i++ % world.scans.size();
    float score = 0.f;
    Rigid2d pose;
    benchmark::DoNotOptimize(
        full_submap
            ? matcher.MatchFullSubmap(world.scans[k], 0.6f, &score, &pose)
            : matcher.Match(world.poses[k] * error, world.scans[k], 0.55f,
                            &score, &pose));
  }
}
BENCHMARK(BM_Search)
    ->ArgName("full_submap")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);

void BM_CeresMatch(benchmark::State& state) {
  const World& world = GetWorld();
  scan_matching::proto::CeresScanMatcherOptions2D options;
  options.set_occupied_space_weight(20.);
  options.set_translation_weight(10.);
  options.set_rotation_weight(1.);
  options.mutable_ceres_solver_options()->set_use_nonmonotonic_steps(true);
  options.mutable_ceres_solver_options()->set_max_num_iterations(10);
  options.mutable_ceres_solver_options()->set_num_threads(1);
  const scan_matching::CeresScanMatcher2D matcher(options);
  const Rigid2d error({0.03, -0.02}, 0.01);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = i++ % world.scans.size();
    const Rigid2d initial = world.poses[k] * error;
    Rigid2d pose;
    ceres::Solver::Summary summary;
    matcher.Match(initial.translation(), initial, world.scans[k],
                  *world.submap->grid(), &pose, &summary);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(BM_CeresMatch)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cartographer_ext
