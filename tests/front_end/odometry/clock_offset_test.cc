// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/clock_offset.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kOffset = 0.06;  // scan minus sensor stamp, seconds

double Heading(const double time) { return 0.5 * std::sin(time); }

// Turns to and fro for half a minute with scans every 0.1 s, matched when the
// sensor has got to `lead` seconds beyond the stamp.
double Learnt(const double lead) {
  OdometryBuffer buffer(60., 10000, 0.1);
  ClockOffset offset((TimeOffsetOptions()));
  double fed = -1.;
  for (int scan = 1; scan < 300; ++scan) {
    const double time = 0.1 * scan;
    for (; fed <= time + lead; fed += 0.01) {
      buffer.Add(fed, Pose2(0., 0., Heading(fed + kOffset)));
    }
    offset.AddMatch(time - 0.1, time, Heading(time) - Heading(time - 0.1),
                    buffer);
  }
  return offset.offset();
}

TEST(ClockOffsetTest, Learns) { EXPECT_NEAR(Learnt(0.5), kOffset, 0.005); }

TEST(ClockOffsetTest, TurnsWaitForTheReadingsOfAllCandidates) {
  EXPECT_NEAR(Learnt(0.), kOffset, 0.005);
}

TEST(ClockOffsetTest, GapsAndEmptyBuffersTeachNothing) {
  OdometryBuffer buffer(60., 10000, 0.1);
  ClockOffset offset((TimeOffsetOptions()));
  for (int i = 1; i < 100; ++i) {
    offset.AddMatch(0.1 * (i - 1), 0.1 * i, 0.05, buffer);
  }
  EXPECT_EQ(offset.offset(), 0.);
  for (int i = 0; i < 3000; ++i) {
    buffer.Add(0.01 * i, Pose2(0., 0., Heading(0.01 * i + kOffset)));
  }
  ClockOffset gaps((TimeOffsetOptions()));
  for (int i = 1; i < 15; ++i) {
    const double from = 2. * i - 1.5, to = 2. * i;
    gaps.AddMatch(from, to, Heading(to) - Heading(from), buffer);
  }
  EXPECT_EQ(gaps.offset(), 0.);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
