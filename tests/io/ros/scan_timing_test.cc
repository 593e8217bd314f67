// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_ext/io/ros/scan_timing.h"

#include "cartographer_ext/common/pose2.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ScanTiming Scans(const int n, const double period, const double sweep,
                 const double field_of_view) {
  ScanTiming timing;
  for (int i = 0; i < n; ++i)
    timing.Add("/scan", "laser", FromSeconds(1. + period * i), sweep,
               field_of_view);
  timing.Judge();
  return timing;
}

TEST(ScanTimingTest, ASweepOfAWholePeriodIsPossible) {
  const ScanTiming timing = Scans(20, 0.1, 0.1, 2. * kPi);
  EXPECT_FALSE(timing.IsImpossible("/scan", "laser"));
  EXPECT_THAT(timing.Warnings(), IsEmpty());
}

TEST(ScanTimingTest, ALongerOneIsNot) {
  const ScanTiming timing = Scans(20, 0.1, 0.12, 2. * kPi);
  EXPECT_TRUE(timing.IsImpossible("/scan", "laser"));
  EXPECT_FALSE(timing.IsImpossible("/scan", "other"));
  EXPECT_TRUE(timing.AnyImpossible());
  EXPECT_THAT(timing.Warnings(),
              ElementsAre(HasSubstr(
                  "make a scan take 0.12 s, but one comes every 0.1 s")));
}

TEST(ScanTimingTest, NothingIsJudgedByAFewScans) {
  EXPECT_FALSE(Scans(5, 0.1, 1., 2. * kPi).AnyImpossible());
}

TEST(ScanTimingTest, TwoSensorsOnOneTopicDoNotHaste) {
  ScanTiming timing;
  for (int i = 0; i < 40; ++i) {
    timing.Add("/scan", i % 2 == 0 ? "front" : "rear",
               FromSeconds(1. + 0.05 * i), 0.09, kPi);
  }
  timing.Judge();
  EXPECT_FALSE(timing.AnyImpossible());
}

TEST(ScanTimingTest, RepeatedStampsDoNotCount) {
  ScanTiming timing;
  for (int i = 0; i < 40; ++i)
    timing.Add("/scan", "laser", FromSeconds(1. + 0.1 * (i / 2)), 0.1, kPi);
  timing.Judge();
  EXPECT_FALSE(timing.AnyImpossible());
}

TEST(ScanTimingTest, MissingTimesAreSaidOfSlowAllRoundLasersOnly) {
  EXPECT_THAT(Scans(20, 0.18, 0., 2. * kPi).Warnings(),
              ElementsAre(HasSubstr("beams are up to 0.18 s old")));
  EXPECT_THAT(Scans(20, 0.025, 0., 2. * kPi).Warnings(), IsEmpty());
  EXPECT_THAT(Scans(20, 0.18, 0., kPi / 3.).Warnings(), IsEmpty());
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
