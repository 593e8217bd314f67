// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/coarse_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cartographer_ext {
namespace scan_matching {
namespace {

// The values of this many points fit into 16 bits; a multiple of the number
// that fits into a byte.
constexpr int kPointsPerWord =
    65535 / (CoarseMaxima::kMaxValue * CoarseMaxima::kNumPerByte) *
    CoarseMaxima::kNumPerByte;
constexpr int64_t kMostCoarseNodes = int64_t{1} << 28;
constexpr int kLargestHalfGroup = 31;
constexpr int64_t kLargeWindow = 400 * 400;  // offsets

}  // namespace

CoarseSearch::CoarseSearch(const PreparedGrid& grid, RotatedScans* const scans,
                           const int threshold)
    : grid_(grid), scans_(*scans), threshold_(threshold) {
  ChooseGroups();
}

// In steps of CoarseMaxima to values, as an upper bound of a sum of integers.
int CoarseSearch::ToSum(const int coarse_sum) {
  return static_cast<int>(static_cast<int64_t>(coarse_sum) * 255 /
                          CoarseMaxima::kMaxValue);
}

// As many rotations in a group as the largest reach allows: between rotations k
// steps apart a point moves by at most d = k CellsPerStep + RoundingCells
// cells, hence its index by at most ceil(d).
void CoarseSearch::ChooseGroups() {
  double longest = 0.;
  for (int i = 0; i != scans_.num_points(); ++i) {
    longest = std::max(longest, scans_.CellsPerStep(i));
  }
  const Reach& reach = kReaches[kNumReaches - 1];
  while (half_group_ < kLargestHalfGroup &&
         (half_group_ + 1) * longest + scans_.RoundingCells() <=
             std::min(reach.x, reach.y)) {
    ++half_group_;
  }
  const double angle = half_group_ * scans_.angular_step() * (1. + 1e-6);
  sine_ = std::sin(angle);
  versine_ = 1. - std::cos(angle);
}

// The reach that a point needs: turned by up to `angle`, the point (x, y) moves
// by at most |y| sin + |x| (1 - cos) along x.
int CoarseSearch::ReachOf(const double x, const double y) const {
  if (half_group_ == 0) return 0;
  const double rounding = scans_.RoundingCells();
  const double move_x = y * sine_ + x * versine_ + rounding;
  const double move_y = x * sine_ + y * versine_ + rounding;
  int i = 0;
  while (i + 1 < kNumReaches &&
         (move_x > kReaches[i].x || move_y > kReaches[i].y)) {
    ++i;
  }
  return i;
}

bool CoarseSearch::Score(SearchStatistics* const statistics,
                         std::vector<CoarseNode>* const nodes) {
  statistics_ = statistics;
  nodes_ = nodes;
  nodes_->clear();
  group_x_.resize(scans_.num_points());
  group_y_.resize(scans_.num_points());
  for (int group = 0; FirstRotation(group) < scans_.num_rotations(); ++group) {
    ScoreGroup(group);
    if (statistics_->coarse_scored > kMostCoarseNodes) return false;
  }
  Sort();
  return true;
}

int CoarseSearch::LastRotation(const int group) const {
  return std::min(FirstRotation(group) + 2 * half_group_,
                  scans_.num_rotations() - 1);
}

void CoarseSearch::ScoreGroup(const int group) {
  const int num_points = scans_.num_points();
  const int first = FirstRotation(group);
  const int last = LastRotation(group);
  scans_.FindCells((first + last) / 2, group_x_.data(), group_y_.data());
  const OffsetBounds bounds = GroupBounds();
  const int64_t width = bounds.max_x - bounds.min_x + 1;
  const int64_t height = bounds.max_y - bounds.min_y + 1;
  if (width <= 0 || height <= 0) return;
  const int num_x = static_cast<int>((width + kBlockSize - 1) / kBlockSize);
  const int num_y = static_cast<int>((height + kBlockSize - 1) / kBlockSize);
  const int64_t num_nodes = static_cast<int64_t>(num_x) * num_y;
  statistics_->num_poses += width * height * (last - first + 1);
  statistics_->coarse_scored += num_nodes;
  if (statistics_->coarse_scored > kMostCoarseNodes) return;

  // Far enough apart that what is written beyond the end of a row does not
  // touch the next one: reading that right away would make the processor wait.
  stride_ = (num_x + 30) / 16 * 16;
  const size_t size = static_cast<size_t>(stride_) * num_y;
  byte_sums_.assign(size + 32, 0);
  word_sums_.assign(size, 0);
  wide_sums_.assign(size, 0);
  for (std::vector<uint16_t>& sums : partial_sums_) sums.assign(size, 0);
  if (num_points <= kPointsPerWord) {
    for (int part = 0; part != RotatedScans::kNumParts; ++part) {
      AddPoints(bounds, num_x, num_y, scans_.PartBegin(part),
                scans_.PartBegin(part + 1));
      if (part != kNumPartialSums) partial_sums_[part] = word_sums_;
    }
    std::copy(word_sums_.begin(), word_sums_.end(), wide_sums_.begin());
  } else {
    // The partial sums stay zero, which is allowed.
    for (int begin = 0; begin < num_points; begin += kPointsPerWord) {
      AddPoints(bounds, num_x, num_y, begin,
                std::min(begin + kPointsPerWord, num_points));
      for (size_t k = 0; k != size; ++k) {
        wide_sums_[k] += word_sums_[k];
        word_sums_[k] = 0;
      }
    }
  }
  Collect(group, bounds, num_x, num_y);
}

// Offsets for any rotation of the group in group_x_, group_y_.
OffsetBounds CoarseSearch::GroupBounds() {
  OffsetBounds cells = scans_.CellBounds(group_x_.data(), group_y_.data());
  if (half_group_ != 0) {
    const Reach& reach = kReaches[kNumReaches - 1];
    cells.min_x -= reach.x;
    cells.max_x += reach.x;
    cells.min_y -= reach.y;
    cells.max_y += reach.y;
  }
  OffsetBounds bounds = scans_.BoundsFor(cells);
  RestrictToKnown(&bounds);
  return bounds;
}

// A sum above the threshold takes at least m = threshold / 255 + 1 points in
// cells that are not 0. So the point that is the m-th from the right must be
// right of the left border of these cells, and so on. May leave nothing.
void CoarseSearch::RestrictToKnown(OffsetBounds* const bounds) {
  const int64_t width = bounds->max_x - bounds->min_x + 1;
  const int64_t height = bounds->max_y - bounds->min_y + 1;
  const int needed = threshold_ / 255 + 1;
  // In a small window, ordering the points would take longer.
  if (width * height < kLargeWindow || threshold_ < 0 ||
      needed > scans_.num_points()) {
    return;
  }
  const OffsetBounds& known = grid_.known;
  const int margin_x = half_group_ == 0 ? 0 : kReaches[kNumReaches - 1].x;
  const int margin_y = half_group_ == 0 ? 0 : kReaches[kNumReaches - 1].y;
  const auto nth = [this](const std::vector<int32_t>& cells, const int n) {
    ordered_ = cells;
    std::nth_element(ordered_.begin(), ordered_.begin() + n, ordered_.end());
    return ordered_[n];
  };
  const int from_end = scans_.num_points() - needed;
  bounds->min_x =
      std::max(bounds->min_x, known.min_x - nth(group_x_, from_end) - margin_x);
  bounds->max_x = std::min(bounds->max_x,
                           known.max_x - nth(group_x_, needed - 1) + margin_x);
  bounds->min_y =
      std::max(bounds->min_y, known.min_y - nth(group_y_, from_end) - margin_y);
  bounds->max_y = std::min(bounds->max_y,
                           known.max_y - nth(group_y_, needed - 1) + margin_y);
}

// Points [begin, end), to word_sums_.
void CoarseSearch::AddPoints(const OffsetBounds& bounds, const int num_x,
                             const int num_y, const int begin, const int end) {
  const double sensor_x = scans_.SensorCellX();
  const double sensor_y = scans_.SensorCellY();
  const int size = static_cast<int>(word_sums_.size());
  int num_added = 0;
  for (int i = begin; i != end; ++i) {
    // Distances from the sensor, with the uncertainty of a cell.
    const int level = ReachOf(std::abs(group_x_[i] - sensor_x) + 1.,
                              std::abs(group_y_[i] - sensor_y) + 1.);
    const CoarseMaxima& maxima = grid_.coarse[level];
    // The first element: width - 1 from the border, reach cells before.
    const int column =
        group_x_[i] + bounds.min_x + maxima.width() - 1 - kReaches[level].x;
    const int row =
        group_y_[i] + bounds.min_y + maxima.height() - 1 - kReaches[level].y;
    const int x = column >> 3;
    const int y = row >> 3;
    const int x_begin = std::max(0, -x);
    const int x_end = std::min(num_x, maxima.num_columns() - x);
    const int y_begin = std::max(0, -y);
    const int y_end = std::min(num_y, maxima.num_rows() - y);
    if (x_begin >= x_end || y_begin >= y_end) continue;
    if (num_added == CoarseMaxima::kNumPerByte) {
      grid_.kernels.move_sums(size, byte_sums_.data(), word_sums_.data());
      num_added = 0;
    }
    ++num_added;
    grid_.kernels.add_rows(
        maxima.Plane(column, row) +
            static_cast<size_t>(y + y_begin) * maxima.num_columns() + x +
            x_begin,
        maxima.num_columns(), x_end - x_begin, y_end - y_begin,
        byte_sums_.data() + static_cast<size_t>(y_begin) * stride_ + x_begin,
        stride_);
  }
  grid_.kernels.move_sums(size, byte_sums_.data(), word_sums_.data());
}

void CoarseSearch::Collect(const int group, const OffsetBounds& bounds,
                           const int num_x, const int num_y) {
  // Smallest sum in coarse steps that allows for more than the threshold.
  const int64_t scaled =
      (static_cast<int64_t>(threshold_) + 1) * CoarseMaxima::kMaxValue;
  const int needed = static_cast<int>((scaled + 254) / 255);
  for (int y = 0; y != num_y; ++y) {
    for (int x = 0; x != num_x; ++x) {
      const int k = y * stride_ + x;
      if (wide_sums_[k] < needed) continue;
      CoarseNode node = {wide_sums_[k],
                         group,
                         bounds.min_x + kBlockSize * x,
                         bounds.min_y + kBlockSize * y,
                         {}};
      for (int part = 0; part != kNumPartialSums; ++part) {
        node.partial_sums[part] = partial_sums_[part][k];
      }
      nodes_->push_back(node);
    }
  }
}

// A counting sort: the largest sums first, equal ones in the order of scoring.
void CoarseSearch::Sort() {
  const int largest = CoarseMaxima::kMaxValue * scans_.num_points();
  std::vector<uint32_t> places(largest + 2, 0);
  for (const CoarseNode& node : *nodes_) ++places[largest - node.sum + 1];
  for (size_t i = 1; i < places.size(); ++i) places[i] += places[i - 1];
  std::vector<CoarseNode> sorted(nodes_->size());
  for (const CoarseNode& node : *nodes_) {
    sorted[places[largest - node.sum]++] = node;
  }
  nodes_->swap(sorted);
}

}  // namespace scan_matching
}  // namespace cartographer_ext
