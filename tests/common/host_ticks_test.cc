// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/host_ticks.h"

#include <cstdint>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(HostTicksTest, ConvertsToUnixSecondsWithoutRounding) {
  EXPECT_EQ(UnixSecondsOfTicks(INT64_C(621355968000000000)), "0.0000000");
  // 2020-09-13 12:26:40.25 UTC.
  EXPECT_EQ(UnixSecondsOfTicks(INT64_C(637355968002500000)),
            "1600000000.2500000");
  EXPECT_EQ(UnixSecondsOfTicks(INT64_C(637355968000000001)),
            "1600000000.0000001");
}

TEST(HostTicksTest, ThoseNear1And1970) {
  constexpr int64_t kMin = std::numeric_limits<int64_t>::min();
  constexpr int64_t kMax = std::numeric_limits<int64_t>::max();
  for (const int64_t ticks :
       {kMin, int64_t{-1}, kEraTicks + 1, kUnixEpochTicks - kEraTicks - 1,
        kMaxHostTicks + 1, kMax}) {
    EXPECT_FALSE(AreHostTicks(ticks)) << ticks;
  }
  for (const int64_t ticks :
       {int64_t{0}, int64_t{1}, kEraTicks, kUnixEpochTicks - kEraTicks,
        INT64_C(637355968000000001), kMaxHostTicks}) {
    EXPECT_TRUE(AreHostTicks(ticks)) << ticks;
  }
  // 2116-02-20 23:53:38.4 UTC.
  EXPECT_EQ(UnixSecondsOfTicks(kMaxHostTicks), "4611686018.4273879");
  // Two that are so far before and after 1970, in nanoseconds.
  EXPECT_GT(2 * (kEraTicks * 100), 0);
}

}  // namespace
}  // namespace cartographer_ext
