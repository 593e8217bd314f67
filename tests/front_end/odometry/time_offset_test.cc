// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/time_offset.h"

#include <cmath>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A robot that swings left and right; heading at time t.
double Heading(const double t) { return 0.5 * std::sin(1.7 * t); }

// Feeds `scans` scans every 0.1 s whose clock is `offset` behind odometry's,
// with noise on the matched turn.
void Feed(const double offset, const double noise, const int scans,
          TimeOffsetEstimator* const estimator) {
  Random random(7);
  for (int i = 1; i <= scans; ++i) {
    const double from = 0.1 * (i - 1), to = 0.1 * i;
    std::vector<double> turns;
    for (const double candidate : estimator->candidates()) {
      turns.push_back(Heading(to - candidate) - Heading(from - candidate));
    }
    const double turn = Heading(to - offset) - Heading(from - offset);
    estimator->Add(turn + random.Normal(0., noise), turns);
  }
}

TEST(TimeOffsetTest, FindsOffsetsFromNothingToAFifthOfASecond) {
  for (const double offset : {-0.05, 0., 0.043, 0.08, 0.12, 0.2}) {
    TimeOffsetEstimator estimator((TimeOffsetOptions()));
    Feed(offset, 0.002, 2000, &estimator);
    EXPECT_NEAR(estimator.offset(), offset, 0.01) << offset;
  }
}

TEST(TimeOffsetTest, KeepsTheInitialValueUntilThereIsEvidence) {
  TimeOffsetOptions options;
  options.initial = 0.03;
  TimeOffsetEstimator estimator(options);
  EXPECT_EQ(estimator.offset(), 0.03);
  Feed(0.2, 0., 20, &estimator);
  EXPECT_EQ(estimator.offset(), 0.03);
}

TEST(TimeOffsetTest, DrivingStraightSaysNothing) {
  TimeOffsetEstimator estimator((TimeOffsetOptions()));
  const std::vector<double> none(estimator.candidates().size(), 0.);
  for (int i = 0; i < 1000; ++i) estimator.Add(0.001, none);
  EXPECT_EQ(estimator.weight(), 0.);
  EXPECT_EQ(estimator.offset(), 0.);
}

TEST(TimeOffsetTest, FailedMatchesDoNotDecide) {
  TimeOffsetEstimator estimator((TimeOffsetOptions()));
  Random random(3);
  for (int i = 1; i <= 2000; ++i) {
    const double from = 0.1 * (i - 1), to = 0.1 * i;
    std::vector<double> turns;
    for (const double candidate : estimator.candidates()) {
      turns.push_back(Heading(to - candidate) - Heading(from - candidate));
    }
    double turn = Heading(to - 0.1) - Heading(from - 0.1);
    if (i % 10 == 0) turn += 1.;
    estimator.Add(turn + random.Normal(0., 0.002), turns);
  }
  EXPECT_NEAR(estimator.offset(), 0.1, 0.01);
}

TEST(TimeOffsetTest, FollowsAClockThatChanges) {
  TimeOffsetOptions options;
  options.forgetting = 0.99;
  TimeOffsetEstimator estimator(options);
  Feed(0.15, 0.002, 1000, &estimator);
  EXPECT_NEAR(estimator.offset(), 0.15, 0.01);
  Feed(0.02, 0.002, 2000, &estimator);
  EXPECT_NEAR(estimator.offset(), 0.02, 0.01);
}

TEST(TimeOffsetTest, SwitchedOffItStaysAtItsInitialValue) {
  TimeOffsetOptions options;
  options.estimate = false;
  options.initial = 0.07;
  TimeOffsetEstimator estimator(options);
  EXPECT_TRUE(estimator.candidates().empty());
  estimator.Add(1., {});
  EXPECT_EQ(estimator.offset(), 0.07);
}

TEST(TimeOffsetTest, WrongNumbersOfTurnsAreIgnored) {
  TimeOffsetEstimator estimator((TimeOffsetOptions()));
  estimator.Add(0.1, {0.1, 0.2});
  EXPECT_EQ(estimator.weight(), 0.);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
