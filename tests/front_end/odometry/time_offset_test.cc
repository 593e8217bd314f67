// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/time_offset.h"

#include <cmath>
#include <cstdint>
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

TEST(TimeOffsetTest, FindsOffsetsFromNothingToSevenTenthsOfASecond) {
  for (const double offset : {-0.05, 0., 0.043, 0.08, 0.12, 0.2, 0.45, 0.7}) {
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

// Of ten scans eight speak for the last candidate against the first and two against
// it, all by the same: (8 - 2) / sqrt(10) = 1.897 standard deviations.
TEST(TimeOffsetTest, TheSignificanceIsThatOfTheDifferencesOfTheSquares) {
  for (const double significance : {1.89, 1.90}) {
    TimeOffsetOptions options;
    options.minimum = 0.;
    options.maximum = 0.02;
    options.forgetting = 1.;
    options.min_weight = 10.;
    options.significance = significance;
    TimeOffsetEstimator estimator(options);
    for (int i = 0; i < 20; ++i) estimator.Add(0., {0., 0., 0.});
    for (int i = 0; i < 2; ++i) estimator.Add(0., {0., 0.02, 0.03});
    for (int i = 0; i < 8; ++i) estimator.Add(0., {0.03, 0.02, 0.});
    EXPECT_EQ(estimator.weight(), 10.);
    EXPECT_NEAR(estimator.offset(), significance < 1.895 ? 0.02 : 0., 1e-12);
  }
}

// A gyroscope or the wheels with white noise of `noise` rad in 10 ms, read every 10
// ms. Between the stops of one second the robot turns for another one at 0.6 rad/s,
// or drives straight on.
class NoisyHeading {
 public:
  NoisyHeading(const uint32_t seed, const double noise, const bool turns)
      : turns_(turns) {
    Random random(seed);
    double error = 0.;
    for (int i = 0; i < kReadings; ++i) {
      errors_.push_back(error);
      error += random.Normal(0., noise);
    }
  }

  double True(const double time) const {
    if (!turns_) return 0.;
    const double seconds = std::floor(time);
    const double passed = std::floor(0.5 * seconds) +
                          (std::fmod(seconds, 2.) < 1. ? time - seconds : 1.);
    return 0.6 * passed;
  }
  double Read(const double time) const {
    return True(time) + errors_.at(std::lround(100. * (time + 1.)));
  }

  void Feed(const double offset, const double noise, const uint32_t seed,
            const int scans, TimeOffsetEstimator* const estimator) const {
    Random random(seed);
    for (int i = 1; i <= scans; ++i) {
      const double from = 0.1 * (i - 1), to = 0.1 * i;
      std::vector<double> turns;
      for (const double candidate : estimator->candidates()) {
        turns.push_back(Read(to - candidate) - Read(from - candidate));
      }
      estimator->Add(
          True(to - offset) - True(from - offset) + random.Normal(0., noise),
          turns);
    }
  }

 private:
  static constexpr int kReadings = 40000;
  const bool turns_;
  std::vector<double> errors_;
};

TEST(TimeOffsetTest, NoiseOfTheHeadingIsNotTakenForATurn) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    for (const double noise : {0.0005, 0.0015, 0.003}) {
      TimeOffsetEstimator estimator((TimeOffsetOptions()));
      NoisyHeading(seed, noise, false).Feed(0., 0.001, seed, 3000, &estimator);
      EXPECT_EQ(estimator.offset(), 0.) << seed << " " << noise;
    }
  }
}

TEST(TimeOffsetTest, FewTurnsAreEnoughInSpiteOfIt) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    TimeOffsetEstimator estimator((TimeOffsetOptions()));
    NoisyHeading(seed, 0.0015, true).Feed(0.12, 0.001, seed, 300, &estimator);
    EXPECT_NEAR(estimator.offset(), 0.12, 0.02) << seed;
  }
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
