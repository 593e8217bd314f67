// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/scan_assembler.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_room.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::TimedPointCloudOriginData;

cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D Options() {
  cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D options;
  options.set_min_range(0.5);
  options.set_max_range(10.);
  options.set_min_z(-1.);
  options.set_max_z(1.);
  options.set_missing_data_ray_length(2.);
  options.set_voxel_filter_size(0.01);
  return options;
}

// Points with their times before the end of the sweep, seconds.
TimedPointCloudOriginData Sweep(
    const std::vector<std::pair<Eigen::Vector3f, float>>& points) {
  TimedPointCloudOriginData sweep;
  sweep.time = test::At(1.);
  sweep.origins.push_back(Eigen::Vector3f::Zero());
  for (const auto& point : points) {
    TimedPointCloudOriginData::RangeMeasurement range;
    range.point_time.position = point.first;
    range.point_time.time = point.second;
    range.intensity = 0.f;
    range.origin_index = 0;
    sweep.ranges.push_back(range);
  }
  return sweep;
}

TEST(ScanAssemblerTest, SortsPointsByRange) {
  ScanAssembler assembler(Options(), WallFillingOptions(), true);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  assembler.Add(Sweep({{{1.f, 0.f, 0.f}, 0.f},
                       {{0.2f, 0.f, 0.f}, 0.f},
                       {{0.f, 20.f, 0.f}, 0.f},
                       {{nan, 0.f, 0.f}, 0.f},
                       {{infinity, 0.f, 0.f}, 0.f}}),
                0., Pose2(), Eigen::Quaterniond::Identity());
  EXPECT_EQ(assembler.num_sweeps(), 1);
  const AssembledScan scan = assembler.Take();
  EXPECT_EQ(assembler.num_sweeps(), 0);
  ASSERT_EQ(scan.range_data.returns.size(), 1);
  EXPECT_NEAR(scan.range_data.returns[0].position.x(), 1.f, 1e-6f);
  // Beyond the maximum only the beginning of the ray is free.
  ASSERT_EQ(scan.range_data.misses.size(), 1);
  EXPECT_NEAR(scan.range_data.misses[0].position.y(), 2.f, 1e-6f);
}

TEST(ScanAssemblerTest, PointsAreMovedToTheEndOfTheSweep) {
  ScanAssembler assembler(Options(), WallFillingOptions(), true);
  // In 0.2 s since the last match the robot went 1 m; the first point is half
  // as old.
  assembler.Add(Sweep({{{5.f, 1.f, 0.f}, -0.1f}, {{5.f, -1.f, 0.f}, 0.f}}), 0.2,
                Pose2(1., 0., 0.), Eigen::Quaterniond::Identity());
  const auto range_data = assembler.Take().range_data;
  ASSERT_EQ(range_data.returns.size(), 2);
  EXPECT_NEAR(range_data.returns[0].position.x(), 4.5f, 1e-5f);
  EXPECT_NEAR(range_data.returns[1].position.x(), 5.f, 1e-5f);
  EXPECT_NEAR(range_data.origin.norm(), 0.f, 1e-6f);
}

TEST(ScanAssemblerTest, SeveralSweepsMeetInTheLastFrame) {
  ScanAssembler assembler(Options(), WallFillingOptions(), true);
  assembler.Add(Sweep({{{5.f, 0.f, 0.f}, 0.f}}), 0.1, Pose2(0.5, 0., 0.),
                Eigen::Quaterniond::Identity());
  assembler.Add(Sweep({{{0.f, 5.f, 0.f}, 0.f}}), 0.2, Pose2(1., 0., kPi / 2.),
                Eigen::Quaterniond::Identity());
  EXPECT_EQ(assembler.num_sweeps(), 2);
  const auto range_data = assembler.Take().range_data;
  ASSERT_EQ(range_data.returns.size(), 2);
  // (5.5, 0) seen from (1, 0) turned left by a quarter.
  EXPECT_NEAR(range_data.returns[0].position.x(), 0.f, 1e-5f);
  EXPECT_NEAR(range_data.returns[0].position.y(), -4.5f, 1e-5f);
  EXPECT_NEAR(range_data.returns[1].position.y(), 5.f, 1e-5f);
}

TEST(ScanAssemblerTest, TiltIsLevelled) {
  ScanAssembler assembler(Options(), WallFillingOptions(), true);
  const Eigen::Quaterniond tilt(
      Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3f seen =
      tilt.conjugate().cast<float>() * Eigen::Vector3f(4.f, 1.f, 0.f);
  assembler.Add(Sweep({{seen, 0.f}}), 0.1, Pose2(), tilt);
  const auto range_data = assembler.Take().range_data;
  ASSERT_EQ(range_data.returns.size(), 1);
  EXPECT_NEAR(
      (range_data.returns[0].position - Eigen::Vector3f(4.f, 1.f, 0.f)).norm(),
      0.f, 1e-5f);
}

TEST(ScanAssemblerTest, WallsAreCompletedApartFromTheReturns) {
  WallFillingOptions filling;
  filling.spacing = 0.05;
  ScanAssembler assembler(Options(), filling, true);
  assembler.Add(Sweep({{{2.f, 0.f, 0.f}, 0.f},
                       {{2.f, 0.2f, 0.f}, 0.f},
                       {{2.f, 0.4f, 0.f}, 0.f},
                       {{2.f, 0.6f, 0.f}, 0.f}}),
                0., Pose2(), Eigen::Quaterniond::Identity());
  const AssembledScan scan = assembler.Take();
  EXPECT_EQ(scan.range_data.returns.size(), 4);
  EXPECT_EQ(scan.filling.size(), 3);
}

// Root mean square of the distances of points from the wall that they are on,
// across the x axis and 8 m away, after many scans of a laser with 1 % of noise.
double ErrorOfWall(const bool smooth_ranges) {
  auto options = Options();
  options.set_max_range(20.);
  options.mutable_submaps_options()->mutable_grid_options_2d()->set_resolution(
      0.05);
  ScanAssembler assembler(options, WallFillingOptions(), smooth_ranges);
  Random random(5);
  double squares = 0.;
  int count = 0;
  for (int n = 0; n < 200; ++n) {
    std::vector<std::pair<Eigen::Vector3f, float>> points;
    for (int i = -40; i <= 40; ++i) {
      const double bearing = DegToRad(i);
      const double range =
          8. / std::cos(bearing) * (1. + 0.01 * random.Normal());
      points.push_back({Eigen::Vector3f(range * std::cos(bearing),
                                        range * std::sin(bearing), 0.f),
                        0.f});
    }
    assembler.Add(Sweep(points), 0., Pose2(), Eigen::Quaterniond::Identity());
    const auto returns = assembler.Take().range_data.returns;
    for (const auto& point : returns) {
      if (n < 100) continue;
      squares += std::pow(point.position.x() - 8., 2);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(ScanAssemblerTest, NoisyRangesAreSmoothedWhereTheOptionsSaySo) {
  EXPECT_NEAR(ErrorOfWall(false), 0.08, 0.01);
  EXPECT_LT(ErrorOfWall(true), 0.05);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
