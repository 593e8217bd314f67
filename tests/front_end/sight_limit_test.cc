// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/sight_limit.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Of `n` scans a quarter of a metre apart, every `every`th reaches as far.
void AddScans(const int n, const int every, SightLimit* const limit) {
  for (int i = 0; i < n; ++i) {
    const float farthest = i % every == 0 ? 4.5f : 3.f;
    limit->Add(Pose2(0.25 * i, 0., 0.), {1.f, farthest, farthest, farthest});
  }
}

TEST(SightLimitTest, IsWhereMostScansEnd) {
  SightLimit limit;
  AddScans(49, 1, &limit);
  EXPECT_TRUE(std::isinf(limit.Limit()));
  AddScans(2, 1, &limit);
  EXPECT_NEAR(limit.Limit(), 3.5, 1e-6);
}

TEST(SightLimitTest, OtherwiseTheBuildingEndsIt) {
  SightLimit limit;
  AddScans(200, 3, &limit);
  EXPECT_TRUE(std::isinf(limit.Limit()));
}

TEST(SightLimitTest, ScansOfARobotAtRestAreOne) {
  SightLimit limit;
  for (int i = 0; i < 200; ++i) limit.Add(Pose2(), {4.5f, 4.5f, 4.5f});
  EXPECT_TRUE(std::isinf(limit.Limit()));
}

TEST(SightLimitTest, TwoLongRangesAreOutliers) {
  SightLimit limit;
  AddScans(60, 1, &limit);
  limit.Add(Pose2(100., 0., 0.), {9.f, 9.f, 4.5f});
  EXPECT_NEAR(limit.Limit(), 3.5, 1e-6);
  limit.Add(Pose2(101., 0., 0.), {9.f, 9.f, 9.f});
  EXPECT_TRUE(std::isinf(limit.Limit()));
}

TEST(SightLimitTest, TooFewRangesSayNothing) {
  SightLimit limit;
  AddScans(60, 1, &limit);
  limit.Add(Pose2(100., 0., 0.), {9.f, 9.f});
  limit.Add(Pose2(101., 0., 0.), {});
  EXPECT_NEAR(limit.Limit(), 3.5, 1e-6);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
