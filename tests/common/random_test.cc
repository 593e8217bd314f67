// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/random.h"

#include <cstdint>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(RandomTest, SameOnEveryPlatform) {
  // The 10000th value of mt19937_64 with the default seed is in the standard.
  Random random(5489);
  for (int i = 0; i < 9999; ++i) random.NextBits();
  EXPECT_EQ(random.NextBits(), 9981545732273789042u);
}

TEST(RandomTest, UniformStaysInRange) {
  Random random(1);
  double sum = 0.;
  for (int i = 0; i < 100000; ++i) {
    const double value = random.Uniform(-1., 3.);
    ASSERT_GE(value, -1.);
    ASSERT_LT(value, 3.);
    sum += value;
  }
  // Standard error 4 / sqrt(12 n) = 0.0037.
  EXPECT_NEAR(sum / 100000., 1., 0.015);
}

TEST(RandomTest, UniformIntReachesBothEnds) {
  Random random(2);
  int counts[4] = {};
  for (int i = 0; i < 40000; ++i) {
    const int64_t value = random.UniformInt(-1, 2);
    ASSERT_GE(value, -1);
    ASSERT_LE(value, 2);
    ++counts[value + 1];
  }
  for (const int count : counts) EXPECT_NEAR(count, 10000, 350);
  EXPECT_EQ(random.UniformInt(7, 7), 7);
  random.UniformInt(std::numeric_limits<int64_t>::min(),
                    std::numeric_limits<int64_t>::max());
}

TEST(RandomTest, NormalHasItsMoments) {
  Random random(3);
  double sum = 0., squares = 0.;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.Normal(2., 3.);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kCount;
  EXPECT_NEAR(mean, 2., 0.03);
  EXPECT_NEAR(squares / kCount - mean * mean, 9., 0.15);
}

TEST(RandomTest, SeedsDiffer) {
  EXPECT_NE(Random(1).NextBits(), Random(2).NextBits());
  EXPECT_EQ(Random(9).Normal(), Random(9).Normal());
}

}  // namespace
}  // namespace cartographer_ext
