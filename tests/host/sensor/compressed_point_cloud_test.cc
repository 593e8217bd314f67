// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/compressed_point_cloud.h"

#include <cmath>
#include <limits>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace sensor {
namespace {

RangefinderPoint P(const float x, const float y, const float z) {
  return {Eigen::Vector3f(x, y, z)};
}

std::vector<int32> DataOf(const CompressedPointCloud& cloud) {
  const proto::CompressedPointCloud proto = cloud.ToProto();
  return {proto.point_data().begin(), proto.point_data().end()};
}

proto::CompressedPointCloud Proto(const int num_points,
                                  const std::vector<int32>& data) {
  proto::CompressedPointCloud proto;
  proto.set_num_points(num_points);
  for (const int32 value : data) proto.add_point_data(value);
  return proto;
}

TEST(CompressedPointCloudTest, Empty) {
  const CompressedPointCloud cloud{PointCloud()};
  EXPECT_TRUE(cloud.empty());
  EXPECT_EQ(cloud.size(), 0);
  EXPECT_TRUE(cloud.Decompress().empty());
  EXPECT_FALSE(cloud.begin() != cloud.end());
}

TEST(CompressedPointCloudTest, FormatByHand) {
  // 1.234 m = 1 * 1024 + 210 mm; -0.001 m = -1 * 1024 + 1023 mm.
  const CompressedPointCloud cloud(PointCloud(
      {P(1.234f, 0.f, 0.002f), P(-0.001f, 0.f, 0.f), P(1.024f, 1.023f, 0.f)}));
  EXPECT_EQ(DataOf(cloud),
            (std::vector<int32>{1, -1, 0, 0, 1023,  //
                                2, 1, 0, 0, (2 << 20) | 210, 1023 << 10}));
  EXPECT_EQ(cloud.ToProto().num_points(), 3);
}

TEST(CompressedPointCloudTest, NeighbouringCubesStayTogether) {
  // In cubes along x and y: those of one block of 8 x 8 before the next, y
  // before x.
  const float kCube = 1.024f;
  const CompressedPointCloud cloud(
      PointCloud({P(9.5f * kCube, 0.f, 0.f), P(0.f, 7.5f * kCube, 0.f),
                  P(0.f, -1.f, 0.f), P(-1.f, 0.f, 0.f), P(1.5f, 0.f, 0.f)}));
  std::vector<int32> cubes;
  const std::vector<int32> data = DataOf(cloud);
  for (size_t i = 0; i < data.size(); i += 5) {
    cubes.push_back(10 * data[i + 1] + data[i + 2]);
  }
  EXPECT_EQ(cubes, (std::vector<int32>{-1, -10, 10, 7, 90}));
}

TEST(CompressedPointCloudTest, RoundsToMillimetres) {
  std::vector<RangefinderPoint> points;
  for (int i = -500; i != 500; ++i) {
    points.push_back(P(0.0137f * i, -0.031f * i, 0.25f * (i % 7)));
  }
  const CompressedPointCloud cloud{PointCloud(points)};
  ASSERT_EQ(cloud.size(), points.size());
  for (const RangefinderPoint& point : cloud) {
    float nearest = 1.f;
    for (const RangefinderPoint& original : points) {
      nearest = std::min(
          nearest,
          (point.position - original.position).lpNorm<Eigen::Infinity>());
    }
    EXPECT_LE(nearest, 0.00051f);
  }
  // Once rounded, nothing changes any more.
  const CompressedPointCloud again(cloud.Decompress());
  EXPECT_TRUE(again == cloud);
  EXPECT_TRUE(CompressedPointCloud(cloud.ToProto()) == cloud);
}

TEST(CompressedPointCloudTest, LargestCoordinates) {
  const CompressedPointCloud cloud(PointCloud({P(8388.f, -8388.f, 0.f)}));
  const RangefinderPoint point = *cloud.begin();
  EXPECT_NEAR(point.position.x(), 8388.f, 1e-3f);
  EXPECT_NEAR(point.position.y(), -8388.f, 1e-3f);
}

TEST(CompressedPointCloudDeathTest, RefusesWhatDoesNotFit) {
  EXPECT_DEATH(CompressedPointCloud(PointCloud({P(9000.f, 0.f, 0.f)})), "");
  EXPECT_DEATH(CompressedPointCloud(PointCloud({P(std::nanf(""), 0.f, 0.f)})),
               "");
}

TEST(CompressedPointCloudDeathTest, BrokenDataIsFatal) {
  CompressedPointCloud whole(Proto(1, {1, 0, 0, 0, 5}));
  EXPECT_EQ(whole.size(), 1);
  const char* const message = "broken compressed point cloud";
  EXPECT_DEATH(CompressedPointCloud(Proto(2, {1, 0, 0, 0, 5})), message);
  EXPECT_DEATH(CompressedPointCloud(Proto(1, {2, 0, 0, 0, 5})), message);
  EXPECT_DEATH(CompressedPointCloud(Proto(0, {0, 0, 0, 0})), message);
  EXPECT_DEATH(CompressedPointCloud(Proto(-1, {-1, 0, 0, 0, 5})), message);
  EXPECT_DEATH(CompressedPointCloud(Proto(1, {1, 0, 0})), message);
  EXPECT_DEATH(CompressedPointCloud(Proto(1, {1, 1 << 20, 0, 0, 5})), message);
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
