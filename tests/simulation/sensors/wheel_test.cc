// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/wheel.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

TEST(WheelTest, CountsScaledTravelSlipAndWholeTicks) {
  Random random(1);
  Wheel exact(0.02, 0., 0.);
  EXPECT_NEAR(exact.Advance(2., 0., &random), 2.04, 1e-12);
  EXPECT_NEAR(exact.Advance(-1., 0.1, &random), -0.92, 1e-12);
  Wheel ticks(0., 0., 10.);
  EXPECT_NEAR(ticks.Advance(0.19, 0., &random), 0.1, 1e-12);
  EXPECT_NEAR(ticks.Advance(0.02, 0., &random), 0.1, 1e-12);
  Wheel noisy(0., 0.01, 0.);
  const double counted = noisy.Advance(4., 0., &random);
  EXPECT_NE(counted, 4.);
  EXPECT_NEAR(counted, 4., 5. * 0.01 * 2.);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
