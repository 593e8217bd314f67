// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/field_of_view.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(FieldOfViewTest, HalfATurnDoesNotSeeBehind) {
  const Eigen::Vector2d laser(0.2, 0.);
  std::vector<Eigen::Vector2d> echoes, free_ends;
  for (int degrees = -90; degrees <= 90; ++degrees) {
    const double bearing = degrees * 3.14159265358979 / 180.;
    (degrees % 7 == 0 ? free_ends : echoes)
        .push_back(laser +
                   3. * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)));
  }
  echoes.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0.);
  const FieldOfView view(laser, echoes, free_ends);
  EXPECT_TRUE(view.Contains({5., 0.}));
  EXPECT_TRUE(view.Contains({0.5, -2.}));
  EXPECT_TRUE(view.Contains({0.21, 1.}));
  EXPECT_FALSE(view.Contains({0., 1.}));
  EXPECT_FALSE(view.Contains({-1., 0.}));
  EXPECT_FALSE(FieldOfView(laser, {}, {}).Contains({1., 0.}));
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
