// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/grid_search.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>

#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr int kDx[8] = {1, -1, 0, 0, 1, 1, -1, -1};
constexpr int kDy[8] = {0, 0, 1, -1, 1, -1, 1, -1};
// Costs of cells that cannot be entered, of the start and of what is not
// reached: no cost is less than a wall's.
constexpr uint32_t kWall = 0;
constexpr uint32_t kStart = 1;
constexpr uint32_t kUnreached = std::numeric_limits<uint32_t>::max();
// A step raises f by at most kDiagonalStep (kMaxWeight + kMinWeight) = 476.
constexpr uint32_t kNumBuckets = 512;
static_assert(kDiagonalStep * (kMaxWeight + kMinWeight) < kNumBuckets,
              "the ring of buckets must be longer than any step");
constexpr int kMaxSide = 65534;  // two coordinates make one entry

uint32_t Heuristic(const int x, const int y, const Cell& goal) {
  const uint32_t dx = std::abs(x - goal.x), dy = std::abs(y - goal.y);
  return kMinWeight * (kStraightStep * std::max(dx, dy) +
                       (kDiagonalStep - kStraightStep) * std::min(dx, dy));
}

uint32_t Entry(const int x, const int y) {
  return static_cast<uint32_t>(y) << 16 | static_cast<uint32_t>(x);
}

}  // namespace

void GridSearch::Reset(const WeightGrid& grid) {
  const size_t width = grid.width, height = grid.height;
  CHECK_EQ(grid.weights.size(), width * height);
  CHECK_LE(std::max(grid.width, grid.height), kMaxSide);
  stride_ = grid.width + 2;
  cost_.assign(stride_ * (height + 2), kWall);
  for (size_t y = 0; y != height; ++y) {
    const uint8_t* const weights = grid.weights.data() + y * width;
    uint32_t* const costs = cost_.data() + Index(0, y);
    for (size_t x = 0; x != width; ++x) {
      costs[x] = weights[x] == kBlocked ? kWall : kUnreached;
    }
  }
  buckets_.resize(kNumBuckets);
  for (auto& bucket : buckets_) bucket.clear();
}

GridPath GridSearch::Search(const WeightGrid& grid, const Cell& start,
                            const Cell& goal) {
  GridPath path;
  if (!grid.Contains(start) || !grid.Contains(goal) ||
      grid.at(start) == kBlocked || grid.at(goal) == kBlocked) {
    return path;
  }
  Reset(grid);
  // Of the neighbours in the padded costs and in the weights.
  std::ptrdiff_t offsets[8], weight_offsets[8];
  for (int step = 0; step != 8; ++step) {
    offsets[step] =
        kDy[step] * static_cast<std::ptrdiff_t>(stride_) + kDx[step];
    weight_offsets[step] =
        kDy[step] * static_cast<std::ptrdiff_t>(grid.width) + kDx[step];
  }
  cost_[Index(start.x, start.y)] = kStart;
  uint32_t key = kStart + Heuristic(start.x, start.y, goal);
  buckets_[key % kNumBuckets].push_back(Entry(start.x, start.y));
  int64_t open = 1;
  while (open > 0) {
    auto& bucket = buckets_[key % kNumBuckets];
    if (bucket.empty()) {
      ++key;
      continue;
    }
    const uint32_t entry = bucket.back();
    bucket.pop_back();
    --open;
    const int x = entry & 0xffff, y = entry >> 16;
    uint32_t* const here = cost_.data() + Index(x, y);
    const uint32_t cost = *here;
    // It was found again, nearer to the start, and is expanded already.
    if (cost + Heuristic(x, y, goal) != key) continue;
    ++path.expanded;
    if (x == goal.x && y == goal.y) {
      path.found = true;
      break;
    }
    // Stops rather than wraps around on absurdly long paths.
    if (cost > kUnreached / 2) continue;
    const uint8_t* const weights =
        grid.weights.data() + static_cast<size_t>(y) * grid.width + x;
    const auto relax = [&](const int step, const uint32_t length) {
      uint32_t& next = here[offsets[step]];
      // Walls and cells that are expanded end here.
      if (next <= cost + kMinWeight * length) return;
      const uint32_t next_cost = cost + weights[weight_offsets[step]] * length;
      if (next_cost >= next) return;
      next = next_cost;
      const int next_x = x + kDx[step], next_y = y + kDy[step];
      buckets_[(next_cost + Heuristic(next_x, next_y, goal)) % kNumBuckets]
          .push_back(Entry(next_x, next_y));
      ++open;
    };
    // Whether the straight neighbours can be entered: right, left, up, down.
    const bool right = here[offsets[0]] != kWall;
    const bool left = here[offsets[1]] != kWall;
    const bool up = here[offsets[2]] != kWall;
    const bool down = here[offsets[3]] != kWall;
    for (int step = 0; step != 4; ++step) relax(step, kStraightStep);
    if (right && up) relax(4, kDiagonalStep);
    if (right && down) relax(5, kDiagonalStep);
    if (left && up) relax(6, kDiagonalStep);
    if (left && down) relax(7, kDiagonalStep);
  }
  if (!path.found) return path;
  path.cost = cost_[Index(goal.x, goal.y)] - kStart;
  path.cells = PathTo(grid, goal, start);
  return path;
}

std::vector<Cell> GridSearch::PathTo(const WeightGrid& grid, const Cell& goal,
                                     const Cell& start) const {
  std::vector<Cell> cells = {goal};
  while (cells.back() != start) {
    const Cell to = cells.back();
    const uint32_t cost = cost_[Index(to.x, to.y)];
    for (int step = 0; step != 8; ++step) {
      const Cell from{to.x - kDx[step], to.y - kDy[step]};
      const uint32_t before = cost_[Index(from.x, from.y)];
      const uint32_t length = step < 4 ? kStraightStep : kDiagonalStep;
      if (before == kWall || before == kUnreached ||
          before + grid.at(to) * length != cost ||
          cost_[Index(from.x, to.y)] == kWall ||
          cost_[Index(to.x, from.y)] == kWall) {
        continue;
      }
      cells.push_back(from);
      break;
    }
  }
  std::reverse(cells.begin(), cells.end());
  return cells;
}

}  // namespace navigation
}  // namespace cartographer_ext
