// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/port.h"

#include <string>

#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

TEST(PortTest, RoundingGoesAwayFromZero) {
  EXPECT_EQ(RoundToInt(0.5), 1);
  EXPECT_EQ(RoundToInt(-0.5f), -1);
  EXPECT_EQ(RoundToInt(2.49f), 2);
  EXPECT_EQ(RoundToInt64(-1e12 - 0.6), -1000000000001ll);
}

TEST(PortTest, GzipRoundTrip) {
  std::string text;
  for (int64 i = 0; i != 100000; ++i) text += static_cast<char>(i * i >> 7);
  std::string compressed = "before";
  FastGzipString(text, &compressed);
  EXPECT_EQ(compressed.substr(0, 6), "before");
  // Magic, deflate, no flags, no time, fastest.
  EXPECT_EQ(compressed.substr(6, 9),
            std::string("\x1f\x8b\x08\0\0\0\0\0\x04", 9));
  std::string back = "kept";
  FastGunzipString(compressed.substr(6), &back);
  EXPECT_EQ(back, "kept" + text);
}

TEST(PortTest, GzipOfNothing) {
  std::string compressed, back;
  FastGzipString("", &compressed);
  EXPECT_FALSE(compressed.empty());
  FastGunzipString(compressed, &back);
  EXPECT_EQ(back, "");
}

TEST(PortTest, GunzipTakesSeveralMembers) {
  std::string compressed, back;
  FastGzipString("one", &compressed);
  FastGzipString("two", &compressed);
  FastGunzipString(compressed, &back);
  EXPECT_EQ(back, "onetwo");
}

TEST(PortDeathTest, BrokenGzipIsFatal) {
  std::string compressed, back;
  FastGzipString("something to compress", &compressed);
  EXPECT_DEATH(FastGunzipString(compressed.substr(0, 12), &back), "gzip");
  EXPECT_DEATH(FastGunzipString("no gzip", &back), "gzip");
  EXPECT_DEATH(FastGunzipString("", &back), "gzip");
  compressed[compressed.size() - 6] ^= 1;  // checksum
  EXPECT_DEATH(FastGunzipString(compressed, &back), "gzip");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
