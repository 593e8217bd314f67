// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A* on an 8-connected grid (Hart, Nilsson and Raphael 1968).
//
// A step into a cell costs its weight times 5 (straight) or 7 (diagonal), all
// integers. Free cells have at least the weight kMinWeight, so with
// dx, dy the distance to the goal in cells
//   h = kMinWeight (5 max(dx, dy) + 2 min(dx, dy))
// never overestimates (admissible) and h(a) <= cost(a, b) + h(b) for every step
// (consistent): a cell that is expanded has its final cost, and the keys
// f = g + h never decrease. Open cells are therefore kept in a ring of buckets
// by f (Dial 1969), which needs no comparison; the last one in is the first
// out, which among equal f prefers the deeper cell. Diagonal steps past the
// corner of a blocked cell are not made.
//
// A library such as Boost.Graph keeps a heap and property maps for this, an
// order of magnitude slower on maps of 16 million cells.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_GRID_SEARCH_H_
#define CARTOGRAPHER_EXT_NAVIGATION_GRID_SEARCH_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartographer_ext/navigation/grid_geometry.h"

namespace cartographer_ext {
namespace navigation {

constexpr uint8_t kBlocked = 0;
constexpr uint8_t kMinWeight = 4;
constexpr uint8_t kMaxWeight = 64;
constexpr uint32_t kStraightStep = 5;
constexpr uint32_t kDiagonalStep = 7;

// Cost of a step into each cell, row by row: kBlocked, or from kMinWeight to
// kMaxWeight.
struct WeightGrid {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> weights;

  bool Contains(const Cell& cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width && cell.y < height;
  }
  uint8_t at(const Cell& cell) const {
    return weights[static_cast<size_t>(cell.y) * width + cell.x];
  }
};

struct GridPath {
  bool found = false;
  std::vector<Cell> cells;  // from start to goal, both included
  uint32_t cost = 0;
  int64_t expanded = 0;  // cells taken from the open list
};

class GridSearch {
 public:
  // Not found where start or goal is blocked or outside, or where no path
  // joins them. Memory is kept for the next search.
  GridPath Search(const WeightGrid& grid, const Cell& start, const Cell& goal);

 private:
  void Reset(const WeightGrid& grid);
  size_t Index(const int x, const int y) const {
    return (static_cast<size_t>(y) + 1) * stride_ + x + 1;
  }
  // Goes back from the goal to neighbours from which the costs agree.
  std::vector<Cell> PathTo(const WeightGrid& grid, const Cell& goal,
                           const Cell& start) const;

  // g, from the start, with a border of blocked cells.
  std::vector<uint32_t> cost_;
  size_t stride_ = 0;                           // of a row of costs
  std::vector<std::vector<uint32_t>> buckets_;  // x and y, 16 bits each
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_GRID_SEARCH_H_
