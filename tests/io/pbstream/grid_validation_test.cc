// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/grid_validation.h"

#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Three by two cells.
cartographer::mapping::proto::Grid2D Good() {
  cartographer::mapping::proto::Grid2D grid;
  grid.mutable_limits()->set_resolution(0.05);
  grid.mutable_limits()->mutable_max()->set_x(1.);
  grid.mutable_limits()->mutable_max()->set_y(2.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(3);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(2);
  for (const int cell : {0, 1, 100, 32767, 0, 5}) grid.add_cells(cell);
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  grid.mutable_probability_grid_2d();
  auto* const box = grid.mutable_known_cells_box();
  box->set_min_x(0);
  box->set_max_x(2);
  box->set_min_y(0);
  box->set_max_y(1);
  return grid;
}

TEST(GridValidationTest, AGoodGridHasNoProblems) {
  EXPECT_TRUE(CheckGridLayout(Good()).ok());
  EXPECT_THAT(FindGridProblems(Good(), "s"), IsEmpty());
  auto old = Good();  // both costs are zero
  old.set_min_correspondence_cost(0.f);
  old.set_max_correspondence_cost(0.f);
  EXPECT_TRUE(CheckGridLayout(old).ok());
}

TEST(GridValidationTest, SizeAndNumberOfCellsMustFit) {
  auto grid = Good();
  grid.add_cells(3);
  EXPECT_EQ(CheckGridLayout(grid).message(),
            "the grid has 7 cells instead of 3 x 2");
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(0);
  EXPECT_THAT(FindGridProblems(grid, "s"), ElementsAre("s has the size 0 x 2"));
  // The product of these would not fit an int.
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(1 << 30);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(1 << 30);
  EXPECT_FALSE(CheckGridLayout(grid).ok());
}

TEST(GridValidationTest, ResolutionPlaceAndCostsMustBePossible) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double resolution : {0., -1., 1e-7, 1e7, nan}) {
    auto grid = Good();
    grid.mutable_limits()->set_resolution(resolution);
    EXPECT_FALSE(CheckGridLayout(grid).ok()) << resolution;
  }
  for (const double x : {2. * kMaxCoordinate, -2. * kMaxCoordinate, nan}) {
    auto grid = Good();
    grid.mutable_limits()->mutable_max()->set_x(x);
    EXPECT_FALSE(CheckGridLayout(grid).ok()) << x;
  }
  auto grid = Good();
  grid.set_min_correspondence_cost(0.95f);  // above the largest
  EXPECT_FALSE(CheckGridLayout(grid).ok());
}

TEST(GridValidationTest, CellsHaveFifteenBits) {
  for (const int value : {-1, 32768}) {
    auto grid = Good();
    grid.set_cells(2, value);
    grid.set_cells(4, value);  // reported once
    EXPECT_TRUE(CheckGridLayout(grid).ok());
    EXPECT_EQ(FindGridProblems(grid, "s").size(), 1u);
  }
}

TEST(GridValidationTest, TheBoxOfKnownCellsLiesInside) {
  auto grid = Good();
  grid.mutable_known_cells_box()->set_max_x(3);
  EXPECT_THAT(FindGridProblems(grid, "s"),
              ElementsAre("s has a box of known cells beyond its limits"));
}

TEST(GridValidationTest, ATsdfNeedsAWeightForEachCell) {
  auto grid = Good();
  auto* const tsdf = grid.mutable_tsdf_2d();  // instead of probabilities
  tsdf->set_truncation_distance(0.3f);
  tsdf->set_max_weight(10.f);
  EXPECT_THAT(FindGridProblems(grid, "s"),
              ElementsAre("s has 0 weights for 6 cells"));
  for (int i = 0; i < 6; ++i) tsdf->add_weight_cells(i);
  EXPECT_THAT(FindGridProblems(grid, "s"), IsEmpty());
  tsdf->set_max_weight(0.f);
  EXPECT_EQ(FindGridProblems(grid, "s").size(), 1u);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
