// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/equal_scores.h"

#include <algorithm>
#include <tuple>

namespace cartographer_ext {
namespace scan_matching {
namespace {

// The largest value of a square of 2^level cells.
int LargestInSquare(const RectangleMaxima& cells, const RectangleMaxima& blocks,
                    const int x, const int y, const int level) {
  const bool use_blocks = (1 << level) >= kBlockSize;
  const RectangleMaxima& maxima = use_blocks ? blocks : cells;
  const int step = maxima.width;
  // Clips the square to the cells that have maxima.
  const int num_x = maxima.num_x - maxima.width + 1;
  const int num_y = maxima.num_y - maxima.height + 1;
  const int x_end = std::min(x + (1 << level), num_x);
  const int y_end = std::min(y + (1 << level), num_y);
  const auto first = [step](const int begin) {
    return begin > -step ? begin : begin + (-begin / step) * step;
  };
  int largest = 0;
  for (int j = first(y); j < y_end; j += step) {
    for (int i = first(x); i < x_end; i += step) {
      largest = std::max(largest, maxima.Value(i, j));
    }
  }
  return largest;
}

}  // namespace

EqualScores::EqualScores(const RectangleMaxima& cells,
                         const RectangleMaxima& blocks, const int depth,
                         RotatedScans* const scans)
    : cells_(cells),
      blocks_(blocks),
      top_level_(std::min(16, std::max(1, depth)) - 1),
      scans_(scans) {}

bool EqualScores::Before(const Square& a, const Square& b) {
  return std::make_tuple(-a.sum, a.pose.rotation, a.pose.x, a.pose.y) <
         std::make_tuple(-b.sum, b.pose.rotation, b.pose.x, b.pose.y);
}

DiscretePose EqualScores::First(const std::vector<DiscretePose>& poses) const {
  DiscretePose first = poses.front();
  for (size_t i = 1; i < poses.size(); ++i) {
    if (MeetsFirst(poses[i], first)) first = poses[i];
  }
  return first;
}

bool EqualScores::MeetsFirst(const DiscretePose& a,
                             const DiscretePose& b) const {
  for (int level = top_level_; level >= 0; --level) {
    const Square square_a = Ancestor(a, level);
    const Square square_b = Ancestor(b, level);
    if (Before(square_a, square_b)) return true;
    if (Before(square_b, square_a)) return false;
  }
  return false;  // the same pose
}

EqualScores::Square EqualScores::Ancestor(const DiscretePose& pose,
                                          const int level) const {
  const OffsetBounds& bounds = scans_->Get(pose.rotation).offsets;
  Square square;
  square.pose.rotation = pose.rotation;
  square.pose.x = bounds.min_x + ((pose.x - bounds.min_x) >> level << level);
  square.pose.y = bounds.min_y + ((pose.y - bounds.min_y) >> level << level);
  square.sum = Bound(square.pose, level);
  return square;
}

int EqualScores::Bound(const DiscretePose& pose, const int level) const {
  const RotatedScan& scan = scans_->Get(pose.rotation);
  int sum = 0;
  for (int i = 0; i != scans_->num_points(); ++i) {
    sum += LargestInSquare(cells_, blocks_, scan.x[i] + pose.x,
                           scan.y[i] + pose.y, level);
  }
  return sum;
}

int EqualScores::Sum(const RectangleMaxima& maxima,
                     const DiscretePose& pose) const {
  const RotatedScan& scan = scans_->Get(pose.rotation);
  int sum = 0;
  for (int i = 0; i != scans_->num_points(); ++i) {
    sum += maxima.Value(scan.x[i] + pose.x, scan.y[i] + pose.y);
  }
  return sum;
}

DiscretePose EqualScores::FirstOfAll(const int sum) const {
  std::vector<RectangleMaxima> levels = {cells_};
  while (static_cast<int>(levels.size()) <= top_level_) {
    levels.push_back(
        Widen(levels.back(), levels.back().width, levels.back().height));
  }
  const int step = 1 << top_level_;
  std::vector<Square> squares;
  for (int rotation = 0; rotation != scans_->num_rotations(); ++rotation) {
    const OffsetBounds bounds = scans_->Get(rotation).offsets;
    Square square;
    square.pose.rotation = rotation;
    for (int x = bounds.min_x; x <= bounds.max_x; x += step) {
      for (int y = bounds.min_y; y <= bounds.max_y; y += step) {
        square.pose.x = x;
        square.pose.y = y;
        square.sum = Sum(levels.back(), square.pose);
        if (square.sum >= sum) squares.push_back(square);
      }
    }
  }
  std::sort(squares.begin(), squares.end(), &EqualScores::Before);
  DiscretePose found;
  for (const Square& square : squares) {
    if (Descend(levels, square, top_level_, sum, &found)) break;
  }
  return found;
}

bool EqualScores::Descend(const std::vector<RectangleMaxima>& levels,
                          const Square& square, const int level, const int sum,
                          DiscretePose* const found) const {
  if (level == 0) {
    *found = square.pose;
    return true;
  }
  const OffsetBounds& bounds = scans_->Get(square.pose.rotation).offsets;
  const int half = 1 << (level - 1);
  std::vector<Square> children;
  for (const int x : {square.pose.x, square.pose.x + half}) {
    for (const int y : {square.pose.y, square.pose.y + half}) {
      if (!bounds.Contains(x, y)) continue;
      Square child;
      child.pose.rotation = square.pose.rotation;
      child.pose.x = x;
      child.pose.y = y;
      child.sum = Sum(levels[level - 1], child.pose);
      if (child.sum >= sum) children.push_back(child);
    }
  }
  std::sort(children.begin(), children.end(), &EqualScores::Before);
  for (const Square& child : children) {
    if (Descend(levels, child, level - 1, sum, found)) return true;
  }
  return false;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
