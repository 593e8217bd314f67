// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/grid_search.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr int kDx[8] = {1, -1, 0, 0, 1, 1, -1, -1};
constexpr int kDy[8] = {0, 0, 1, -1, 1, -1, 1, -1};
// A node is (g << kWeightBits | weight). A cell that cannot be entered has the
// node 0, so that no cost is less than its g; a cell that has not been reached
// has the greatest g.
constexpr uint32_t kWeightBits = 7;
constexpr uint32_t kWeightMask = (1u << kWeightBits) - 1;
constexpr uint32_t kWall = 0;
constexpr uint32_t kUnreached = ~kWeightMask;
constexpr uint32_t kStart = 1;  // g of the start
static_assert(kMaxWeight <= kWeightMask, "a weight must fit into a node");
static_assert(GridSearch::kMaxCost + kStart + kDiagonalStep * kMaxWeight <
                  kUnreached >> kWeightBits,
              "a cost must fit into a node");
// A step raises f by at most kDiagonalStep (kMaxWeight + kMinWeight) = 476.
constexpr uint32_t kNumBuckets = 512;
static_assert(kDiagonalStep * (kMaxWeight + kMinWeight) < kNumBuckets,
              "the ring of buckets must be longer than any step");
constexpr int kMaxSide = 65534;  // two coordinates make one entry
constexpr size_t kAhead = 8;     // entries between prefetching and expanding

// The heuristic without std::max, whose branch would be mispredicted: with the
// sum s and the absolute difference d of dx and dy, 2 max = s + d and 2 min = s
// - d.
uint32_t Heuristic(const int x, const int y, const Cell& goal) {
  const int dx = std::abs(x - goal.x), dy = std::abs(y - goal.y);
  const uint32_t sum = dx + dy, difference = std::abs(dx - dy);
  static_assert(kMinWeight % 2 == 0, "half of it is an integer");
  return kMinWeight / 2 *
         (kDiagonalStep * sum +
          (2 * kStraightStep - kDiagonalStep) * difference);
}

uint32_t Entry(const int x, const int y) {
  return static_cast<uint32_t>(y) << 16 | static_cast<uint32_t>(x);
}

void Prefetch(const uint32_t* const address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  static_cast<void>(address);
#endif
}

}  // namespace

void GridSearch::Reset(const WeightGrid& grid) {
  const size_t width = grid.width, height = grid.height;
  CHECK_EQ(grid.weights.size(), width * height);
  CHECK_LE(std::max(grid.width, grid.height), kMaxSide);
  band_ = (width + 2) * kBand;
  nodes_.assign((height + 2 + kBand - 1) / kBand * band_, kWall);
  for (size_t y = 0; y != height; ++y) {
    const uint8_t* const weights = grid.weights.data() + y * width;
    uint32_t* const nodes = nodes_.data() + Index(0, y);
    for (size_t x = 0; x != width; ++x) {
      nodes[x * kBand] =
          weights[x] == kBlocked ? kWall : kUnreached | weights[x];
    }
  }
  buckets_.resize(kNumBuckets);
  for (auto& bucket : buckets_) bucket.clear();
}

std::ptrdiff_t GridSearch::StepUp(const int y) const {
  return static_cast<size_t>(y + 2) % kBand == 0 ? band_ - kBand + 1 : 1;
}

std::ptrdiff_t GridSearch::StepDown(const int y) const {
  return -StepUp(y - 1);
}

void GridSearch::PrefetchAround(const uint32_t entry) const {
  const int y = entry >> 16;
  const uint32_t* const node = nodes_.data() + Index(entry & 0xffff, y);
  const std::ptrdiff_t right = kBand, up = StepUp(y), down = StepDown(y);
  Prefetch(node + up + right);
  Prefetch(node + up - right);
  Prefetch(node + down + right);
  Prefetch(node + down - right);
}

GridPath GridSearch::Search(const WeightGrid& grid, const Cell& start,
                            const Cell& goal) {
  GridPath path;
  if (!grid.Contains(start) || !grid.Contains(goal) ||
      grid.at(start) == kBlocked || grid.at(goal) == kBlocked) {
    return path;
  }
  Reset(grid);
  nodes_[Index(start.x, start.y)] = kStart << kWeightBits | grid.at(start);
  auto* const buckets = buckets_.data();
  uint32_t key = kStart + Heuristic(start.x, start.y, goal);
  buckets[key % kNumBuckets].push_back(Entry(start.x, start.y));
  int64_t open = 1;
  while (open > 0) {
    auto& bucket = buckets[key % kNumBuckets];
    if (bucket.empty()) {
      ++key;
      continue;
    }
    const uint32_t entry = bucket.back();
    bucket.pop_back();
    --open;
    if (bucket.size() >= kAhead) PrefetchAround(*(bucket.end() - kAhead));
    const int x = entry & 0xffff, y = entry >> 16;
    uint32_t* const here = nodes_.data() + Index(x, y);
    const uint32_t cost = *here >> kWeightBits;
    // This entry is outdated: the cell was reached again at a lower cost and
    // has been expanded.
    if (cost + Heuristic(x, y, goal) != key) continue;
    ++path.expanded;
    if (x == goal.x && y == goal.y) {
      path.found = true;
      break;
    }
    if (cost > kMaxCost) continue;
    const std::ptrdiff_t right = kBand, left = -right;
    const std::ptrdiff_t up = StepUp(y), down = StepDown(y);
    const uint32_t base = cost << kWeightBits;
    const auto relax = [&](const std::ptrdiff_t offset, const int dx,
                           const int dy) {
      uint32_t& next = here[offset];
      const uint32_t weight = next & kWeightMask;
      const uint32_t length =
          dx == 0 || dy == 0 ? kStraightStep : kDiagonalStep;
      const uint32_t node = base + weight * (length << kWeightBits | 1);
      // Also skips walls and cells that have been expanded.
      if (node >= next) return;
      next = node;
      const uint32_t next_key =
          (node >> kWeightBits) + Heuristic(x + dx, y + dy, goal);
      buckets[next_key % kNumBuckets].push_back(Entry(x + dx, y + dy));
      ++open;
    };
    relax(right, 1, 0);
    relax(left, -1, 0);
    relax(up, 0, 1);
    relax(down, 0, -1);
    const bool right_free = here[right] != kWall;
    const bool left_free = here[left] != kWall;
    const bool up_free = here[up] != kWall;
    const bool down_free = here[down] != kWall;
    if (right_free && up_free) relax(right + up, 1, 1);
    if (right_free && down_free) relax(right + down, 1, -1);
    if (left_free && up_free) relax(left + up, -1, 1);
    if (left_free && down_free) relax(left + down, -1, -1);
  }
  if (!path.found) return path;
  path.cost = (nodes_[Index(goal.x, goal.y)] >> kWeightBits) - kStart;
  path.cells = PathTo(goal, start);
  return path;
}

std::vector<Cell> GridSearch::PathTo(const Cell& goal,
                                     const Cell& start) const {
  std::vector<Cell> cells = {goal};
  while (cells.back() != start) {
    const Cell to = cells.back();
    const uint32_t node = nodes_[Index(to.x, to.y)];
    for (int step = 0; step != 8; ++step) {
      const Cell from{to.x - kDx[step], to.y - kDy[step]};
      const uint32_t before = nodes_[Index(from.x, from.y)];
      const uint32_t length = step < 4 ? kStraightStep : kDiagonalStep;
      if (before == kWall || before >= kUnreached ||
          (before >> kWeightBits) + (node & kWeightMask) * length !=
              node >> kWeightBits ||
          nodes_[Index(from.x, to.y)] == kWall ||
          nodes_[Index(to.x, from.y)] == kWall) {
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
