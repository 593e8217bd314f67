// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

namespace cartographer_ext {
namespace scan_matching {
namespace {

constexpr int kMargin = kBlockSize - 1;
constexpr size_t kMostEqual = 64;
// 16 bits hold the values of so many points, in whole bytes' worth.
constexpr int kPointsPerWord =
    65535 / (CoarseMaxima::kMaxValue * CoarseMaxima::kNumPerByte) *
    CoarseMaxima::kNumPerByte;
constexpr int kPointsPerSquareSum = 257;
constexpr int kMostPoints = 1 << 22;
constexpr int64_t kMostCoarseNodes = int64_t{1} << 28;
constexpr int kLargestHalfGroup = 31;

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

PreparedGrid::PreparedGrid(const SearchGrid2D& grid, const int depth_in,
                           const SearchKernels& search_kernels)
    : kernels(search_kernels),
      min_score(grid.min_score),
      max_score(grid.max_score),
      depth(depth_in) {
  geometry.num_x = grid.num_x;
  geometry.num_y = grid.num_y;
  geometry.resolution = grid.resolution;
  geometry.max_x = grid.max_x;
  geometry.max_y = grid.max_y;
  const SquareMaxima single = CellMaxima(grid.values, grid.num_x, grid.num_y);
  blocks = Widen(Widen(Widen(single, 1), 2), 4);
  coarse[0] = CoarseMaxima(Widen(blocks, 2 * kReaches[0]));
  coarse[1] = CoarseMaxima(Widen(blocks, 2 * kReaches[1]));
  padded_stride = grid.num_x + 2 * kMargin;
  padded.resize(static_cast<size_t>(padded_stride) *
                (grid.num_y + 2 * kMargin));
  for (int y = 0; y != grid.num_y; ++y) {
    const auto row = grid.values.begin() + static_cast<size_t>(y) * grid.num_x;
    std::copy(row, row + grid.num_x,
              padded.begin() +
                  static_cast<size_t>(y + kMargin) * padded_stride + kMargin);
  }
}

SquareMaxima PreparedGrid::Cells() const {
  std::vector<uint8_t> values;
  values.reserve(static_cast<size_t>(geometry.num_x) * geometry.num_y);
  for (int y = 0; y != geometry.num_y; ++y) {
    const auto row = padded.begin() +
                     static_cast<size_t>(y + kMargin) * padded_stride + kMargin;
    values.insert(values.end(), row, row + geometry.num_x);
  }
  return CellMaxima(values, geometry.num_x, geometry.num_y);
}

size_t PreparedGrid::MemoryBytes() const {
  size_t bytes = sizeof(*this) + blocks.values.capacity() + padded.capacity();
  for (const CoarseMaxima& maxima : coarse) bytes += maxima.MemoryBytes();
  return bytes;
}

BudgetMeter::BudgetMeter(const SearchBudget& budget) : budget_(budget) {
  if (budget_.max_seconds > 0.) start_seconds_ = Seconds();
}

bool BudgetMeter::Spend(const int64_t candidates) {
  spent_ += candidates;
  if (budget_.max_candidates > 0 && spent_ > budget_.max_candidates) {
    used_up_ = true;
  }
  if (budget_.max_seconds > 0. && --calls_until_clock_ <= 0) {
    calls_until_clock_ = 32;
    if (Seconds() - start_seconds_ > budget_.max_seconds) used_up_ = true;
  }
  return !used_up_;
}

CorrelativeSearchRun::CorrelativeSearchRun(const PreparedGrid& grid,
                                           const PlanarCloud& cloud,
                                           const Pose2& initial,
                                           const SearchWindow& window,
                                           const float min_score)
    : grid_(grid),
      scans_(cloud, initial, window.linear, window.angular, grid.geometry,
             grid.kernels) {
  if (!scans_.valid() || cloud.size() > kMostPoints) {
    complete_ = false;
    return;
  }
  threshold_ = LargestSumNotAbove(min_score);
  ChooseGroups();
  if (!ScoreCoarseNodes()) {
    complete_ = false;
    coarse_.clear();
    return;
  }
  SortCoarse();
  statistics_.rejected_early = coarse_.empty();
}

// By bisection, as rounding decides. A minimum that is NaN is never exceeded.
int CorrelativeSearchRun::LargestSumNotAbove(const float score) const {
  const float num_points = static_cast<float>(scans_.num_points());
  int low = -1;
  int high = 255 * scans_.num_points() + 1;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    const bool above =
        grid_.ToScore(static_cast<float>(middle) / num_points) > score;
    (above ? high : low) = middle;
  }
  return low;
}

int CorrelativeSearchRun::SmallestSumOfScore(const float score) const {
  const float num_points = static_cast<float>(scans_.num_points());
  int low = -1;
  int high = 255 * scans_.num_points() + 1;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    const bool enough =
        grid_.ToScore(static_cast<float>(middle) / num_points) >= score;
    (enough ? high : low) = middle;
  }
  return high;
}

// As many rotations in a group as the largest reach allows: between rotations k
// steps apart a point moves by at most `way` = k CellsPerStep + RoundingCells
// cells, hence its index by at most ceil(way).
void CorrelativeSearchRun::ChooseGroups() {
  const int num_points = scans_.num_points();
  const double rounding = scans_.RoundingCells();
  std::vector<double> way(num_points);
  double longest = 0.;
  for (int i = 0; i != num_points; ++i) {
    way[i] = scans_.CellsPerStep(i);
    longest = std::max(longest, way[i]);
  }
  const int reach = kReaches[kNumReaches - 1];
  while (half_group_ < kLargestHalfGroup &&
         (half_group_ + 1) * longest + rounding <= reach) {
    ++half_group_;
  }
  level_of_point_.resize(num_points);
  for (int i = 0; i != num_points; ++i) {
    const double moved =
        half_group_ == 0 ? 0. : half_group_ * way[i] + rounding;
    int level = 0;
    while (level + 1 < kNumReaches && moved > kReaches[level]) ++level;
    level_of_point_[i] = level;
  }
}

bool CorrelativeSearchRun::ScoreCoarseNodes() {
  group_x_.resize(scans_.num_points());
  group_y_.resize(scans_.num_points());
  const int group_size = 2 * half_group_ + 1;
  for (int group = 0; group * group_size < scans_.num_rotations(); ++group) {
    ScoreGroup(group);
    if (statistics_.coarse_scored > kMostCoarseNodes) return false;
  }
  return true;
}

void CorrelativeSearchRun::ScoreGroup(const int group) {
  const int num_points = scans_.num_points();
  const int first = group * (2 * half_group_ + 1);
  const int last =
      std::min(first + 2 * half_group_, scans_.num_rotations() - 1);
  scans_.FindCells((first + last) / 2, group_x_.data(), group_y_.data());
  // Of all rotations of the group.
  OffsetBounds cells = scans_.CellBounds(group_x_.data(), group_y_.data());
  const int reach = half_group_ == 0 ? 0 : kReaches[kNumReaches - 1];
  cells.min_x -= reach;
  cells.max_x += reach;
  cells.min_y -= reach;
  cells.max_y += reach;
  const OffsetBounds bounds = scans_.BoundsFor(cells);
  const int64_t width = bounds.max_x - bounds.min_x + 1;
  const int64_t height = bounds.max_y - bounds.min_y + 1;
  const int num_x = static_cast<int>((width + kBlockSize - 1) / kBlockSize);
  const int num_y = static_cast<int>((height + kBlockSize - 1) / kBlockSize);
  const int64_t num_nodes = static_cast<int64_t>(num_x) * num_y;
  statistics_.num_poses += width * height * (last - first + 1);
  statistics_.coarse_scored += num_nodes;
  if (statistics_.coarse_scored > kMostCoarseNodes) return;

  const size_t size = (static_cast<size_t>(num_nodes) + 15) / 16 * 16;
  byte_sums_.assign(size + 32, 0);
  word_sums_.assign(size, 0);
  wide_sums_.assign(size, 0);
  for (int begin = 0; begin < num_points; begin += kPointsPerWord) {
    const int end = std::min(begin + kPointsPerWord, num_points);
    for (int i = begin; i != end; ++i) {
      if (i != begin && (i - begin) % CoarseMaxima::kNumPerByte == 0) {
        grid_.kernels.move_sums(static_cast<int>(size), byte_sums_.data(),
                                word_sums_.data());
      }
      const int level = level_of_point_[i];
      const CoarseMaxima& maxima = grid_.coarse[level];
      // The first element: width - 1 from the border, reach cells before.
      const int shift = maxima.width() - 1 - kReaches[level];
      const int column = group_x_[i] + bounds.min_x + shift;
      const int row = group_y_[i] + bounds.min_y + shift;
      const int x = column >> 3;
      const int y = row >> 3;
      const int x_begin = std::max(0, -x);
      const int x_end = std::min(num_x, maxima.num_columns() - x);
      const int y_begin = std::max(0, -y);
      const int y_end = std::min(num_y, maxima.num_rows() - y);
      if (x_begin >= x_end || y_begin >= y_end) continue;
      grid_.kernels.add_rows(
          maxima.Plane(column, row) +
              static_cast<size_t>(y + y_begin) * maxima.num_columns() + x +
              x_begin,
          maxima.num_columns(), x_end - x_begin, y_end - y_begin,
          byte_sums_.data() + static_cast<size_t>(y_begin) * num_x + x_begin,
          num_x);
    }
    grid_.kernels.move_sums(static_cast<int>(size), byte_sums_.data(),
                            word_sums_.data());
    for (size_t k = 0; k != size; ++k) {
      wide_sums_[k] += word_sums_[k];
      word_sums_[k] = 0;
    }
  }
  CollectCoarse(group, bounds, num_x, num_y);
}

void CorrelativeSearchRun::CollectCoarse(const int group,
                                         const OffsetBounds& bounds,
                                         const int num_x, const int num_y) {
  // Smallest sum in coarse steps that allows for more than the threshold.
  const int64_t scaled =
      (static_cast<int64_t>(threshold_) + 1) * CoarseMaxima::kMaxValue;
  const int needed = static_cast<int>((scaled + 254) / 255);
  const int32_t* sum = wide_sums_.data();
  for (int y = 0; y != num_y; ++y) {
    for (int x = 0; x != num_x; ++x, ++sum) {
      if (*sum < needed) continue;
      coarse_.push_back(CoarseNode{*sum, group, bounds.min_x + kBlockSize * x,
                                   bounds.min_y + kBlockSize * y});
    }
  }
}

// By counting, the largest sums first, else in the order of scoring.
void CorrelativeSearchRun::SortCoarse() {
  const int largest = CoarseMaxima::kMaxValue * scans_.num_points();
  std::vector<uint32_t> places(largest + 2, 0);
  for (const CoarseNode& node : coarse_) ++places[largest - node.sum + 1];
  for (size_t i = 1; i < places.size(); ++i) places[i] += places[i - 1];
  std::vector<CoarseNode> sorted(coarse_.size());
  for (const CoarseNode& node : coarse_) {
    sorted[places[largest - node.sum]++] = node;
  }
  coarse_.swap(sorted);
}

int CorrelativeSearchRun::CoarseBound() const {
  if (next_coarse_ == coarse_.size()) return -1;
  return static_cast<int>(static_cast<int64_t>(coarse_[next_coarse_].sum) *
                          255 / CoarseMaxima::kMaxValue);
}

int CorrelativeSearchRun::BlockBound() const {
  return blocks_.empty() ? -1 : blocks_.front().sum;
}

int CorrelativeSearchRun::BestBound() const {
  return std::max(CoarseBound(), BlockBound());
}

int CorrelativeSearchRun::Needed() const {
  if (best_.empty()) return threshold_ + 1;
  return too_many_equal_ ? best_sum_ + 1 : best_sum_;
}

bool CorrelativeSearchRun::done() const { return BestBound() < Needed(); }

float CorrelativeSearchRun::UpperBound() const {
  if (!scans_.valid()) return grid_.max_score;
  const int sum = std::max(BestBound(), best_.empty() ? threshold_ : best_sum_);
  return grid_.ToScore(static_cast<float>(std::max(0, sum)) /
                       static_cast<float>(scans_.num_points()));
}

void CorrelativeSearchRun::Run(const float score, BudgetMeter* const meter) {
  if (!complete_) return;
  const int stop = SmallestSumOfScore(score);
  while (true) {
    const int coarse_bound = CoarseBound();
    const int block_bound = BlockBound();
    const int bound = std::max(coarse_bound, block_bound);
    if (bound < Needed() || bound < stop) return;
    if (meter->used_up()) {
      complete_ = false;
      return;
    }
    if (block_bound >= coarse_bound) {
      const Block block = blocks_.front();
      std::pop_heap(blocks_.begin(), blocks_.end(), &Worse);
      blocks_.pop_back();
      OpenBlock(block);
      meter->Spend(kBlockSize * kBlockSize);
    } else {
      OpenCoarse(coarse_[next_coarse_++]);
      meter->Spend(2 * half_group_ + 1);
    }
  }
}

void CorrelativeSearchRun::OpenCoarse(const CoarseNode& node) {
  const int first = node.group * (2 * half_group_ + 1);
  const int last =
      std::min(first + 2 * half_group_, scans_.num_rotations() - 1);
  const int needed = Needed();
  for (int rotation = first; rotation <= last; ++rotation) {
    const RotatedScan& scan = scans_.Get(rotation);
    if (node.x > scan.offsets.max_x || node.y > scan.offsets.max_y ||
        node.x + kMargin < scan.offsets.min_x ||
        node.y + kMargin < scan.offsets.min_y) {
      continue;
    }
    ++statistics_.blocks_scored;
    const int sum = BlockSum(scan, node.x, node.y);
    if (sum < needed) continue;
    blocks_.push_back(Block{sum, rotation, node.x, node.y});
    std::push_heap(blocks_.begin(), blocks_.end(), &Worse);
  }
}

bool CorrelativeSearchRun::Worse(const Block& a, const Block& b) {
  if (a.sum != b.sum) return a.sum < b.sum;
  return std::tie(a.rotation, a.x, a.y) > std::tie(b.rotation, b.x, b.y);
}

int CorrelativeSearchRun::BlockSum(const RotatedScan& scan, const int x,
                                   const int y) const {
  const SquareMaxima& blocks = grid_.blocks;
  const int num_points = scans_.num_points();
  const int x_shift = x + kMargin;
  const int y_shift = y + kMargin;
  const unsigned num_x = blocks.num_x;
  const unsigned num_y = blocks.num_y;
  const uint8_t* const values = blocks.values.data();
  int sum = 0;
  for (int i = 0; i != num_points; ++i) {
    const unsigned column = scan.x[i] + x_shift;
    const unsigned row = scan.y[i] + y_shift;
    if (column < num_x && row < num_y) sum += values[row * num_x + column];
  }
  return sum;
}

void CorrelativeSearchRun::OpenBlock(const Block& block) {
  ++statistics_.blocks_opened;
  const RotatedScan& scan = scans_.Get(block.rotation);
  const int num_points = scans_.num_points();
  const int x_shift = block.x + kMargin;
  const int y_shift = block.y + kMargin;
  const unsigned num_x = grid_.blocks.num_x;
  const unsigned num_y = grid_.blocks.num_y;
  places_.resize(kPointsPerSquareSum + 1);
  int32_t sums[kBlockSize * kBlockSize] = {};
  for (int begin = 0; begin < num_points; begin += kPointsPerSquareSum) {
    const int end = std::min(begin + kPointsPerSquareSum, num_points);
    int count = 0;
    for (int i = begin; i != end; ++i) {
      const unsigned column = scan.x[i] + x_shift;
      const unsigned row = scan.y[i] + y_shift;
      places_[count] = static_cast<int32_t>(row * grid_.padded_stride + column);
      count += column < num_x && row < num_y;
    }
    uint16_t words[kBlockSize * kBlockSize] = {};
    grid_.kernels.add_squares(grid_.padded.data(), grid_.padded_stride,
                              places_.data(), count, words);
    for (int k = 0; k != kBlockSize * kBlockSize; ++k) sums[k] += words[k];
  }
  for (int k = 0; k != kBlockSize * kBlockSize; ++k) {
    if (sums[k] < Needed()) continue;
    const int x = block.x + k % kBlockSize;
    const int y = block.y + k / kBlockSize;
    if (scan.offsets.Contains(x, y)) TakePose(sums[k], block.rotation, x, y);
  }
}

void CorrelativeSearchRun::TakePose(const int sum, const int rotation,
                                    const int x, const int y) {
  if (sum > best_sum_) {
    best_.clear();
    best_sum_ = sum;
    too_many_equal_ = false;
  }
  if (best_.size() == kMostEqual) {
    too_many_equal_ = true;
    return;
  }
  DiscretePose pose;
  pose.rotation = rotation;
  pose.x = x;
  pose.y = y;
  best_.push_back(pose);
}

SearchResult CorrelativeSearchRun::Result() {
  SearchResult result;
  result.found = !best_.empty();
  result.complete = complete_ && done();
  result.upper_bound = UpperBound();
  statistics_.coarse_pruned =
      statistics_.coarse_scored - static_cast<int64_t>(next_coarse_);
  statistics_.blocks_pruned =
      statistics_.blocks_scored - statistics_.blocks_opened;
  result.statistics = statistics_;
  if (!result.found) return result;
  DiscretePose pose = best_.front();
  if (result.complete && best_.size() > 1) {
    const SquareMaxima cells = grid_.Cells();
    const EqualScores equal(cells, grid_.blocks, grid_.depth, &scans_);
    pose = too_many_equal_ ? equal.FirstOfAll(best_sum_) : equal.First(best_);
  }
  result.score = grid_.ToScore(static_cast<float>(best_sum_) /
                               static_cast<float>(scans_.num_points()));
  result.pose = scans_.PoseOf(pose.rotation, pose.x, pose.y);
  return result;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
