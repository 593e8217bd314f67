// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/scan_stamps.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr TimeNs kSecond = 1000000000;
constexpr TimeNs kHour = 3600 * kSecond;

std::vector<LineKey> Lines(const std::vector<TimeNs>& seconds,
                           const CarmenKind kind = CarmenKind::kFrontLaser) {
  std::vector<LineKey> lines;
  for (const TimeNs second : seconds) {
    LineKey line;
    line.time = second * kSecond;
    line.kind = kind;
    lines.push_back(line);
  }
  return lines;
}

TEST(ScanStampsTest, LostIfMostRepeatTheOneBefore) {
  EXPECT_TRUE(
      AreStampsLost(Lines({7, 7, 7, 7, 8, 8}), CarmenKind::kFrontLaser));
  // Three of six are not most, and four lines are too few to tell.
  EXPECT_FALSE(
      AreStampsLost(Lines({7, 7, 8, 8, 9, 9}), CarmenKind::kFrontLaser));
  EXPECT_FALSE(AreStampsLost(Lines({7, 7, 7, 7}), CarmenKind::kFrontLaser));
  EXPECT_FALSE(AreStampsLost(Lines({7, 7, 7, 7, 7, 7}), CarmenKind::kOdometry));
}

TEST(ScanStampsTest, StepsBackAreCountedByKind) {
  std::vector<LineKey> lines = Lines({5, 3, 4, 1, 9});
  const std::vector<LineKey> odometry = Lines({2, 8}, CarmenKind::kOdometry);
  lines.insert(lines.begin() + 2, odometry.begin(), odometry.end());
  EXPECT_EQ(CountBackwards(lines, CarmenKind::kFrontLaser), 2);
  EXPECT_EQ(LargestStepBack(lines, CarmenKind::kFrontLaser), 3 * kSecond);
  EXPECT_EQ(CountBackwards(lines, CarmenKind::kOdometry), 0);
  EXPECT_EQ(LargestStepBack(lines, CarmenKind::kOdometry), 0);
  lines[5].plausible = false;  // the one at 1 s: what follows is not late
  EXPECT_EQ(CountBackwards(lines, CarmenKind::kFrontLaser), 1);
  EXPECT_EQ(LargestStepBack(lines, CarmenKind::kFrontLaser), 2 * kSecond);
}

TEST(ScanStampsTest, FewLinesAnHourAwayFromAllOthersAreImplausible) {
  std::vector<LineKey> lines;
  for (int i = 0; i < 300; ++i) {
    LineKey line;
    line.time = 100 * kHour + i * kSecond;
    line.kind = CarmenKind::kFrontLaser;
    lines.push_back(line);
  }
  EXPECT_EQ(MarkImplausible(&lines).count, 0);
  lines[200].time = 0;
  lines[120].time = 300 * kHour;
  const ImplausibleLines found = MarkImplausible(&lines);
  EXPECT_EQ(found.count, 2);
  EXPECT_EQ(found.first, 120u);
  EXPECT_FALSE(lines[120].plausible);
  EXPECT_FALSE(lines[200].plausible);
  EXPECT_TRUE(lines[121].plausible);
  // Those that are marked already are not counted again.
  EXPECT_EQ(MarkImplausible(&lines).count, 0);
}

TEST(ScanStampsTest, APauseIsNoMistake) {
  std::vector<LineKey> lines = Lines({});
  for (int i = 0; i < 300; ++i) {
    LineKey line;
    line.time = (i < 4 ? 0 : 5 * kHour) + i * kSecond;
    line.kind = CarmenKind::kOdometry;
    lines.push_back(line);
  }
  // Four of 300 are more than one in a hundred.
  EXPECT_EQ(MarkImplausible(&lines).count, 0);
  // Clocks of different kinds are not compared.
  LineKey scan;
  scan.time = 900 * kHour;
  scan.kind = CarmenKind::kFrontLaser;
  lines.push_back(scan);
  EXPECT_EQ(MarkImplausible(&lines).count, 0);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
