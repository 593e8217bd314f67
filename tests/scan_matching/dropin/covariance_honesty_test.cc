// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the noise model of scan_information.h against simulated runs: scans are
// matched with submaps made from earlier scans at their true poses, starting
// from a wrong prediction of known covariance, and the errors are compared with
// the covariance that is reported.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Eigen/Eigenvalues"
#include "absl/types/variant.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/options/option_description.h"
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"
#include "cartographer_ext/simulation/world_source.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
namespace transform = cartographer::transform;

constexpr double kTranslationSigma = 0.03;
constexpr double kRotationSigma = 0.01;

struct Sample {
  double x = 0.;        // of the robot in the world, metres
  double nees = 0.;     // squared error under the covariance, 3 unknowns
  double longest = 0.;  // long axis of the covariance in the world, radians
  MatchReport report;
};

mapping::proto::SubmapsOptions2D SubmapOptions() {
  mapping::proto::SubmapsOptions2D options;
  options.set_num_range_data(90);
  options.mutable_grid_options_2d()->set_grid_type(
      mapping::proto::GridOptions2D::PROBABILITY_GRID);
  options.mutable_grid_options_2d()->set_resolution(0.05);
  auto* const inserter = options.mutable_range_data_inserter_options();
  inserter->set_range_data_inserter_type(
      mapping::proto::RangeDataInserterOptions::PROBABILITY_GRID_INSERTER_2D);
  auto* const probability =
      inserter->mutable_probability_grid_range_data_inserter_options_2d();
  probability->set_insert_free_space(true);
  probability->set_hit_probability(0.55);
  probability->set_miss_probability(0.49);
  return options;
}

mapping::proto::MotionFilterOptions FilterOptions() {
  mapping::proto::MotionFilterOptions options;
  options.set_max_time_seconds(5.);
  options.set_max_distance_meters(0.2);
  options.set_max_angle_radians(DegToRad(1.));
  return options;
}

sensor::RangeData ToRangeData(const io::LaserScan& scan) {
  sensor::RangeData data;
  data.origin = Eigen::Vector3f(static_cast<float>(scan.laser_pose.x),
                                static_cast<float>(scan.laser_pose.y), 0.f);
  for (size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (!(range >= scan.range_min)) continue;
    const bool miss = range > scan.range_max;
    const double angle = scan.angle_min + i * scan.angle_increment;
    const double length = miss ? 5. : range;
    const Eigen::Vector2d point =
        scan.laser_pose *
        Eigen::Vector2d(length * std::cos(angle), length * std::sin(angle));
    (miss ? data.misses : data.returns)
        .push_back({Eigen::Vector3f(static_cast<float>(point.x()),
                                    static_cast<float>(point.y()), 0.f)});
  }
  data.returns = sensor::VoxelFilter(data.returns, 0.025f);
  data.misses = sensor::VoxelFilter(data.misses, 0.025f);
  return data;
}

// Matches a scan taken at (grid <- robot) = `truth` from a prediction beside
// it.
Sample MatchBeside(const DegeneracyAwareScanMatcher2D& matcher,
                   const Pose2& truth, const double grid_heading,
                   const sensor::PointCloud& points,
                   const mapping::Grid2D& grid, Random* const random) {
  Prediction prediction;
  prediction.pose = Pose2(truth.x + kTranslationSigma * random->Normal(),
                          truth.y + kTranslationSigma * random->Normal(),
                          truth.theta + kRotationSigma * random->Normal());
  prediction.covariance.diagonal() << kTranslationSigma * kTranslationSigma,
      kTranslationSigma * kTranslationSigma, kRotationSigma * kRotationSigma;
  Sample sample;
  transform::Rigid2d pose;
  matcher.MatchWithPrediction(
      prediction,
      transform::Rigid2d({prediction.pose.x, prediction.pose.y},
                         prediction.pose.theta),
      points, grid, &pose, &sample.report);
  const Eigen::Vector3d error(
      pose.translation().x() - truth.x, pose.translation().y() - truth.y,
      NormalizeAngle(pose.rotation().angle() - truth.theta));
  sample.nees = error.dot(sample.report.information * error);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      Eigen::Matrix2d(sample.report.covariance.topLeftCorner<2, 2>()));
  const Eigen::Vector2d longest = solver.eigenvectors().col(1);
  sample.longest = std::atan2(longest.y(), longest.x()) - grid_heading;
  return sample;
}

// Every `stride`-th scan of the first `seconds` of a run. The grid lies in the
// world at random.
std::vector<Sample> MatchRun(const std::string& world, const uint64_t seed,
                             const double seconds, const int stride) {
  simulation::SimulationOptions simulation_options;
  simulation_options.seed = seed;
  auto source = simulation::OpenWorldWithOptions(
      "configuration_files/worlds/" + world + ".world", simulation_options);
  EXPECT_TRUE(source.ok()) << source.status();
  std::vector<Sample> samples;
  if (!source.ok()) return samples;
  const simulation::Simulation& simulation = (*source)->simulation();

  mapping::scan_matching::proto::CeresScanMatcherOptions2D stock;
  stock.set_occupied_space_weight(1.);
  stock.set_translation_weight(10.);
  stock.set_rotation_weight(40.);
  stock.mutable_ceres_solver_options()->set_max_num_iterations(20);
  stock.mutable_ceres_solver_options()->set_num_threads(1);
  proto::ScanMatcherOptions extension;
  options::SetDefaults(&extension);
  const DegeneracyAwareScanMatcher2D matcher(stock, extension);

  mapping::ActiveSubmaps2D submaps(SubmapOptions());
  mapping::MotionFilter filter(FilterOptions());
  sensor::proto::AdaptiveVoxelFilterOptions voxels;
  voxels.set_max_length(0.5f);
  voxels.set_min_num_points(200);
  voxels.set_max_range(50.f);
  Random random(seed * 77 + 5);
  const Pose2 grid_from_world(random.Uniform(-3., 3.), random.Uniform(-3., 3.),
                              random.Uniform(-kPi, kPi));
  int inserted = 0;
  io::SensorEvent event;
  for (int64_t i = 0; i < simulation.num_scans();) {
    const auto more = (*source)->Next(&event);
    if (!more.ok() || !*more) break;
    const auto* const scan = absl::get_if<io::LaserScan>(&event);
    if (scan == nullptr) continue;
    const double time = simulation.ScanTime(i++);
    if (time > seconds) break;
    const Pose2 in_world = simulation.drive().PoseAt(time);
    const Pose2 truth = grid_from_world * in_world;
    const sensor::RangeData data = ToRangeData(*scan);
    if (data.returns.empty()) continue;
    if (inserted > 20 && i % stride == 0) {
      samples.push_back(
          MatchBeside(matcher, truth, grid_from_world.theta,
                      sensor::AdaptiveVoxelFilter(data.returns, voxels),
                      *submaps.submaps().front()->grid(), &random));
      samples.back().x = in_world.x;
    }
    const transform::Rigid3d inserted_at =
        transform::Embed3D(transform::Rigid2d({truth.x, truth.y}, truth.theta));
    if (!filter.IsSimilar(cartographer::common::FromUniversal(
                              static_cast<int64_t>(time * 1e7)),
                          inserted_at)) {
      submaps.InsertRangeData(
          sensor::TransformRangeData(data, inserted_at.cast<float>()));
      ++inserted;
    }
  }
  return samples;
}

TEST(CovarianceHonestyTest, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int kRuns = 6;
  double sum_of_runs = 0.;
  for (int seed = 1; seed <= kRuns; ++seed) {
    double sum = 0.;
    int count = 0;
    for (const Sample& sample : MatchRun("office", seed, 70., 9)) {
      if (sample.report.degeneracy.state != DegeneracyState::kNone) continue;
      sum += sample.nees;
      ++count;
    }
    ASSERT_GT(count, 20) << seed;
    sum_of_runs += sum / count;
  }
  // 95 % of chi2 with 3 * 6 degrees of freedom, per run.
  EXPECT_GT(sum_of_runs / kRuns, 8.23 / kRuns);
  EXPECT_LT(sum_of_runs / kRuns, 31.53 / kRuns);
}

TEST(CovarianceHonestyTest, ElongatedAlongTheCorridor) {
  std::vector<double> angles;
  int degenerate = 0, count = 0;
  double nees = 0.;
  for (int seed = 1; seed <= 3; ++seed) {
    // Between the end and the door, both out of sight.
    for (const Sample& sample : MatchRun("corridor_one_door", seed, 30., 5)) {
      if (sample.x < 14. || sample.x > 18.) continue;
      ++count;
      nees += sample.nees;
      if (sample.report.degeneracy.state == DegeneracyState::kTranslation) {
        ++degenerate;
      }
      angles.push_back(std::abs(std::asin(std::sin(sample.longest))));
    }
  }
  ASSERT_GT(count, 15);
  EXPECT_GE(degenerate, 0.8 * count);
  std::sort(angles.begin(), angles.end());
  EXPECT_LT(RadToDeg(angles[angles.size() / 2]), 2.5);
  EXPECT_LT(RadToDeg(angles[angles.size() * 9 / 10]), 5.);
  EXPECT_LT(nees / count, 5.);
}

TEST(CovarianceHonestyTest, RoundRoomKnowsItsCentreOnly) {
  int count = 0, without_heading = 0;
  for (const Sample& sample : MatchRun("circular_room", 2, 40., 7)) {
    ++count;
    const DegeneracyState state = sample.report.degeneracy.state;
    if (state == DegeneracyState::kTranslationAndRotation ||
        state == DegeneracyState::kRotation) {
      ++without_heading;
    }
  }
  ASSERT_GT(count, 10);
  EXPECT_GE(without_heading, 0.9 * count);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
