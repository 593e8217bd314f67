// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/point_cloud.h"

#include <cmath>
#include <vector>

#include "cartographer/sensor/range_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace sensor {
namespace {

RangefinderPoint P(const float x, const float y, const float z) {
  return {Eigen::Vector3f(x, y, z)};
}

const transform::Rigid3f kQuarterTurn(
    Eigen::Vector3f(10.f, 0.f, 0.f),
    Eigen::AngleAxisf(static_cast<float>(M_PI / 2.), Eigen::Vector3f::UnitZ()));

TEST(PointCloudTest, Basics) {
  PointCloud cloud;
  EXPECT_TRUE(cloud.empty());
  cloud.push_back(P(1, 2, 3));
  cloud.push_back(P(4, 5, 6));
  EXPECT_EQ(cloud.size(), 2);
  EXPECT_EQ(cloud[1], P(4, 5, 6));
  EXPECT_EQ(cloud.points()[0], P(1, 2, 3));
  EXPECT_EQ(cloud.end() - cloud.begin(), 2);
}

TEST(PointCloudTest, CopyIfTakesIntensitiesAlong) {
  const PointCloud cloud({P(0, 0, 0), P(1, 0, 0), P(2, 0, 0)}, {5, 6, 7});
  const PointCloud some = cloud.copy_if(
      [](const RangefinderPoint& p) { return p.position.x() != 1.f; });
  ASSERT_EQ(some.size(), 2);
  EXPECT_EQ(some[1], P(2, 0, 0));
  EXPECT_EQ(some.intensities(), (std::vector<float>{5, 7}));
}

TEST(PointCloudTest, Transform) {
  const PointCloud cloud({P(1, 2, 3)}, {0.5f});
  const PointCloud moved = TransformPointCloud(cloud, kQuarterTurn);
  EXPECT_TRUE(
      moved[0].position.isApprox(Eigen::Vector3f(8.f, 1.f, 3.f), 1e-6f));
  EXPECT_EQ(moved.intensities(), cloud.intensities());
  const TimedPointCloud timed = TransformTimedPointCloud(
      {{Eigen::Vector3f(1.f, 2.f, 3.f), -0.25f}}, kQuarterTurn);
  EXPECT_TRUE(
      timed[0].position.isApprox(Eigen::Vector3f(8.f, 1.f, 3.f), 1e-6f));
  EXPECT_EQ(timed[0].time, -0.25f);
}

TEST(PointCloudTest, CropKeepsTheBounds) {
  const PointCloud cloud({P(0, 0, -1), P(0, 0, 0), P(0, 0, 1), P(0, 0, 2)});
  const PointCloud cropped = CropPointCloud(cloud, 0.f, 1.f);
  ASSERT_EQ(cropped.size(), 2);
  EXPECT_EQ(cropped[0], P(0, 0, 0));
  EXPECT_EQ(cropped[1], P(0, 0, 1));
}

TEST(PointCloudDeathTest, IntensitiesMustFit) {
  EXPECT_DEATH(PointCloud({P(0, 0, 0)}, {1.f, 2.f}), "2 intensities for 1");
  PointCloud cloud({P(0, 0, 0)}, {1.f});
  EXPECT_DEATH(cloud.push_back(P(1, 1, 1)), "without intensity");
}

TEST(RangefinderPointTest, Protos) {
  EXPECT_EQ(FromProto(ToProto(P(1, 2, 3))), P(1, 2, 3));
  const TimedRangefinderPoint timed = ToTimedRangefinderPoint(P(1, 2, 3), 4.f);
  EXPECT_EQ(FromProto(ToProto(timed)), timed);
  EXPECT_EQ(ToRangefinderPoint(timed), P(1, 2, 3));
}

TEST(RangeDataTest, TransformCropAndProto) {
  const RangeData data{Eigen::Vector3f(1.f, 0.f, 0.f),
                       PointCloud({P(2, 0, 0), P(2, 0, 9)}),
                       PointCloud({P(3, 0, 9)})};
  const RangeData moved = TransformRangeData(data, kQuarterTurn);
  EXPECT_TRUE(moved.origin.isApprox(Eigen::Vector3f(10.f, 1.f, 0.f), 1e-6f));
  EXPECT_TRUE(moved.misses[0].position.isApprox(Eigen::Vector3f(10.f, 3.f, 9.f),
                                                1e-6f));
  const RangeData cropped = CropRangeData(data, -1.f, 1.f);
  EXPECT_EQ(cropped.returns.size(), 1);
  EXPECT_TRUE(cropped.misses.empty());
  const RangeData back = FromProto(ToProto(data));
  EXPECT_EQ(back.origin, data.origin);
  EXPECT_EQ(back.returns.points(), data.returns.points());
  EXPECT_EQ(back.misses.points(), data.misses.points());
}

TEST(RangeDataTest, ReadsTheOldForm) {
  proto::RangeData proto;
  *proto.add_returns_legacy() =
      transform::ToProto(Eigen::Vector3f(1.f, 2.f, 3.f));
  const RangeData data = FromProto(proto);
  ASSERT_EQ(data.returns.size(), 1);
  EXPECT_EQ(data.returns[0], P(1, 2, 3));
}

TEST(TimedPointCloudDataTest, Protos) {
  const TimedPointCloudData data{common::FromUniversal(50),
                                 Eigen::Vector3f(1.f, 2.f, 3.f),
                                 {{Eigen::Vector3f(4.f, 5.f, 6.f), -0.5f}},
                                 {7.f}};
  const TimedPointCloudData back = FromProto(ToProto(data));
  EXPECT_EQ(back.time, data.time);
  EXPECT_EQ(back.origin, data.origin);
  EXPECT_EQ(back.ranges, data.ranges);
  EXPECT_EQ(back.intensities, data.intensities);

  proto::TimedPointCloudData old;
  *old.add_point_data_legacy() =
      transform::ToProto(Eigen::Vector4f(1.f, 2.f, 3.f, -4.f));
  ASSERT_EQ(FromProto(old).ranges.size(), 1);
  EXPECT_EQ(FromProto(old).ranges[0].time, -4.f);
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
