// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Rays are tested in range_signature_test.cc.
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"

#include <algorithm>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(OccupancyViewTest, KeepsStates) {
  OccupancyView view(Eigen::Vector2d::Zero(), 0.05, 3, 2);
  EXPECT_EQ(view.At(1, 1), CellState::kUnknown);
  EXPECT_EQ(view.SquaredDistance(1, 1), OccupancyView::kFar);
  for (const CellState state :
       {CellState::kFree, CellState::kOccupied, CellState::kUnknown}) {
    view.Set(1, 1, state);
    EXPECT_EQ(view.At(1, 1), state);
    view.FindDistances(5);
    EXPECT_EQ(view.At(1, 1), state);
  }
  EXPECT_EQ(view.At(-1, 0), CellState::kUnknown);
  EXPECT_EQ(view.SquaredDistance(3, 0), OccupancyView::kFar);
  EXPECT_EQ(view.memory_bytes(), 6u);
}

TEST(OccupancyViewTest, DistancesAreExactWithinTheReach) {
  Random random(5);
  for (const int reach : {0, 1, 4, 11, 50}) {
    OccupancyView view(Eigen::Vector2d::Zero(), 0.05, 41, 37);
    for (int j = 0; j < view.num_y(); ++j) {
      for (int i = 0; i < view.num_x(); ++i) {
        const double u = random.Uniform();
        view.Set(i, j,
                 u < 0.01  ? CellState::kOccupied
                 : u < 0.6 ? CellState::kFree
                           : CellState::kUnknown);
      }
    }
    view.FindDistances(reach);
    // Again: what was found does not count as a state.
    view.FindDistances(reach);
    const int most = std::min(reach, OccupancyView::kMaxReach);
    for (int j = 0; j < view.num_y(); ++j) {
      for (int i = 0; i < view.num_x(); ++i) {
        int nearest = OccupancyView::kFar;
        for (int b = 0; b < view.num_y(); ++b) {
          for (int a = 0; a < view.num_x(); ++a) {
            if (view.At(a, b) != CellState::kOccupied) continue;
            const int square = (a - i) * (a - i) + (b - j) * (b - j);
            if (square <= most * most) nearest = std::min(nearest, square);
          }
        }
        ASSERT_EQ(view.SquaredDistance(i, j), nearest)
            << i << " " << j << " reach " << reach;
      }
    }
  }
}

TEST(OccupancyViewTest, EmptyViewHasNoDistances) {
  OccupancyView view(Eigen::Vector2d::Zero(), 0.05, 0, 0);
  view.FindDistances(3);
  EXPECT_EQ(view.SquaredDistance(0, 0), OccupancyView::kFar);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
