// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/range_data_collator.h"

#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

common::Time At(const double seconds) {
  return common::FromUniversal(100) + common::FromSeconds(seconds);
}

// Points at the given times before the stamp; x identifies them.
sensor::TimedPointCloudData Scan(const double seconds,
                                 const std::vector<float>& times,
                                 const float first_x = 0.f) {
  sensor::TimedPointCloudData data{
      At(seconds), Eigen::Vector3f(first_x, 0.f, 0.f), {}, {}};
  for (const float time : times) {
    data.ranges.push_back(
        {Eigen::Vector3f(first_x + data.ranges.size(), 0.f, 0.f), time});
  }
  return data;
}

std::vector<float> Xs(const sensor::TimedPointCloudOriginData& sweep) {
  std::vector<float> result;
  for (const auto& range : sweep.ranges) {
    result.push_back(range.point_time.position.x());
  }
  return result;
}

TEST(RangeDataCollatorTest, OneSensorPassesThrough) {
  RangeDataCollator collator({"laser"});
  const auto sweep =
      collator.AddRangeData("laser", Scan(10., {-0.2f, -0.1f, 0.f}));
  EXPECT_EQ(sweep.time, At(10.));
  ASSERT_EQ(sweep.ranges.size(), 3);
  EXPECT_EQ(sweep.ranges[0].point_time.time, -0.2f);
  EXPECT_EQ(sweep.ranges[2].point_time.time, 0.f);
  EXPECT_EQ(sweep.ranges[2].intensity, 0.f);
  EXPECT_EQ(sweep.origins.size(), 1);
}

TEST(RangeDataCollatorTest, OverlappingScansOfOneSensor) {
  RangeDataCollator collator({"laser"});
  collator.AddRangeData("laser", Scan(10., {0.f}));
  // The first point belongs to the time of the scan before.
  const auto sweep = collator.AddRangeData("laser", Scan(10.5, {-1.f, 0.f}));
  EXPECT_EQ(Xs(sweep), (std::vector<float>{1.f}));
}

TEST(RangeDataCollatorTest, TwoSensorsAreMergedInOrderOfTime) {
  RangeDataCollator collator({"a", "b"});
  EXPECT_TRUE(collator.AddRangeData("a", Scan(10., {-0.4f, -0.2f, 0.f}))
                  .ranges.empty());
  const auto first =
      collator.AddRangeData("b", Scan(9.9, {-0.4f, -0.2f, 0.f}, 100.f));
  // Up to 9.9, the newest time that both have reached.
  EXPECT_EQ(first.time, At(9.9));
  EXPECT_EQ(Xs(first), (std::vector<float>{100.f, 0.f, 101.f, 1.f, 102.f}));
  EXPECT_EQ(first.origins.size(), 2);
  EXPECT_EQ(first.origins[first.ranges[0].origin_index].x(), 100.f);
  EXPECT_NEAR(first.ranges[1].point_time.time, -0.3f, 1e-6);
  // What was left of sensor a comes with the next sweep.
  const auto second = collator.AddRangeData("b", Scan(10.4, {0.f}, 200.f));
  EXPECT_EQ(second.time, At(10.));
  EXPECT_EQ(Xs(second), (std::vector<float>{2.f}));
}

TEST(RangeDataCollatorTest, ASilentSensorDoesNotHoldUpOthers) {
  RangeDataCollator collator({"a", "b"});
  EXPECT_TRUE(collator.AddRangeData("a", Scan(1., {0.f})).ranges.empty());
  const auto sweep = collator.AddRangeData("a", Scan(2., {0.f}, 50.f));
  EXPECT_EQ(sweep.time, At(1.));
  EXPECT_EQ(Xs(sweep), (std::vector<float>{0.f}));
  const auto late = collator.AddRangeData("b", Scan(0.5, {0.f}, 100.f));
  // It ends at 0.5, so nothing of it is later than the last sweep.
  EXPECT_TRUE(late.ranges.empty());
}

TEST(RangeDataCollatorTest, KeepsIntensities) {
  RangeDataCollator collator({"laser"});
  auto scan = Scan(1., {-0.1f, 0.f});
  scan.intensities = {7.f, 8.f};
  const auto sweep = collator.AddRangeData("laser", scan);
  EXPECT_EQ(sweep.ranges[0].intensity, 7.f);
  EXPECT_EQ(sweep.ranges[1].intensity, 8.f);
}

TEST(RangeDataCollatorDeathTest, UnknownSensor) {
  RangeDataCollator collator({"laser"});
  EXPECT_DEATH(collator.AddRangeData("sonar", Scan(1., {0.f})), "sonar");
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
