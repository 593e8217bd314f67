// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/beam_times.h"

#include <cmath>
#include <limits>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kPeriod = 0.1;  // seconds
constexpr double kTurn = 0.1;    // radians
// Of which all turn in a period, and the rounding of them.
constexpr double kHalfABeam = 0.51 / 360. * kPeriod;

Eigen::Vector2f At(const double bearing) {
  return Eigen::Vector2f(3.f * std::cos(bearing), 3.f * std::sin(bearing));
}

// Returns of one scan from `first` to `last`, a degree apart.
std::vector<Eigen::Vector2f> Scan(const double first, const double last) {
  std::vector<Eigen::Vector2f> returns;
  const int count = std::round((last - first) * 180. / kPi);
  for (int i = 0; i < count; ++i) {
    returns.push_back(At(first + i * kPi / 180.));
  }
  return returns;
}

BeamTimes AfterScans(const double first, const double last) {
  BeamTimes times;
  for (int i = 0; i < 30; ++i) times.AddScan(Scan(first, last), kPeriod);
  return times;
}

TEST(BeamTimesTest, TimesGrowWithTheBearingFromTheSeamOn) {
  for (const double seam : {-kPi, 0., 0.5 * kPi}) {
    const BeamTimes times = AfterScans(seam, seam + 2. * kPi);
    const std::vector<Eigen::Vector2f> returns = {
        At(seam + 1.99 * kPi), At(seam + 0.01 * kPi), At(seam + kPi)};
    const auto turning = times.Times(BeamOrder::kCounterclockwise, returns);
    EXPECT_NEAR(turning[0], 0.495 * kPeriod, kHalfABeam);
    EXPECT_NEAR(turning[1], -0.495 * kPeriod, kHalfABeam);
    EXPECT_NEAR(turning[2], 0., kHalfABeam);
    const auto other = times.Times(BeamOrder::kClockwise, returns);
    for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(other[i], -turning[i]);
    for (const float time : times.Times(BeamOrder::kAtOnce, returns)) {
      EXPECT_EQ(time, 0.f);
    }
  }
}

TEST(BeamTimesTest, FindsTheSeamWhereScansBeginLate) {
  BeamTimes times;
  for (int i = 0; i < 30; ++i) {
    times.AddScan(Scan(i % 2 == 0 ? 0. : 1.2 * kPi, 2. * kPi), kPeriod);
  }
  const auto found =
      times.Times(BeamOrder::kCounterclockwise, {At(1.9 * kPi), At(0.1 * kPi)});
  EXPECT_NEAR(found[0], 0.45 * kPeriod, kHalfABeam);
  EXPECT_NEAR(found[1], -0.45 * kPeriod, kHalfABeam);
}

TEST(BeamTimesTest, ANarrowLaserTakesItsShareOfTheTurn) {
  const BeamTimes times = AfterScans(-kPi / 2., kPi / 2.);
  const auto found =
      times.Times(BeamOrder::kCounterclockwise, {At(-kPi / 2.), At(kPi / 2.)});
  EXPECT_NEAR(found[1] - found[0], 0.5 * kPeriod, 1e-3 * kPeriod);
  // What it distorts, too.
  EXPECT_TRUE(times.Candidates(0.08).empty());
  EXPECT_EQ(AfterScans(-kPi, kPi).Candidates(0.08).size(), 2u);
}

TEST(BeamTimesTest, AsksOnlyWhereItCanBeSeen) {
  const BeamTimes times = AfterScans(-kPi, kPi);
  EXPECT_TRUE(times.Candidates(0.).empty());
  EXPECT_EQ(times.Candidates(kTurn),
            (std::vector<BeamOrder>{BeamOrder::kCounterclockwise,
                                    BeamOrder::kClockwise}));
  EXPECT_EQ(times.Candidates(-kTurn).size(), 2u);
  // The period is not known.
  BeamTimes young;
  young.AddScan(Scan(-kPi, kPi), kPeriod);
  EXPECT_TRUE(young.Candidates(kTurn).empty());
}

TEST(BeamTimesTest, TakesWhatIsSignificantlyBetter) {
  BeamTimes times = AfterScans(-kPi, kPi);
  // A single scan is not, however much it says, nor is noise.
  times.AddEvidence(BeamOrder::kClockwise, 1000.);
  EXPECT_EQ(times.order(), BeamOrder::kAtOnce);
  times.AddEvidence(BeamOrder::kClockwise, -1000.);
  times.AddEvidence(BeamOrder::kClockwise,
                    std::numeric_limits<double>::quiet_NaN());
  int count = 0;
  while (times.order() == BeamOrder::kAtOnce && count < 100) {
    times.AddEvidence(BeamOrder::kCounterclockwise, 5.);
    ++count;
  }
  EXPECT_EQ(times.order(), BeamOrder::kCounterclockwise);
  EXPECT_EQ(count, 11);
  EXPECT_EQ(
      times.Candidates(kTurn),
      (std::vector<BeamOrder>{BeamOrder::kAtOnce, BeamOrder::kClockwise}));
}

TEST(BeamTimesTest, DoesNotAskAgainWhatIsRefuted) {
  BeamTimes times = AfterScans(-kPi, kPi);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(times.Candidates(kTurn).size(), 2u);
    times.AddEvidence(BeamOrder::kClockwise, -5.);
  }
  times.AddEvidence(BeamOrder::kClockwise, -5.);
  EXPECT_EQ(times.Candidates(kTurn),
            std::vector<BeamOrder>{BeamOrder::kCounterclockwise});
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
