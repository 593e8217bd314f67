// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Warehouses and halls: one large room with a grid of lanes.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_ext/simulation/buildings/furniture.h"
#include "cartographer_ext/simulation/buildings/plans.h"

namespace cartographer_ext {
namespace simulation {
namespace {

// The outer wall with pilasters or gates at equal distances.
void AddHallWall(const double width, const double height, Random* random,
                 FloorPlan* plan) {
  plan->outline = {{0., 0.}, {width, 0.}, {width, height}, {0., height}};
  const double period = random->Uniform(4., 7.);
  const double depth = random->Uniform(0.15, 0.4);
  const double half = random->Uniform(0.15, 0.3);
  for (size_t side = 0; side != 4; ++side) {
    const Eigen::Vector2d from = plan->outline[side];
    const Eigen::Vector2d to = plan->outline[(side + 1) % 4];
    AddLine(from, to, Surface(), plan);
    const double length = (to - from).norm();
    const Eigen::Vector2d along = (to - from) / length;
    const Eigen::Vector2d inwards(-along.y(), along.x());
    for (double s = period; s < length - 2.; s += period) {
      const Eigen::Vector2d a = from + (s - half) * along;
      const Eigen::Vector2d b = from + (s + half) * along;
      AddLine(a, a + depth * inwards, Surface(), plan);
      AddLine(a + depth * inwards, b + depth * inwards, Surface(), plan);
      AddLine(b + depth * inwards, b, Surface(), plan);
    }
  }
}

// Once round the grid, then to the stops in random order, and back to the
// start.
void RandomRound(const std::vector<std::vector<int>>& grid, const int stops,
                 Random* random, FloorPlan* plan) {
  const size_t last_x = grid.size() - 1, last_y = grid[0].size() - 1;
  plan->round = {grid[0][0], grid[last_x][0], grid[last_x][last_y],
                 grid[0][last_y]};
  for (int i = 0; i != stops; ++i) {
    const int node =
        grid[random->UniformInt(0, last_x)][random->UniformInt(0, last_y)];
    if (node != plan->round.back()) plan->round.push_back(node);
  }
  if (plan->round.back() != grid[0][0]) plan->round.push_back(grid[0][0]);
}

}  // namespace

void PlanWarehouse(Random* random, FloorPlan* plan) {
  const double aisle = random->Uniform(2.8, 3.8);
  const double depth = random->Uniform(0.9, 1.2) * 2.;
  const int rows = static_cast<int>(random->UniformInt(4, 8));
  const int bays = static_cast<int>(random->UniformInt(3, 5));
  const int groups = static_cast<int>(random->UniformInt(1, 2));
  const double rack = 2.7 * bays + 0.1;
  const double cross = random->Uniform(3., 4.5);
  const double filled = random->Uniform(0.55, 0.95);
  const double width = groups * rack + (groups + 1) * cross;
  const double height = rows * depth + (rows + 1) * aisle;
  AddHallWall(width, height, random, plan);
  std::vector<double> xs, ys;
  for (int i = 0; i <= groups; ++i) xs.push_back((i + 0.5) * cross + i * rack);
  for (int j = 0; j <= rows; ++j) ys.push_back((j + 0.5) * aisle + j * depth);
  const auto grid = AddLaneGrid(xs, ys, plan);
  for (int i = 0; i != groups; ++i) {
    for (int j = 0; j != rows; ++j) {
      Placement placement;
      placement.corner = {(i + 1) * cross + i * rack,
                          (j + 1) * aisle + j * depth};
      Place(Rack(bays, depth, filled, random), placement, plan);
    }
  }
  // Things left beside the walls.
  const Box inside = MakeBox(0.4, 0.4, width - 0.4, height - 0.4);
  for (int i = 0; i != 6; ++i) {
    PlaceAtWall(Cupboard(random->Uniform(0.6, 1.2), random->Uniform(0.4, 0.8)),
                inside, random, plan);
  }
  // All aisles one after the other in alternating direction, then back along
  // the first cross aisle.
  plan->round = {grid[0][0]};
  bool at_end = false;
  const int first_step = static_cast<int>(random->UniformInt(1, 2));
  const int aisles = std::min(rows, 5);
  for (int j = 0, seen = 0; j <= rows && seen <= aisles;
       j += seen == 0 ? first_step : 1, ++seen) {
    plan->round.push_back(grid[at_end ? groups : 0][j]);
    at_end = !at_end;
    plan->round.push_back(grid[at_end ? groups : 0][j]);
  }
  if (at_end) plan->round.push_back(grid[groups][0]);
  plan->round.push_back(grid[0][0]);
  plan->lateral_slack = 0.2;
  plan->walk_offset_min = 0.8;
  plan->walk_offset_max = 0.5 * aisle - 0.4;
  plan->people = static_cast<int>(random->UniformInt(0, 4));
  plan->overlap = 30.;
}

void PlanHall(Random* random, FloorPlan* plan) {
  const int columns = static_cast<int>(random->UniformInt(2, 4));
  const int rows = static_cast<int>(random->UniformInt(2, 3));
  const double cell_x = random->Uniform(9., 14.);
  const double cell_y = random->Uniform(8., 12.);
  const double border = random->Uniform(2.5, 5.);
  const double width = columns * cell_x + 2. * border;
  const double height = rows * cell_y + 2. * border;
  AddHallWall(width, height, random, plan);
  std::vector<double> xs, ys;
  for (int i = 0; i <= columns; ++i) xs.push_back(border + i * cell_x);
  for (int j = 0; j <= rows; ++j) ys.push_back(border + j * cell_y);
  const auto grid = AddLaneGrid(xs, ys, plan);
  const double column_radius = random->Uniform(0.2, 0.4);
  const double furnished = random->Uniform(0.2, 1.);
  for (int i = 0; i != columns; ++i) {
    for (int j = 0; j != rows; ++j) {
      const Box cell =
          MakeBox(xs[i] + 1., ys[j] + 1., xs[i + 1] - 1., ys[j + 1] - 1.);
      // The column in the middle of a cell, then booths and tables round it.
      Placement placement;
      placement.corner =
          cell.center() - Eigen::Vector2d::Constant(column_radius);
      Place(RoundThing(column_radius), placement, plan);
      const int things = static_cast<int>(random->UniformInt(1, 6));
      for (int k = 0; k != things; ++k) {
        if (random->Uniform() > furnished) continue;
        const double kind = random->Uniform();
        if (kind < 0.5) {
          PlaceInside(
              Cupboard(random->Uniform(1., 4.), random->Uniform(0.5, 3.)), cell,
              random, plan);
        } else if (kind < 0.8) {
          PlaceInside(Table(8), cell, random, plan);
        } else {
          PlaceInside(RoundThing(random->Uniform(0.2, 0.8)), cell, random,
                      plan);
        }
      }
    }
  }
  RandomRound(grid, static_cast<int>(random->UniformInt(1, 3)), random, plan);
  plan->lateral_slack = 0.3;
  plan->walk_offset_min = 0.7;
  plan->walk_offset_max = 1.5;
  plan->people = static_cast<int>(random->UniformInt(3, 12));
  plan->overlap = 30.;
}

}  // namespace simulation
}  // namespace cartographer_ext
