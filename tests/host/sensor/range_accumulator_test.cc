// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/range_accumulator.h"

#include <cmath>
#include <vector>

#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using transform::Rigid3d;
using transform::Rigid3f;

proto::LocalTrajectoryBuilderOptions2D Options(const int num_sweeps) {
  proto::LocalTrajectoryBuilderOptions2D options;
  options.set_min_range(1.f);
  options.set_max_range(10.f);
  options.set_missing_data_ray_length(5.f);
  options.set_min_z(-0.5f);
  options.set_max_z(0.5f);
  options.set_voxel_filter_size(0.001f);
  options.set_num_accumulated_range_data(num_sweeps);
  return options;
}

// A sensor at (1, 0, 0) and points in the tracking frame.
sensor::TimedPointCloudOriginData Sweep(
    const std::vector<Eigen::Vector3f>& points) {
  sensor::TimedPointCloudOriginData sweep;
  sweep.origins = {Eigen::Vector3f(1.f, 0.f, 0.f)};
  for (const Eigen::Vector3f& point : points) {
    sweep.ranges.push_back({{point, 0.f}, 0.f, 0});
  }
  return sweep;
}

TEST(RangeAccumulatorTest, SortsRangesIntoReturnsAndMisses) {
  RangeAccumulator accumulator(Options(1));
  accumulator.Add(Sweep({{3.f, 0.f, 0.f},   // 2 m: a return
                         {1.5f, 0.f, 0.f},  // 0.5 m: too near
                         {1.f, 11.f, 0.f},  // 11 m: a miss
                         {1.f, 10.f, 0.f},  // the last return
                         {3.f, 0.f, 0.6f},  // too high
                         {std::nanf(""), 0.f, 0.f}}),
                  std::vector<Rigid3f>(6, Rigid3f::Identity()));
  ASSERT_TRUE(accumulator.IsComplete());
  const sensor::RangeData data =
      accumulator.Take(Rigid3f::Identity(), Rigid3f::Identity());
  ASSERT_EQ(data.returns.size(), 2u);
  EXPECT_TRUE(data.returns[0].position.isApprox(Eigen::Vector3f(3, 0, 0)));
  EXPECT_TRUE(data.returns[1].position.isApprox(Eigen::Vector3f(1, 10, 0)));
  ASSERT_EQ(data.misses.size(), 1u);
  EXPECT_TRUE(data.misses[0].position.isApprox(Eigen::Vector3f(1, 5, 0)));
}

TEST(RangeAccumulatorTest, UnwarpsWithThePoseOfEveryPoint) {
  RangeAccumulator accumulator(Options(2));
  const auto at = [](const float x) {
    return Rigid3f::Translation(Eigen::Vector3f(x, 0.f, 0.f));
  };
  accumulator.Add(Sweep({{4.f, 0.f, 0.f}}), {at(0.f)});
  EXPECT_FALSE(accumulator.IsComplete());
  accumulator.Add(Sweep({{4.f, 1.f, 0.f}, {4.f, 2.f, 0.f}}),
                  {at(1.f), at(2.f)});
  EXPECT_TRUE(accumulator.IsComplete());
  // Seen from the newest pose.
  const sensor::RangeData data = accumulator.Take(at(2.f), Rigid3f::Identity());
  EXPECT_LT(data.origin.norm(), 1e-6);
  ASSERT_EQ(data.returns.size(), 3u);
  EXPECT_TRUE(data.returns[0].position.isApprox(Eigen::Vector3f(2, 0, 0)));
  EXPECT_TRUE(data.returns[1].position.isApprox(Eigen::Vector3f(3, 1, 0)));
  EXPECT_TRUE(data.returns[2].position.isApprox(Eigen::Vector3f(4, 2, 0)));
  // Taken means gone.
  EXPECT_FALSE(accumulator.IsComplete());
  EXPECT_TRUE(accumulator.Take(at(2.f), Rigid3f::Identity()).returns.empty());
}

TEST(RangeAccumulatorTest, CropsAndThinsAfterGravityAlignment) {
  auto options = Options(1);
  options.set_voxel_filter_size(1.f);
  RangeAccumulator accumulator(options);
  // Pitched by 45 degrees: the first two points are level in the world.
  const Rigid3f level =
      Rigid3f::Rotation(Eigen::AngleAxisf(M_PI / 4., Eigen::Vector3f::UnitY()));
  const Rigid3f tilt = level.inverse();
  accumulator.Add(Sweep({tilt * Eigen::Vector3f(4.2f, 0.1f, 0.f),
                         tilt * Eigen::Vector3f(4.3f, 0.2f, 0.f),
                         {4.f, 0.f, 0.f}}),
                  std::vector<Rigid3f>(3, Rigid3f::Identity()));
  const sensor::RangeData data = accumulator.Take(Rigid3f::Identity(), level);
  ASSERT_EQ(data.returns.size(), 1u);
  EXPECT_NEAR(data.returns[0].position.z(), 0.f, 1e-5);
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
