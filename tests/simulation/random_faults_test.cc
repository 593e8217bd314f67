// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/random_faults.h"

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using ::testing::HasSubstr;
using Kind = OdometryFault::Kind;

// 100 m straight on, with a stop in the middle.
Drive Straight() {
  const auto world =
      ParseWorld("robot speed=0.5\nstart 0 0 0\ngoto 50 0\nwait 60\ngoto 100 0",
                 "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  auto drive = Drive::Plan(*world, 0);
  EXPECT_TRUE(drive.ok()) << drive.status();
  return *std::move(drive);
}

std::vector<OdometryFault> Draw(const std::string& description,
                                const uint64_t seed) {
  const auto faults = RandomFaults(description, Straight(), seed);
  EXPECT_TRUE(faults.ok()) << faults.status();
  return *faults;
}

TEST(RandomFaultsTest, ComeWhileTheRobotDrivesAndApart) {
  const Drive drive = Straight();
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<OdometryFault> faults =
        Draw("slip:3,stale:2,jump:2", seed);
    ASSERT_EQ(faults.size(), 7u);
    for (size_t i = 0; i != faults.size(); ++i) {
      EXPECT_GE(std::abs(drive.At(faults[i].start).speed), 0.15);
      EXPECT_GE(faults[i].start, 10.);
      EXPECT_LE(faults[i].start, drive.duration() - 10.);
      for (size_t k = 0; k != i; ++k) {
        EXPECT_GE(std::abs(faults[i].start - faults[k].start), 10.);
      }
      switch (faults[i].kind) {
        case Kind::kSlip:
          EXPECT_LT(i, 3u);
          EXPECT_GE(faults[i].duration, 1.);
          EXPECT_LE(faults[i].gain_left, 1.);
          break;
        case Kind::kStale:
          EXPECT_GE(faults[i].duration, 0.3);
          EXPECT_LE(faults[i].duration, 1.);
          break;
        default:
          EXPECT_EQ(faults[i].kind, Kind::kJump);
          EXPECT_GE(std::abs(faults[i].distance), 0.5);
          EXPECT_LE(std::abs(faults[i].angle), 20. * kPi / 180.);
      }
    }
  }
}

TEST(RandomStallsTest, ComeInMotionAndApart) {
  const Drive drive = Straight();
  const auto stalls = RandomStalls(8, drive, 3);
  ASSERT_TRUE(stalls.ok()) << stalls.status();
  ASSERT_EQ(stalls->size(), 8u);
  for (size_t i = 0; i != stalls->size(); ++i) {
    const ScanStall& stall = (*stalls)[i];
    EXPECT_GE(std::abs(drive.At(stall.start).speed), 0.15);
    EXPECT_GE(stall.duration, 0.4);
    EXPECT_LE(stall.duration, 1.);
    for (size_t k = 0; k != i; ++k) {
      EXPECT_GE(std::abs(stall.start - (*stalls)[k].start), 10.);
    }
  }
  EXPECT_FALSE(RandomStalls(-1, drive, 3).ok());
  EXPECT_FALSE(RandomStalls(1001, drive, 3).ok());
  EXPECT_FALSE(RandomStalls(99, drive, 3).ok());  // no room for so many
}

TEST(RandomFaultsTest, TheSeedDecides) {
  EXPECT_EQ(Draw("jump:2", 4)[1].start, Draw("jump:2", 4)[1].start);
  EXPECT_NE(Draw("jump:2", 4)[1].start, Draw("jump:2", 5)[1].start);
}

TEST(RandomFaultsTest, ReverseAndOffsetLast) {
  const std::vector<OdometryFault> faults = Draw("reverse,offset:-0.2", 1);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].kind, Kind::kReverse);
  EXPECT_EQ(faults[1].kind, Kind::kOffset);
  EXPECT_EQ(faults[1].seconds, -0.2);
  EXPECT_TRUE(Draw("", 1).empty());
}

TEST(RandomFaultsTest, MistakesAreNamed) {
  const Drive drive = Straight();
  const auto message = [&drive](const std::string& description) {
    const auto faults = RandomFaults(description, drive, 1);
    EXPECT_FALSE(faults.ok()) << description;
    return std::string(faults.status().message());
  };
  EXPECT_THAT(message("slide:2"), HasSubstr("'slide:2': expected slip:N"));
  EXPECT_THAT(message("slip:two"), HasSubstr("expected slip:N"));
  EXPECT_THAT(message("slip:1:2"), HasSubstr("expected slip:N"));
  EXPECT_THAT(message("slip:1.5"), HasSubstr("the count must be whole"));
  EXPECT_THAT(message("slip:-1"), HasSubstr("the count must be whole"));
  EXPECT_THAT(message("slip:1e9"), HasSubstr("the count must be whole"));
  EXPECT_THAT(message("offset:nan"), HasSubstr("offset:nan"));
  EXPECT_THAT(message("offset:11"), HasSubstr("seconds outside [-10, 10]"));
  EXPECT_THAT(message("jump:200"), HasSubstr("is too short for so many"));
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
