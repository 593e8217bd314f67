// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/wall_normals.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

TEST(WallNormalsTest, AreAcrossTheLineThroughTheNeighbours) {
  // A wall at 30 degrees with a centimetre of noise, then one across it.
  std::vector<Eigen::Vector2d> points;
  const Eigen::Vector2d along(std::cos(0.5236), std::sin(0.5236));
  const Eigen::Vector2d across(-along.y(), along.x());
  for (int i = 0; i < 20; ++i) {
    points.push_back(0.1 * i * along + (i % 2 == 0 ? 0.01 : -0.01) * across);
  }
  for (int i = 0; i < 10; ++i) {
    points.push_back(5. * along + 0.1 * i * across);
  }
  const std::vector<Eigen::Vector2d> normals = WallNormals(points, 5);
  ASSERT_EQ(normals.size(), 25u);
  for (int i = 0; i < 15; ++i) {
    EXPECT_NEAR(normals[i].norm(), 1., 1e-9);
    EXPECT_NEAR(normals[i].dot(along), 0., 0.05);
  }
  for (int i = 15; i < 25; ++i) {
    EXPECT_NEAR(std::abs(normals[i].dot(along)), 1., 1e-9);
  }
}

TEST(WallNormalsTest, ZeroWhereThereIsNoWall) {
  // Two points alone, and a square without a direction.
  const std::vector<Eigen::Vector2d> points = {
      {0., 0.}, {0.1, 0.}, {3., 3.}, {3.1, 3.}, {3., 3.1}, {3.1, 3.1}};
  for (const Eigen::Vector2d& normal : WallNormals(points, 0)) {
    EXPECT_EQ(normal.norm(), 0.);
  }
  // One place, several times.
  for (const Eigen::Vector2d& normal :
       WallNormals(std::vector<Eigen::Vector2d>(5), 0)) {
    EXPECT_LE(normal.norm(), 1. + 1e-9);
  }
}

TEST(WallNormalsTest, OfTheLastPointsOnly) {
  EXPECT_TRUE(WallNormals({}, 0).empty());
  EXPECT_TRUE(WallNormals(std::vector<Eigen::Vector2d>(3), 3).empty());
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
