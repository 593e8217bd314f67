// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/grid_ray.h"

#include <cmath>
#include <utility>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

using Visits = std::vector<std::pair<Cell, double>>;

Visits VisitsOf(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  Visits visits;
  EXPECT_TRUE(VisitLine(from, to, [&](const Cell& cell, const double length) {
    visits.push_back({cell, length});
    return true;
  }));
  return visits;
}

Cell CellOf(const Eigen::Vector2d& point) {
  return {static_cast<int>(std::floor(point.x())),
          static_cast<int>(std::floor(point.y()))};
}

TEST(GridRayTest, VisitsTheCellsOfALineInOrder) {
  const Visits visits = VisitsOf({0.5, 0.5}, {2.5, 1.5});
  ASSERT_EQ(visits.size(), 4u);
  EXPECT_EQ(visits[0].first, (Cell{0, 0}));
  EXPECT_EQ(visits[1].first, (Cell{1, 0}));
  EXPECT_EQ(visits[2].first, (Cell{1, 1}));
  EXPECT_EQ(visits[3].first, (Cell{2, 1}));
  for (const auto& visit : visits) {
    EXPECT_NEAR(visit.second, 0.25 * std::sqrt(5.), 1e-12);
  }
}

TEST(GridRayTest, LengthsAreThoseOfTheLineInEachCell) {
  Random random(3);
  for (int trial = 0; trial != 300; ++trial) {
    const Eigen::Vector2d from(random.Uniform(-9., 9.),
                               random.Uniform(-9., 9.));
    Eigen::Vector2d to(random.Uniform(-9., 9.), random.Uniform(-9., 9.));
    if (trial % 5 == 0) to.x() = from.x();
    if (trial % 7 == 0) to.y() = from.y();
    const Visits visits = VisitsOf(from, to);
    EXPECT_EQ(visits.front().first, CellOf(from));
    EXPECT_EQ(visits.back().first, CellOf(to));
    const double length = (to - from).norm();
    double begin = 0.;
    for (size_t i = 0; i != visits.size(); ++i) {
      const Cell& cell = visits[i].first;
      if (visits[i].second > 1e-9) {
        const double middle = (begin + 0.5 * visits[i].second) / length;
        EXPECT_EQ(cell, CellOf(from + middle * (to - from)));
      }
      if (i > 0) {
        const Cell& last = visits[i - 1].first;
        EXPECT_EQ(std::abs(cell.x - last.x) + std::abs(cell.y - last.y), 1);
      }
      begin += visits[i].second;
    }
    EXPECT_NEAR(begin, length, 1e-9);
  }
}

TEST(GridRayTest, APointIsInOneCell) {
  const Visits visits = VisitsOf({-0.25, 3.75}, {-0.25, 3.75});
  ASSERT_EQ(visits.size(), 1u);
  EXPECT_EQ(visits[0].first, (Cell{-1, 3}));
  EXPECT_EQ(visits[0].second, 0.);
}

TEST(GridRayTest, StopsWhenTheVisitorHasSeenEnough) {
  int count = 0;
  EXPECT_FALSE(VisitLine({0.5, 0.5}, {9.5, 0.5}, [&](const Cell& cell, double) {
    ++count;
    return cell.x < 3;
  }));
  EXPECT_EQ(count, 4);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
