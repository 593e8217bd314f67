// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/localization_metrics.h"

#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// A robot that drives along x, 0.1 m in each of `count` scans a tenth of a
// second apart, and knows it exactly.
std::vector<PosePair> Drive(const int count) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < count; ++i) {
    const Pose2 pose(0.1 * i, 0., 0.);
    pairs.push_back({io::FromSeconds(1000. + 0.1 * i), pose, pose});
  }
  return pairs;
}

// Moves the estimates [first, last).
void Shift(const int first, const int last, const Pose2& by,
           std::vector<PosePair>* const pairs) {
  for (int i = first; i < last; ++i) {
    Pose2& estimate = (*pairs)[i].estimate;
    estimate = Pose2(estimate.x + by.x, estimate.y + by.y,
                     NormalizeAngle(estimate.theta + by.theta));
  }
}

LocalizationMetrics Judge(const std::vector<PosePair>& pairs) {
  const auto metrics = ComputeLocalizationMetrics(pairs, LocalizationOptions());
  EXPECT_TRUE(metrics.ok()) << metrics.status();
  return *metrics;
}

TEST(LocalizationMetricsTest, APerfectRun) {
  auto pairs = Drive(300);
  Shift(0, 300, Pose2(0.1, 0., DegToRad(2.)), &pairs);
  const LocalizationMetrics metrics = Judge(pairs);
  EXPECT_EQ(metrics.num_scans, 300);
  ASSERT_EQ(metrics.segments.size(), 1u);
  EXPECT_EQ(metrics.num_localized(), 1);
  EXPECT_EQ(metrics.num_jumps(), 0);
  EXPECT_EQ(metrics.num_wrong_jumps(), 0);
  const LocalizationSegment& segment = metrics.segments[0];
  EXPECT_EQ(segment.begin, io::FromSeconds(1000.));
  EXPECT_EQ(segment.end, pairs.back().time);
  EXPECT_EQ(segment.seconds, 0.);
  EXPECT_EQ(segment.metres, 0.);
  EXPECT_EQ(segment.translation_error.count, 300);
  EXPECT_NEAR(segment.translation_error.rmse, 0.1, 1e-9);
  EXPECT_NEAR(segment.rotation_error_degrees.max, 2., 1e-9);
  EXPECT_NEAR(segment.fraction_within, 1., 1e-12);
}

TEST(LocalizationMetricsTest, FindsItsPlaceOnce) {
  auto pairs = Drive(300);
  Shift(0, 120, Pose2(20., -5., 1.), &pairs);
  const LocalizationMetrics metrics = Judge(pairs);
  const LocalizationSegment& segment = metrics.segments[0];
  EXPECT_TRUE(segment.localized);
  EXPECT_NEAR(segment.seconds, 12., 1e-6);
  EXPECT_NEAR(segment.metres, 12., 1e-9);
  // The one jump went to the right place.
  EXPECT_EQ(segment.jumps, 0);
  EXPECT_EQ(segment.wrong_jumps, 0);
  EXPECT_EQ(segment.translation_error.count, 180);
  EXPECT_NEAR(segment.translation_error.max, 0., 1e-9);
}

TEST(LocalizationMetricsTest, AnExcursionIsTwoJumpsAndOneWrongPlace) {
  auto pairs = Drive(400);
  Shift(200, 230, Pose2(0., 2.4, 0.), &pairs);
  const LocalizationMetrics metrics = Judge(pairs);
  EXPECT_EQ(metrics.num_localized(), 1);
  EXPECT_EQ(metrics.num_jumps(), 2);
  EXPECT_EQ(metrics.num_wrong_jumps(), 1);
  EXPECT_NEAR(metrics.segments[0].fraction_within, 370. / 400., 1e-12);
}

TEST(LocalizationMetricsTest, AShortVisitDoesNotCount) {
  // Right for 5 s by chance, wrong again, right from 20 s on.
  auto pairs = Drive(400);
  Shift(0, 50, Pose2(3., 0., 0.), &pairs);
  Shift(100, 200, Pose2(3., 0., 0.), &pairs);
  const LocalizationMetrics metrics = Judge(pairs);
  EXPECT_TRUE(metrics.segments[0].localized);
  EXPECT_NEAR(metrics.segments[0].seconds, 20., 1e-6);
  EXPECT_EQ(metrics.num_jumps(), 0);
  EXPECT_EQ(metrics.num_wrong_jumps(), 1);

  // To the end of the segment is enough.
  auto late = Drive(100);
  Shift(0, 95, Pose2(3., 0., 0.), &late);
  EXPECT_EQ(Judge(late).num_localized(), 1);
}

TEST(LocalizationMetricsTest, DriftIsNoJump) {
  auto pairs = Drive(400);
  for (int i = 0; i < 400; ++i) pairs[i].estimate.y += 0.005 * i;
  const LocalizationMetrics metrics = Judge(pairs);
  EXPECT_EQ(metrics.num_localized(), 0);
  EXPECT_EQ(metrics.num_jumps(), 0);
  EXPECT_EQ(metrics.num_wrong_jumps(), 0);
  EXPECT_EQ(metrics.segments[0].translation_error.count, 0);
}

TEST(LocalizationMetricsTest, AWrongHeadingIsAWrongPlace) {
  auto pairs = Drive(300);
  Shift(0, 100, Pose2(1., 0., 0.), &pairs);
  Shift(100, 300, Pose2(0., 0., DegToRad(180.)), &pairs);
  const LocalizationMetrics metrics = Judge(pairs);
  EXPECT_EQ(metrics.num_localized(), 0);
  EXPECT_EQ(metrics.num_wrong_jumps(), 1);
}

TEST(LocalizationMetricsTest, CarriedRobotsBeginAnew) {
  auto pairs = Drive(400);
  for (int i = 200; i < 400; ++i) {
    pairs[i].reference.y += 30.;
    pairs[i].estimate.y += i < 260 ? 0. : 30.;
  }
  const LocalizationMetrics metrics = Judge(pairs);
  ASSERT_EQ(metrics.segments.size(), 2u);
  EXPECT_EQ(metrics.segments[0].end, pairs[199].time);
  EXPECT_EQ(metrics.segments[1].begin, pairs[200].time);
  EXPECT_EQ(metrics.segments[0].seconds, 0.);
  EXPECT_NEAR(metrics.segments[1].seconds, 6., 1e-6);
  EXPECT_EQ(metrics.num_localized(), 2);
  // Being carried is no jump of the estimate.
  EXPECT_EQ(metrics.num_jumps(), 0);
  EXPECT_EQ(metrics.num_wrong_jumps(), 0);
}

TEST(LocalizationMetricsTest, LocalSlamMaySettle) {
  auto pairs = Drive(300);
  Shift(0, 100, Pose2(20., 0., 0.), &pairs);
  // Half a second after the start, and again after two.
  Shift(5, 100, Pose2(0., 0.8, 0.), &pairs);
  EXPECT_EQ(Judge(pairs).num_wrong_jumps(), 0);
  Shift(20, 100, Pose2(0., 0.8, 0.), &pairs);
  EXPECT_EQ(Judge(pairs).num_wrong_jumps(), 1);
}

TEST(LocalizationMetricsTest, TwoPosesAreTheLeast) {
  EXPECT_FALSE(
      ComputeLocalizationMetrics(Drive(1), LocalizationOptions()).ok());
  EXPECT_TRUE(ComputeLocalizationMetrics(Drive(2), LocalizationOptions()).ok());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
