// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/voxel_filter.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/math.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace sensor {
namespace {

RangefinderPoint P(const float x, const float y, const float z) {
  return {Eigen::Vector3f(x, y, z)};
}

// Points on a line, 1 cm apart.
PointCloud Line(const int size) {
  std::vector<RangefinderPoint> points;
  for (int i = 0; i != size; ++i) points.push_back(P(0.01f * i, 1.f, 0.f));
  return PointCloud(points);
}

proto::AdaptiveVoxelFilterOptions Options(const float max_length,
                                          const float min_num_points,
                                          const float max_range) {
  proto::AdaptiveVoxelFilterOptions options;
  options.set_max_length(max_length);
  options.set_min_num_points(min_num_points);
  options.set_max_range(max_range);
  return options;
}

TEST(VoxelFilterTest, OnePointOfEveryVoxel) {
  // Voxels are centred on multiples of the resolution.
  const std::vector<RangefinderPoint> points = {
      P(0.f, 0.f, 0.f), P(0.1f, -0.1f, 0.f), P(0.3f, 0.1f, 0.f),
      P(0.6f, 0.f, 0.f), P(0.f, 0.f, 0.9f)};
  const auto filtered = VoxelFilter(points, 0.5f);
  ASSERT_EQ(filtered.size(), 3);
  // {0, 1}, {2, 3} and {4}.
  EXPECT_TRUE(filtered[0] == points[0] || filtered[0] == points[1]);
  EXPECT_TRUE(filtered[1] == points[2] || filtered[1] == points[3]);
  EXPECT_TRUE(filtered[2] == points[4]);
}

TEST(VoxelFilterTest, SameInputSameOutput) {
  const PointCloud line = Line(500);
  EXPECT_EQ(VoxelFilter(line, 0.07f).points(),
            VoxelFilter(line, 0.07f).points());
}

TEST(VoxelFilterTest, KeepsTheOrderAndCoversEveryVoxel) {
  const PointCloud line = Line(1000);
  const PointCloud filtered = VoxelFilter(line, 0.1f);
  std::set<int> voxels, filtered_voxels;
  for (const auto& p : line)
    voxels.insert(common::RoundToInt(p.position.x() / 0.1f));
  float last = -1.f;
  for (const auto& p : filtered) {
    EXPECT_GT(p.position.x(), last);
    last = p.position.x();
    filtered_voxels.insert(common::RoundToInt(p.position.x() / 0.1f));
  }
  EXPECT_EQ(filtered_voxels, voxels);
  EXPECT_EQ(filtered.size(), voxels.size());
}

TEST(VoxelFilterTest, ChancesAreEqual) {
  // 4000 voxels with four points each: each place is chosen about 1000 times.
  std::vector<RangefinderPoint> points;
  for (int i = 0; i != 4000; ++i) {
    for (int k = 0; k != 4; ++k) points.push_back(P(i, 0.1f * k, 0.f));
  }
  std::map<int, int> counts;
  for (const auto& p : VoxelFilter(points, 1.f)) {
    ++counts[common::RoundToInt(10.f * p.position.y())];
  }
  ASSERT_EQ(counts.size(), 4);
  for (const auto& entry : counts) {
    EXPECT_NEAR(entry.second, 1000, 150) << entry.first;  // 5.5 sigma
  }
}

TEST(VoxelFilterTest, IntensitiesTimesAndOriginsGoAlong) {
  const PointCloud cloud({P(0, 0, 0), P(5, 0, 0), P(9, 0, 0)}, {1, 2, 3});
  EXPECT_EQ(VoxelFilter(cloud, 1.f).intensities(),
            (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(VoxelFilter(cloud, 100.f).intensities().size(), 1);

  const TimedPointCloud timed = {{Eigen::Vector3f(0.f, 0.f, 0.f), -2.f},
                                 {Eigen::Vector3f(5.f, 0.f, 0.f), -1.f}};
  EXPECT_EQ(VoxelFilter(timed, 1.f), timed);

  const std::vector<TimedPointCloudOriginData::RangeMeasurement> measurements =
      {{timed[0], 7.f, 1}, {timed[1], 8.f, 0}};
  const auto filtered = VoxelFilter(measurements, 1.f);
  ASSERT_EQ(filtered.size(), 2);
  EXPECT_EQ(filtered[0].intensity, 7.f);
  EXPECT_EQ(filtered[0].origin_index, 1);
  EXPECT_EQ(filtered[1].point_time.time, -1.f);
}

TEST(AdaptiveVoxelFilterTest, SparseCloudsStay) {
  const PointCloud line = Line(50);
  EXPECT_EQ(AdaptiveVoxelFilter(line, Options(0.5f, 50.f, 100.f)).points(),
            line.points());
}

TEST(AdaptiveVoxelFilterTest, LongestLengthIsUsedWhereItLeavesEnough) {
  const PointCloud line = Line(1000);
  EXPECT_EQ(AdaptiveVoxelFilter(line, Options(0.5f, 10.f, 100.f)).points(),
            VoxelFilter(line, 0.5f).points());
}

TEST(AdaptiveVoxelFilterTest, FindsALengthThatLeavesJustEnough) {
  const PointCloud line = Line(1000);
  const PointCloud filtered =
      AdaptiveVoxelFilter(line, Options(0.5f, 150.f, 100.f));
  EXPECT_GE(filtered.size(), 150);
  // The length is known to a tenth, and so is the number of points here.
  EXPECT_LE(filtered.size(), 170);
}

TEST(AdaptiveVoxelFilterTest, RangeIsLimited) {
  const PointCloud filtered =
      AdaptiveVoxelFilter(Line(1000), Options(0.1f, 10.f, 2.f));
  EXPECT_FALSE(filtered.empty());
  for (const auto& point : filtered) EXPECT_LE(point.position.norm(), 2.f);
}

TEST(AdaptiveVoxelFilterTest, EndsForPointsOnOneSpot) {
  const PointCloud spot(std::vector<RangefinderPoint>(100, P(1, 1, 1)));
  EXPECT_EQ(AdaptiveVoxelFilter(spot, Options(0.5f, 50.f, 10.f)).size(), 1);
}

TEST(AdaptiveVoxelFilterTest, OptionsFromLua) {
  common::LuaParameterDictionary dictionary(
      "return { max_length = 0.5, min_num_points = 200, max_range = 50 }",
      std::unique_ptr<common::FileResolver>(
          new common::ConfigurationFileResolver(std::vector<std::string>())));
  const auto options = CreateAdaptiveVoxelFilterOptions(&dictionary);
  EXPECT_EQ(options.max_length(), 0.5f);
  EXPECT_EQ(options.min_num_points(), 200.f);
  EXPECT_EQ(options.max_range(), 50.f);
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
