// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/adaptive_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using Points = std::vector<Eigen::Vector2d>;

TEST(AdaptiveFeaturesTest, VariationByHand) {
  // Centre with four neighbours on a cross, twice as long in x: without
  // weights C = diag(2 * 4, 2 * 1) / 4, sigma = 2 * 0.5 / 2.5 = 0.4.
  const Points points = {{0., 0.}, {2., 0.}, {-2., 0.}, {0., 1.}, {0., -1.}};
  AdaptiveFeatureOptions options;
  options.num_neighbors = 4;
  options.distance_weighted = false;
  EXPECT_NEAR(FeatureVariation(options, points)[0], 0.4, 1e-12);
  // With weights exp(-d^2 / r^2), r = 2: exp(-1) in x, exp(-1/4) in y.
  options.distance_weighted = true;
  const double x = 2. * std::exp(-1.), y = 0.5 * std::exp(-0.25);
  EXPECT_NEAR(FeatureVariation(options, points)[0],
              2. * std::min(x, y) / (x + y), 1e-12);
}

TEST(AdaptiveFeaturesTest, StraightWallHasNoVariation) {
  Points wall;
  for (int i = 0; i < 50; ++i) wall.emplace_back(0.1 * i, 0.2 * i);
  AdaptiveFeatureOptions options;
  for (const double variation : FeatureVariation(options, wall)) {
    EXPECT_NEAR(variation, 0., 1e-9);
  }
  options.min_points = 7;
  EXPECT_GE(SelectFeatures(options, wall).size(), 7u);
}

TEST(AdaptiveFeaturesTest, CornerIsKept) {
  Points points;
  for (int i = 40; i > 0; --i) points.emplace_back(0.1 * i, 0.);
  points.emplace_back(0., 0.);
  for (int i = 1; i <= 40; ++i) points.emplace_back(0., 0.1 * i);
  AdaptiveFeatureOptions options;
  options.min_points = 0;
  const std::vector<int> selected = SelectFeatures(options, points);
  EXPECT_TRUE(std::count(selected.begin(), selected.end(), 40));
  EXPECT_LT(selected.size(), points.size() / 2);
  // Everything kept lies near the corner.
  for (const int index : selected) EXPECT_LT(points[index].norm(), 1.);
}

TEST(AdaptiveFeaturesTest, FloorIsMetAndNeverExceedsThePoints) {
  Random random(1);
  Points points;
  for (int i = 0; i < 30; ++i) {
    points.emplace_back(random.Uniform(), random.Uniform());
  }
  AdaptiveFeatureOptions options;
  options.min_points = 25;
  EXPECT_GE(SelectFeatures(options, points).size(), 25u);
  options.min_points = 1000;
  EXPECT_EQ(SelectFeatures(options, points).size(), 30u);
}

TEST(AdaptiveFeaturesTest, DegenerateInput) {
  AdaptiveFeatureOptions options;
  EXPECT_TRUE(SelectFeatures(options, {}).empty());
  EXPECT_EQ(FeatureVariation(options, {{1., 1.}})[0], 0.);
  EXPECT_EQ(SelectFeatures(options, {{1., 1.}}).size(), 1u);  // the floor
  // Coincident points.
  EXPECT_EQ(FeatureVariation(options, Points(20, {1., 2.}))[3], 0.);
  // Not finite: no variation, nobody's neighbour, never selected.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Points with_nan = {{0., 0.}, {nan, 0.}, {1., 0.}, {0., 1.}};
  EXPECT_EQ(FeatureVariation(options, with_nan)[1], 0.);
  const std::vector<int> selected = SelectFeatures(options, with_nan);
  EXPECT_EQ(std::count(selected.begin(), selected.end(), 1), 0);
  EXPECT_EQ(selected.size(), 3u);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
