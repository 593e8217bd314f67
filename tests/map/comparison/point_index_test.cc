// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/comparison/point_index.h"

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

int NearestByHand(const std::vector<Eigen::Vector2d>& points,
                  const Eigen::Vector2d& place, const double radius) {
  int nearest = -1;
  double best = radius;
  for (size_t i = 0; i != points.size(); ++i) {
    const double distance = (points[i] - place).norm();
    if (distance < best) {
      best = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

TEST(PointIndexTest, FindsTheNearestWithinTheRadius) {
  Random random(11);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i != 500; ++i) {
    points.emplace_back(random.Uniform(-20., 20.), random.Uniform(-20., 20.));
  }
  int none = 0;
  for (const double radius : {0.3, 1., 7.}) {
    const PointIndex index(points, radius);
    for (int trial = 0; trial != 1000; ++trial) {
      const Eigen::Vector2d place(random.Uniform(-25., 25.),
                                  random.Uniform(-25., 25.));
      const int expected = NearestByHand(points, place, radius);
      EXPECT_EQ(index.Nearest(place), expected);
      none += expected < 0;
    }
  }
  EXPECT_GT(none, 100);
}

TEST(PointIndexTest, OfEquallyNearPointsTheFirst) {
  const std::vector<Eigen::Vector2d> points = {
      {1., 0.}, {-1., 0.}, {0., 1.}, {0., -1.}};
  EXPECT_EQ(PointIndex(points, 2.).Nearest({0., 0.}), 0);
  EXPECT_EQ(PointIndex(points, 2.).Nearest({-0.1, 0.}), 1);
}

TEST(PointIndexTest, NothingIsNear) {
  const std::vector<Eigen::Vector2d> none;
  EXPECT_EQ(PointIndex(none, 1.).Nearest({0., 0.}), -1);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
