// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// 100 x 80 cells of 5 cm; its corner of cell (0, 0) at (2, 3).
GridGeometry Geometry() {
  GridGeometry geometry;
  geometry.num_x = 100;
  geometry.num_y = 80;
  geometry.resolution = 0.05;
  geometry.max_x = 2.;
  geometry.max_y = 3.;
  return geometry;
}

PlanarCloud Cloud(const std::vector<float>& x, const std::vector<float>& y) {
  PlanarCloud cloud;
  cloud.x = x;
  cloud.y = y;
  return cloud;
}

TEST(RotatedScansTest, LatticeByHand) {
  const RotatedScans scans(Cloud({1.f}, {0.f}), Pose2(), 0.12, 0.1, Geometry(),
                           BestSearchKernels());
  ASSERT_TRUE(scans.valid());
  EXPECT_EQ(scans.linear_cells(), 3);  // 2.4 rounded up
  const double step = 0.999 * std::acos(1. - 0.05 * 0.05 / 2.);
  EXPECT_NEAR(scans.angular_step(), step, 1e-12);
  EXPECT_EQ(scans.num_rotations(), 2 * 3 + 1);  // 0.1 / 0.04996 = 2.0016
  // Short ranges count as three cells.
  const RotatedScans near(Cloud({0.01f}, {0.f}), Pose2(), 0., 0., Geometry(),
                          BestSearchKernels());
  EXPECT_NEAR(near.angular_step(), 0.999 * std::acos(1. - 1. / 18.), 1e-6);
  EXPECT_EQ(near.num_rotations(), 1);
  EXPECT_EQ(near.linear_cells(), 0);
}

TEST(RotatedScansTest, CellsAndBoundsByHand) {
  const float quarter = static_cast<float>(kPi / 2.);
  RotatedScans scans(Cloud({1.02f, 0.f}, {0.f, 0.f}),
                     Pose2(0.01, 0.02, quarter), 10., 0., Geometry(),
                     BestSearchKernels());
  ASSERT_EQ(scans.num_rotations(), 1);
  const RotatedScan& scan = scans.Get(0);
  // World (0.01, 1.04): (3 - 1.04) / 0.05 - 0.5 = 38.7, (2 - 0.01) / 0.05 - 0.5
  // = 39.3. World (0.01, 0.02): 59.1.
  EXPECT_EQ(scan.x[0], 39);
  EXPECT_EQ(scan.y[0], 39);
  EXPECT_EQ(scan.x[1], 59);
  EXPECT_EQ(scan.y[1], 39);
  EXPECT_EQ(scan.cells.min_x, 39);
  EXPECT_EQ(scan.cells.max_x, 59);
  EXPECT_EQ(scan.offsets.min_x, -59);
  EXPECT_EQ(scan.offsets.max_x, 99 - 39);
  EXPECT_EQ(scan.offsets.min_y, -39);
  EXPECT_EQ(scan.offsets.max_y, 79 - 39);
  // One cell more along x is 5 cm less along world y.
  const Pose2 pose = scans.PoseOf(0, 2, -4);
  EXPECT_DOUBLE_EQ(pose.x, 0.01 + 0.2);
  EXPECT_DOUBLE_EQ(pose.y, 0.02 - 0.1);
  EXPECT_DOUBLE_EQ(pose.theta, quarter);
}

// The offset (0, 0) is always searched, also with the scan outside the grid.
TEST(RotatedScansTest, ZeroStaysIn) {
  RotatedScans scans(Cloud({0.f}, {0.f}), Pose2(100., -100., 0.), 1., 0.,
                     Geometry(), BestSearchKernels());
  const OffsetBounds bounds = scans.Get(0).offsets;
  EXPECT_TRUE(bounds.Contains(0, 0));
  EXPECT_FALSE(bounds.Contains(1, 0));
  EXPECT_TRUE(bounds.Contains(-20, 0));
}

// What the coarse bounds of the search rest on.
TEST(RotatedScansTest, PointsMoveByNoMoreThanTheBound) {
  Random random(9);
  for (int i = 0; i != 30; ++i) {
    PlanarCloud cloud;
    for (int k = 0; k != 40; ++k) {
      cloud.x.push_back(static_cast<float>(random.Uniform(-30., 30.)));
      cloud.y.push_back(static_cast<float>(random.Uniform(-30., 30.)));
    }
    const RotatedScans scans(
        cloud,
        Pose2(random.Uniform(-200., 200.), random.Uniform(-200., 200.),
              random.Uniform(-4., 4.)),
        1., kPi, Geometry(), BestSearchKernels());
    std::vector<int32_t> x(40), y(40), other_x(40), other_y(40);
    for (int k = 0; k != 300; ++k) {
      const int steps = static_cast<int>(random.UniformInt(1, 6));
      const int rotation = static_cast<int>(
          random.UniformInt(0, scans.num_rotations() - 1 - steps));
      scans.FindCells(rotation, x.data(), y.data());
      scans.FindCells(rotation + steps, other_x.data(), other_y.data());
      for (int point = 0; point != 40; ++point) {
        const double bound = std::ceil(steps * scans.CellsPerStep(point) +
                                       scans.RoundingCells());
        ASSERT_LE(std::abs(x[point] - other_x[point]), bound);
        ASSERT_LE(std::abs(y[point] - other_y[point]), bound);
      }
    }
  }
}

TEST(RotatedScansTest, PartsAreInOrderAndCoverAll) {
  for (const int count : {1, 3, 8, 33, 200}) {
    const RotatedScans scans(
        Cloud(std::vector<float>(count, 1.f), std::vector<float>(count, 0.f)),
        Pose2(), 0., 0., Geometry(), BestSearchKernels());
    EXPECT_EQ(scans.PartBegin(0), 0);
    EXPECT_EQ(scans.PartBegin(RotatedScans::kNumParts), count);
    for (int part = 0; part != RotatedScans::kNumParts; ++part) {
      EXPECT_LE(scans.PartBegin(part), scans.PartBegin(part + 1));
    }
  }
}

TEST(RotatedScansTest, BadInputIsHarmless) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  RotatedScans scans(Cloud({nan, 1.f, infinity}, {0.f, 0.f, 1.f}), Pose2(), 1.,
                     0.1, Geometry(), BestSearchKernels());
  ASSERT_TRUE(scans.valid());
  const RotatedScan& scan = scans.Get(0);
  // Bounds are those of the one good point.
  EXPECT_EQ(scan.cells.min_x, scan.cells.max_x);
  EXPECT_EQ(scan.cells.min_y, scan.cells.max_y);

  const auto valid = [](const PlanarCloud& cloud, const Pose2& initial,
                        const double linear, const double angular) {
    return RotatedScans(cloud, initial, linear, angular, Geometry(),
                        BestSearchKernels())
        .valid();
  };
  const PlanarCloud cloud = Cloud({1.f}, {0.f});
  const double inf = infinity;
  EXPECT_TRUE(valid(cloud, Pose2(), nan, -1.));  // count as zero
  EXPECT_FALSE(valid(cloud, Pose2(), inf, 0.));
  EXPECT_FALSE(valid(cloud, Pose2(), 0., inf));
  EXPECT_FALSE(valid(cloud, Pose2(nan, 0., 0.), 1., 1.));
  EXPECT_FALSE(valid(cloud, Pose2(0., inf, 0.), 1., 1.));
  EXPECT_FALSE(valid(cloud, Pose2(0., 0., nan), 1., 1.));
  // So far away that there are too many rotations.
  EXPECT_FALSE(valid(Cloud({1e15f}, {0.f}), Pose2(), 1., 1.));
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
