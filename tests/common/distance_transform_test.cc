// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/distance_transform.h"

#include <algorithm>
#include <limits>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

std::vector<int32_t> BruteForce(const std::vector<uint8_t>& occupied,
                                const int width, const int height) {
  std::vector<int32_t> squared(occupied.size(), kNoOccupiedCell);
  for (int i = 0; i != width * height; ++i) {
    for (int j = 0; j != width * height; ++j) {
      if (!occupied[j]) continue;
      const int dx = i % width - j % width, dy = i / width - j / width;
      squared[i] = std::min(squared[i], dx * dx + dy * dy);
    }
  }
  return squared;
}

TEST(DistanceTransformTest, IsExactOnRandomGrids) {
  Random random(1);
  for (int trial = 0; trial != 200; ++trial) {
    const int width = random.UniformInt(1, 30);
    const int height = random.UniformInt(1, 30);
    const double share = random.Uniform(0., trial % 3 == 0 ? 0.6 : 0.02);
    std::vector<uint8_t> occupied(width * height);
    for (uint8_t& cell : occupied) cell = random.Uniform() < share;
    EXPECT_EQ(SquaredDistanceTransform(occupied, width, height),
              BruteForce(occupied, width, height))
        << width << " x " << height;
  }
}

TEST(DistanceTransformTest, WithoutOccupiedCellIsInfinite) {
  EXPECT_EQ(DistanceTransform({0, 0, 0, 0, 0, 0}, 3, 2, 0.05),
            std::vector<float>(6, std::numeric_limits<float>::infinity()));
  EXPECT_TRUE(DistanceTransform({}, 0, 0, 0.05).empty());
}

TEST(DistanceTransformTest, IsInMetres) {
  const std::vector<float> distances =
      DistanceTransform({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, 3, 0.5);
  EXPECT_FLOAT_EQ(distances[0], 0.f);
  EXPECT_FLOAT_EQ(distances[3], 1.5f);
  EXPECT_FLOAT_EQ(distances[11], 0.5f * std::sqrt(13.f));
}

}  // namespace
}  // namespace cartographer_ext
