// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/host_ticks.h"

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

}  // namespace
}  // namespace cartographer_ext
