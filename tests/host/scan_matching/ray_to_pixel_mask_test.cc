// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/ray_to_pixel_mask.h"

#include <algorithm>
#include <set>
#include <utility>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using Pixels = std::vector<std::pair<int, int>>;

Pixels Mask(const Eigen::Array2i& begin, const Eigen::Array2i& end,
            const int scale) {
  Pixels pixels;
  for (const Eigen::Array2i& pixel : RayToPixelMask(begin, end, scale)) {
    pixels.emplace_back(pixel.x(), pixel.y());
  }
  return pixels;
}

TEST(RayToPixelMaskTest, OnePixel) {
  EXPECT_EQ(Mask({3, 7}, {3, 7}, 1), (Pixels{{3, 7}}));
  EXPECT_EQ(Mask({30, 70}, {39, 79}, 10), (Pixels{{3, 7}}));
}

TEST(RayToPixelMaskTest, AlongTheAxes) {
  EXPECT_EQ(Mask({1, 2}, {4, 2}, 1), (Pixels{{1, 2}, {2, 2}, {3, 2}, {4, 2}}));
  EXPECT_EQ(Mask({4, 2}, {1, 2}, 1), (Pixels{{1, 2}, {2, 2}, {3, 2}, {4, 2}}));
  EXPECT_EQ(Mask({1, 4}, {1, 2}, 1), (Pixels{{1, 2}, {1, 3}, {1, 4}}));
}

TEST(RayToPixelMaskTest, DiagonalPassesThroughCorners) {
  EXPECT_EQ(Mask({0, 0}, {2, 2}, 1), (Pixels{{0, 0}, {1, 1}, {2, 2}}));
  EXPECT_EQ(Mask({0, 2}, {2, 0}, 1), (Pixels{{0, 2}, {1, 1}, {2, 0}}));
}

TEST(RayToPixelMaskTest, SteepRay) {
  EXPECT_EQ(Mask({0, 0}, {1, 3}, 1), (Pixels{{0, 0}, {0, 1}, {1, 2}, {1, 3}}));
}

// Whether the segment between subpixel centres passes through the inside of a
// pixel: intersects the parameter intervals of both axes in fractions over
// width * height. Half a subpixel is the unit.
bool PassesThrough(const Eigen::Array2i& begin, const Eigen::Array2i& end,
                   const int scale, const int x, const int y) {
  double low = 0.;
  double high = 1.;
  for (int axis = 0; axis != 2; ++axis) {
    const int from = 2 * begin[axis] + 1;
    const int to = 2 * end[axis] + 1;
    const int pixel = axis == 0 ? x : y;
    const int edges[] = {2 * scale * pixel, 2 * scale * (pixel + 1)};
    if (from == to) {
      if (from <= edges[0] || from >= edges[1]) return false;
      continue;
    }
    double enter = static_cast<double>(edges[0] - from) / (to - from);
    double leave = static_cast<double>(edges[1] - from) / (to - from);
    if (enter > leave) std::swap(enter, leave);
    low = std::max(low, enter);
    high = std::min(high, leave);
  }
  // Small numbers: equal fractions differ by rounding only, others by far more.
  return high - low > 1e-9;
}

TEST(RayToPixelMaskTest, AgreesWithGeometryForAllSegments) {
  constexpr int kScale = 3;
  constexpr int kPixels = 4;
  constexpr int kSubpixels = kScale * kPixels;
  for (int from = 0; from != kSubpixels * kSubpixels; ++from) {
    for (int to = 0; to != kSubpixels * kSubpixels; ++to) {
      if (from == to) continue;
      const Eigen::Array2i begin(from % kSubpixels, from / kSubpixels);
      const Eigen::Array2i end(to % kSubpixels, to / kSubpixels);
      std::set<std::pair<int, int>> expected;
      for (int y = 0; y != kPixels; ++y) {
        for (int x = 0; x != kPixels; ++x) {
          if (PassesThrough(begin, end, kScale, x, y)) expected.emplace(x, y);
        }
      }
      const Pixels mask = Mask(begin, end, kScale);
      const std::set<std::pair<int, int>> found(mask.begin(), mask.end());
      ASSERT_EQ(found.size(), mask.size()) << "a pixel was visited twice";
      ASSERT_EQ(found, expected)
          << begin.transpose() << " to " << end.transpose();
    }
  }
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
