// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/wall_filling.h"

#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using Points = std::vector<Eigen::Vector3f>;

TEST(WallFillingTest, FillsTheInnerGapsOfAWall) {
  WallFillingOptions options;
  options.spacing = 0.05;
  const Points filled = FillWalls(
      options,
      {{0.f, 1.f, 0.f}, {0.2f, 1.f, 0.f}, {0.4f, 1.f, 0.f}, {0.6f, 1.f, 0.f}});
  // Of three gaps the middle one has points on both sides.
  ASSERT_EQ(filled.size(), 3);
  EXPECT_NEAR(filled[0].x(), 0.25f, 1e-6f);
  EXPECT_NEAR(filled[1].x(), 0.3f, 1e-6f);
  EXPECT_NEAR(filled[2].x(), 0.35f, 1e-6f);
  EXPECT_NEAR(filled[2].y(), 1.f, 1e-6f);
}

TEST(WallFillingTest, LeavesCornersDoorsAndSteps) {
  const WallFillingOptions options;
  // A corner between the second and the third point.
  EXPECT_TRUE(FillWalls(options, {{0.f, 0.f, 0.f},
                                  {0.2f, 0.f, 0.f},
                                  {0.4f, 0.2f, 0.f},
                                  {0.4f, 0.4f, 0.f}})
                  .empty());
  // A door: the gap is wider than those beside it, and than max_gap.
  EXPECT_TRUE(FillWalls(options, {{0.f, 0.f, 0.f},
                                  {0.1f, 0.f, 0.f},
                                  {1.3f, 0.f, 0.f},
                                  {1.4f, 0.f, 0.f}})
                  .empty());
  // The wall goes on 10 cm further back.
  EXPECT_TRUE(FillWalls(options, {{0.f, 0.f, 0.f},
                                  {0.2f, 0.f, 0.f},
                                  {0.4f, 0.1f, 0.f},
                                  {0.6f, 0.1f, 0.f}})
                  .empty());
}

TEST(WallFillingTest, DenseWallsStayAsTheyAre) {
  const WallFillingOptions options;
  Points wall;
  for (int i = 0; i < 50; ++i) wall.push_back({0.03f * i, 2.f, 0.f});
  EXPECT_TRUE(FillWalls(options, wall).empty());
}

TEST(WallFillingTest, NoiseWithinTheToleranceIsAWall) {
  WallFillingOptions options;
  options.tolerance = 0.04;
  EXPECT_FALSE(FillWalls(options, {{0.f, 0.f, 0.f},
                                   {0.3f, -0.01f, 0.f},
                                   {0.6f, 0.01f, 0.f},
                                   {0.9f, 0.f, 0.f}})
                   .empty());
}

TEST(WallFillingTest, FewAndBrokenPoints) {
  const WallFillingOptions options;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(FillWalls(options, {}).empty());
  EXPECT_TRUE(FillWalls(options, {{0.f, 0.f, 0.f}, {0.2f, 0.f, 0.f}}).empty());
  EXPECT_TRUE(FillWalls(options, {{0.f, 0.f, 0.f},
                                  {0.2f, 0.f, 0.f},
                                  {0.4f, nan, 0.f},
                                  {0.6f, 0.f, 0.f}})
                  .empty());
  // The same place over and over.
  EXPECT_TRUE(
      FillWalls(options, Points(6, Eigen::Vector3f(1.f, 1.f, 0.f))).empty());
  WallFillingOptions off;
  off.max_gap = 0.;
  EXPECT_TRUE(FillWalls(off, {{0.f, 0.f, 0.f},
                              {0.2f, 0.f, 0.f},
                              {0.4f, 0.f, 0.f},
                              {0.6f, 0.f, 0.f}})
                  .empty());
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
