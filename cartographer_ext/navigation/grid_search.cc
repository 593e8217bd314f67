// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/grid_search.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr int kDx[8] = {1, -1, 0, 0, 1, 1, -1, -1};
constexpr int kDy[8] = {0, 0, 1, -1, 1, -1, 1, -1};
// The state of a cell: the step that led to it, and whether it is expanded or
// cannot be.
constexpr uint8_t kClosed = 8;
constexpr uint8_t kWall = 16;
constexpr uint8_t kStepMask = 7;
constexpr uint32_t kUnreached = std::numeric_limits<uint32_t>::max();
// A step raises f by at most kDiagonalStep (kMaxWeight + kMinWeight) = 476.
constexpr uint32_t kNumBuckets = 512;
static_assert(kDiagonalStep * (kMaxWeight + kMinWeight) < kNumBuckets,
              "the ring of buckets must be longer than any step");

uint32_t Heuristic(const int x, const int y, const Cell& goal) {
  const uint32_t dx = std::abs(x - goal.x), dy = std::abs(y - goal.y);
  return kMinWeight * (kStraightStep * std::max(dx, dy) +
                       (kDiagonalStep - kStraightStep) * std::min(dx, dy));
}

}  // namespace

void GridSearch::Reset(const WeightGrid& grid) {
  const size_t size = grid.weights.size();
  CHECK_EQ(size, static_cast<size_t>(grid.width) * grid.height);
  CHECK_LT(size, size_t{kUnreached});
  cost_.assign(size, kUnreached);
  state_.resize(size);
  for (size_t i = 0; i != size; ++i) {
    state_[i] = grid.weights[i] == kBlocked ? kWall : 0;
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
  const int width = grid.width, height = grid.height;
  Reset(grid);
  int offsets[8];
  for (int step = 0; step != 8; ++step) {
    offsets[step] = kDy[step] * width + kDx[step];
  }

  const uint32_t start_index = static_cast<uint32_t>(start.y) * width + start.x;
  const uint32_t goal_index = static_cast<uint32_t>(goal.y) * width + goal.x;
  cost_[start_index] = 0;
  uint32_t key = Heuristic(start.x, start.y, goal);
  buckets_[key % kNumBuckets].push_back(start_index);
  int64_t open = 1;
  while (open > 0) {
    auto& bucket = buckets_[key % kNumBuckets];
    if (bucket.empty()) {
      ++key;
      continue;
    }
    const uint32_t index = bucket.back();
    bucket.pop_back();
    --open;
    if (state_[index] & kClosed) continue;
    state_[index] |= kClosed;
    ++path.expanded;
    if (index == goal_index) {
      path.found = true;
      break;
    }
    const int y = index / width, x = index - y * width;
    const bool inner = x > 0 && y > 0 && x < width - 1 && y < height - 1;
    const uint32_t cost = cost_[index];
    // Stops rather than wraps around on absurdly long paths.
    if (cost > kUnreached / 2) continue;
    // Whether the straight neighbours can be entered: right, left, up, down.
    bool passable[4];
    for (int step = 0; step != 8; ++step) {
      const bool inside =
          inner || grid.Contains({x + kDx[step], y + kDy[step]});
      const uint32_t next = index + offsets[step];
      const uint8_t state = inside ? state_[next] : kWall;
      if (step < 4) {
        passable[step] = !(state & kWall);
      } else if (!passable[kDx[step] > 0 ? 0 : 1] ||
                 !passable[kDy[step] > 0 ? 2 : 3]) {
        continue;
      }
      if (state & (kWall | kClosed)) continue;
      const uint32_t next_cost =
          cost +
          grid.weights[next] * (step < 4 ? kStraightStep : kDiagonalStep);
      if (next_cost >= cost_[next]) continue;
      cost_[next] = next_cost;
      state_[next] = static_cast<uint8_t>(step);
      const uint32_t next_key =
          next_cost + Heuristic(x + kDx[step], y + kDy[step], goal);
      buckets_[next_key % kNumBuckets].push_back(next);
      ++open;
    }
  }
  if (!path.found) return path;
  path.cost = cost_[goal_index];
  path.cells = PathTo(goal, start, width);
  return path;
}

std::vector<Cell> GridSearch::PathTo(const Cell& goal, const Cell& start,
                                     const int width) const {
  std::vector<Cell> cells = {goal};
  while (cells.back() != start) {
    const Cell& cell = cells.back();
    const int step =
        state_[static_cast<size_t>(cell.y) * width + cell.x] & kStepMask;
    cells.push_back({cell.x - kDx[step], cell.y - kDy[step]});
  }
  std::reverse(cells.begin(), cells.end());
  return cells;
}

}  // namespace navigation
}  // namespace cartographer_ext
