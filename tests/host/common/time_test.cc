// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/time.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

TEST(TimeTest, TicksAreTenthsOfMicroseconds) {
  EXPECT_EQ(FromSeconds(1.).count(), 10000000);
  EXPECT_EQ(FromSeconds(1.99e-7).count(), 1);
  EXPECT_EQ(FromSeconds(-1.99e-7).count(), -1);
  EXPECT_EQ(FromMilliseconds(3).count(), 30000);
  EXPECT_DOUBLE_EQ(ToSeconds(Duration(15000000)), 1.5);
  EXPECT_DOUBLE_EQ(
      ToSeconds(std::chrono::steady_clock::duration(std::chrono::seconds(2))),
      2.);
}

TEST(TimeTest, ConversionSaturates) {
  EXPECT_EQ(FromSeconds(1e30), Duration::max());
  EXPECT_EQ(FromSeconds(-std::numeric_limits<double>::infinity()),
            Duration::min());
  EXPECT_EQ(FromSeconds(std::nan("")), Duration::zero());
}

TEST(TimeTest, Epoch) {
  // 2016-01-01 00:00:00 UTC is 1451606400 s after the Unix epoch.
  const int64 ticks =
      (1451606400ll + kUtsEpochOffsetFromUnixEpochInSeconds) * 10000000ll;
  EXPECT_EQ(ticks, 635872032000000000ll);
  EXPECT_EQ(ToUniversal(FromUniversal(ticks)), ticks);
  std::ostringstream text;
  text << FromUniversal(ticks);
  EXPECT_EQ(text.str(), "635872032000000000");
}

TEST(TimeTest, ThreadCpuTimeGrows) {
  const double before = GetThreadCpuTimeSeconds();
  volatile double sum = 0.;
  for (int i = 0; i != 1000000; ++i) sum = sum + i;
  EXPECT_GT(GetThreadCpuTimeSeconds(), before);
}

}  // namespace
}  // namespace common
}  // namespace cartographer
