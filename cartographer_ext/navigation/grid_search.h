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
// On large maps most of the time would go into waiting for memory and into
// mispredicted branches. A node therefore holds cost and weight of its cell in
// 32 bits and eight rows are interleaved, so that the neighbours of a cell lie
// in two or three cache lines of few pages; nodes are prefetched a few entries
// before they are expanded; and one comparison decides about a neighbour,
// whether it is a wall, expanded, open or new.
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
  // Cells that cost more to reach are not left: 84 km of free cells of 5 cm.
  static constexpr uint32_t kMaxCost = (1u << 25) - 1024;

  // Not found where start or goal is blocked or outside, or where no path of at
  // most kMaxCost joins them. Memory is kept for the next search.
  GridPath Search(const WeightGrid& grid, const Cell& start, const Cell& goal);

 private:
  void Reset(const WeightGrid& grid);
  size_t Index(const int x, const int y) const {
    const size_t row = static_cast<size_t>(y) + 1;
    return row / kBand * band_ + (x + 1) * kBand + row % kBand;
  }
  // From the node of a cell in row y to those above and below.
  std::ptrdiff_t StepUp(int y) const;
  std::ptrdiff_t StepDown(int y) const;
  // The corners of a cell lie in the same cache lines as all its neighbours.
  void PrefetchAround(uint32_t entry) const;
  // Goes back from the goal to neighbours from which the costs agree.
  std::vector<Cell> PathTo(const Cell& goal, const Cell& start) const;

  static constexpr size_t kBand = 8;  // rows that are interleaved
  // Of each cell g, from the start, and the weight, with a border of walls.
  std::vector<uint32_t> nodes_;
  size_t band_ = 0;                             // nodes of kBand rows
  std::vector<std::vector<uint32_t>> buckets_;  // x and y, 16 bits each
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_GRID_SEARCH_H_
