// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/fixed_ratio_sampler.h"

#include <string>

#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

std::string Pattern(const double ratio, const int num_pulses) {
  FixedRatioSampler sampler(ratio);
  std::string pattern;
  for (int i = 0; i != num_pulses; ++i) pattern += sampler.Pulse() ? 'x' : '.';
  return pattern;
}

TEST(FixedRatioSamplerTest, Patterns) {
  EXPECT_EQ(Pattern(1., 5), "xxxxx");
  EXPECT_EQ(Pattern(0., 5), ".....");
  EXPECT_EQ(Pattern(0.5, 6), "x.x.x.");
  // 0/1 < .3, 1/2, 1/3 not, 1/4 < .3, 2/5 .. 2/7 = .2857 < .3.
  EXPECT_EQ(Pattern(0.3, 11), "x..x..x...x");
}

TEST(FixedRatioSamplerTest, DebugString) {
  FixedRatioSampler sampler(0.5);
  EXPECT_EQ(sampler.DebugString(), "0 (0.00%)");
  for (int i = 0; i != 3; ++i) sampler.Pulse();
  EXPECT_EQ(sampler.DebugString(), "2 (66.67%)");
}

TEST(FixedRatioSamplerDeathTest, RatioMustBeAShare) {
  EXPECT_DEATH(FixedRatioSampler(1.1), "");
  EXPECT_DEATH(FixedRatioSampler(-0.1), "");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
