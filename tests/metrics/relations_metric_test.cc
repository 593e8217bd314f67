// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/relations_metric.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr io::TimeNs kSecond = 1000000000;

// At 0 s in the origin, at 1 s two metres ahead and turned to the left, at
// 100 s back in the origin, but the estimate believes it to be at (0.6, 0.8).
Trajectory Estimate() {
  return Trajectory({{0, ToIsometry(Pose2(0., 0., 0.))},
                     {1 * kSecond, ToIsometry(Pose2(2., 0., kPi / 2.))},
                     {100 * kSecond, ToIsometry(Pose2(0.6, 0.8, 0.))}});
}

Relation MakeRelation(io::TimeNs time1, io::TimeNs time2, const Pose2& pose) {
  Relation relation;
  relation.time1 = time1;
  relation.time2 = time2;
  relation.relative = ToIsometry(pose);
  return relation;
}

TEST(RelationsMetricTest, ExactRelationsGiveNoError) {
  const auto metric = ComputeRelationsMetric(
      Estimate(), {MakeRelation(0, kSecond, Pose2(2., 0., kPi / 2.))},
      RelationsMetricOptions());
  ASSERT_TRUE(metric.ok());
  EXPECT_EQ(metric->all.count, 1);
  EXPECT_NEAR(metric->all.translation.mean, 0., 1e-12);
  EXPECT_NEAR(metric->all.rotation_degrees.mean, 0., 1e-9);
}

TEST(RelationsMetricTest, MultipliesByTheInverseOfTheExpectationOnTheRight) {
  // Expected (2, 0, 0): rotation is off by 90 degrees, and the error
  // (2, 0, 90) * (-2, 0, 0) = (2, -2, 90) has a translation of sqrt(8) although
  // the positions agree. The other order would give 0.
  const auto metric = ComputeRelationsMetric(
      Estimate(), {MakeRelation(0, kSecond, Pose2(2., 0., 0.))},
      RelationsMetricOptions());
  ASSERT_TRUE(metric.ok());
  EXPECT_NEAR(metric->all.translation.mean, std::sqrt(8.), 1e-12);
  EXPECT_NEAR(metric->all.rotation_degrees.mean, 90., 1e-9);
  EXPECT_NEAR(metric->all.squared_translation.mean, 8., 1e-12);
  EXPECT_NEAR(metric->all.squared_rotation_degrees.mean, 8100., 1e-6);
}

TEST(RelationsMetricTest, SplitsLoopsFromSequentialRelations) {
  const auto metric = ComputeRelationsMetric(
      Estimate(),
      {MakeRelation(0, kSecond, Pose2(1.9, 0., kPi / 2.)),
       MakeRelation(0, kSecond, Pose2(1.7, 0., kPi / 2.)),
       MakeRelation(0, 100 * kSecond, Pose2(0., 0., 0.)),
       MakeRelation(0, 60 * kSecond, Pose2(0., 0., 0.))},
      RelationsMetricOptions());
  ASSERT_TRUE(metric.ok());
  EXPECT_EQ(metric->all.count, 4);
  EXPECT_EQ(metric->loop.count, 1);
  EXPECT_EQ(metric->sequential.count, 3);
  EXPECT_NEAR(metric->loop.translation.mean, 1., 1e-12);
  EXPECT_EQ(metric->loop.fraction_above_half_metre, 1.);
  // 0.1 and 0.3 m, and the interpolated one exactly one minute apart.
  EXPECT_NEAR(metric->errors[0].translation, 0.1, 1e-12);
  EXPECT_NEAR(metric->errors[1].translation, 0.3, 1e-12);
  EXPECT_FALSE(metric->errors[3].is_loop);
  EXPECT_NEAR(metric->all.fraction_above_half_metre, 0.5, 1e-12);
}

TEST(RelationsMetricTest, MeanSampleDeviationAndMedian) {
  const auto metric = ComputeRelationsMetric(
      Estimate(),
      {MakeRelation(0, kSecond, Pose2(1.9, 0., kPi / 2.)),
       MakeRelation(0, kSecond, Pose2(1.8, 0., kPi / 2.)),
       MakeRelation(0, kSecond, Pose2(1.4, 0., kPi / 2.))},
      RelationsMetricOptions());
  ASSERT_TRUE(metric.ok());
  EXPECT_NEAR(metric->all.translation.mean, 0.3, 1e-12);
  EXPECT_NEAR(metric->all.translation.median, 0.2, 1e-12);
  // Deviations -0.2, -0.1, 0.3: squares sum to 0.14, divided by 2.
  EXPECT_NEAR(metric->all.translation.std, std::sqrt(0.07), 1e-12);
}

TEST(RelationsMetricTest, ToleranceTakesTheScanOtherwiseInterpolates) {
  const Relation relation =
      MakeRelation(0, kSecond - kSecond / 1000, Pose2(2., 0., kPi / 2.));
  RelationsMetricOptions options;
  const auto nearest = ComputeRelationsMetric(Estimate(), {relation}, options);
  ASSERT_TRUE(nearest.ok());
  EXPECT_NEAR(nearest->all.translation.mean, 0., 1e-12);
  options.stamp_tolerance = 0;
  const auto interpolated =
      ComputeRelationsMetric(Estimate(), {relation}, options);
  ASSERT_TRUE(interpolated.ok());
  EXPECT_GT(interpolated->all.translation.mean, 1e-3);
}

TEST(RelationsMetricTest, CountsWhatTheTrajectoryDoesNotCover) {
  const auto metric = ComputeRelationsMetric(
      Estimate(),
      {MakeRelation(0, kSecond, Pose2(2., 0., kPi / 2.)),
       MakeRelation(0, 101 * kSecond, Pose2(0., 0., 0.))},
      RelationsMetricOptions());
  ASSERT_TRUE(metric.ok());
  EXPECT_EQ(metric->all.count, 1);
  EXPECT_EQ(metric->num_not_covered, 1);
}

TEST(RelationsMetricTest, ErrorsSayWhatIsWrong) {
  const Relation relation = MakeRelation(0, kSecond, Pose2());
  const RelationsMetricOptions options;
  EXPECT_THAT(ComputeRelationsMetric(Trajectory(), {relation}, options)
                  .status()
                  .message(),
              testing::HasSubstr("trajectory is empty"));
  EXPECT_THAT(
      ComputeRelationsMetric(Estimate(), {}, options).status().message(),
      testing::HasSubstr("no relations"));
  EXPECT_THAT(
      ComputeRelationsMetric(
          Estimate(), {MakeRelation(500 * kSecond, 501 * kSecond, Pose2())},
          options)
          .status()
          .message(),
      testing::HasSubstr("none of the 1 relations"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
