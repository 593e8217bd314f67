// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/localization_error.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(LocalizationErrorTest, MedianMaximumAndJumps) {
  std::vector<LocalizationError> errors;
  EXPECT_TRUE(std::isnan(MedianError(errors)));
  EXPECT_TRUE(std::isnan(MaxError(errors)));
  EXPECT_EQ(CountJumps(errors), 0);
  for (const double x : {0., 0.1, 0.2, 0.9, 0.8, -0.1}) {
    errors.push_back({0, Eigen::Vector2d(x, 0.)});
  }
  EXPECT_NEAR(MedianError(errors), 0.2, 1e-12);
  EXPECT_NEAR(MaxError(errors), 0.9, 1e-12);
  EXPECT_EQ(CountJumps(errors), 2);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
