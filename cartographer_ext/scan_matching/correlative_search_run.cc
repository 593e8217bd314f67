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
constexpr int kMostPoints = 1 << 22;
constexpr int64_t kMostCoarseNodes = int64_t{1} << 28;
constexpr int kLargestHalfGroup = 31;
constexpr int64_t kLargeWindow = 400 * 400;  // offsets

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
  blocks = CellMaxima(grid.values, grid.num_x, grid.num_y);
  for (int width = 1; width != kBlockSize; width *= 2) {
    blocks = Widen(blocks, width, width);
  }
  const RectangleMaxima coarse_blocks = ToCoarse(blocks);
  for (int i = 0; i != kNumReaches; ++i) {
    coarse[i] = CoarseMaxima(
        Widen(coarse_blocks, 2 * kReaches[i].x, 2 * kReaches[i].y), kernels);
  }
  // The instructions that gather bytes read three more.
  blocks.values.reserve(blocks.values.size() + 3);
  blocks.values.resize(blocks.values.size() + 3);
  padded_stride = grid.num_x + 2 * kMargin;
  padded.resize(static_cast<size_t>(padded_stride) *
                (grid.num_y + 2 * kMargin));
  known = OffsetBounds{grid.num_x, -1, grid.num_y, -1};
  for (int y = 0; y != grid.num_y; ++y) {
    const auto row = grid.values.begin() + static_cast<size_t>(y) * grid.num_x;
    std::copy(row, row + grid.num_x,
              padded.begin() +
                  static_cast<size_t>(y + kMargin) * padded_stride + kMargin);
    const auto end = row + grid.num_x;
    const auto not_zero = [](const uint8_t value) { return value != 0; };
    const auto first = std::find_if(row, end, not_zero);
    if (first == end) continue;
    auto last = end - 1;
    while (*last == 0) --last;
    known.min_x = std::min(known.min_x, static_cast<int>(first - row));
    known.max_x = std::max(known.max_x, static_cast<int>(last - row));
    known.min_y = std::min(known.min_y, y);
    known.max_y = y;
  }
}

RectangleMaxima PreparedGrid::Cells() const {
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

// The reach a point needs: turned by up to `angle`, the point at (x, y) moves
// by at most |y| sin + |x| (1 - cos) along x.
int CorrelativeSearchRun::ReachOf(const double x, const double y) const {
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
  const OffsetBounds bounds = GroupBounds();
  const int64_t width = bounds.max_x - bounds.min_x + 1;
  const int64_t height = bounds.max_y - bounds.min_y + 1;
  if (width <= 0 || height <= 0) return;
  const int num_x = static_cast<int>((width + kBlockSize - 1) / kBlockSize);
  const int num_y = static_cast<int>((height + kBlockSize - 1) / kBlockSize);
  const int64_t num_nodes = static_cast<int64_t>(num_x) * num_y;
  statistics_.num_poses += width * height * (last - first + 1);
  statistics_.coarse_scored += num_nodes;
  if (statistics_.coarse_scored > kMostCoarseNodes) return;

  // Far enough apart that what is written beyond the end of a row does not
  // touch the next one: reading that right away would make the processor wait.
  stride_ = (num_x + 30) / 16 * 16;
  const size_t size = static_cast<size_t>(stride_) * num_y;
  byte_sums_.assign(size + 32, 0);
  word_sums_.assign(size, 0);
  wide_sums_.assign(size, 0);
  for (std::vector<uint16_t>& sums : sums_so_far_) sums.assign(size, 0);
  if (num_points <= kPointsPerWord) {
    for (int part = 0; part != RotatedScans::kNumParts; ++part) {
      AddCoarse(bounds, num_x, num_y, scans_.PartBegin(part),
                scans_.PartBegin(part + 1));
      if (part != kNumSumsSoFar) sums_so_far_[part] = word_sums_;
    }
    std::copy(word_sums_.begin(), word_sums_.end(), wide_sums_.begin());
  } else {
    // Without sums so far: zero is right, too.
    for (int begin = 0; begin < num_points; begin += kPointsPerWord) {
      AddCoarse(bounds, num_x, num_y, begin,
                std::min(begin + kPointsPerWord, num_points));
      for (size_t k = 0; k != size; ++k) {
        wide_sums_[k] += word_sums_[k];
        word_sums_[k] = 0;
      }
    }
  }
  CollectCoarse(group, bounds, num_x, num_y);
}

// Offsets for any rotation of the group in group_x_, group_y_.
OffsetBounds CorrelativeSearchRun::GroupBounds() {
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
void CorrelativeSearchRun::RestrictToKnown(OffsetBounds* const bounds) {
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
void CorrelativeSearchRun::AddCoarse(const OffsetBounds& bounds,
                                     const int num_x, const int num_y,
                                     const int begin, const int end) {
  const double sensor_x = scans_.SensorCellX();
  const double sensor_y = scans_.SensorCellY();
  const int size = static_cast<int>(word_sums_.size());
  int num_added = 0;
  for (int i = begin; i != end; ++i) {
    // Distances from the sensor; the place within cells is not known.
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

void CorrelativeSearchRun::CollectCoarse(const int group,
                                         const OffsetBounds& bounds,
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
      for (int part = 0; part != kNumSumsSoFar; ++part) {
        node.so_far[part] = sums_so_far_[part][k];
      }
      coarse_.push_back(node);
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
  return FromCoarse(coarse_[next_coarse_].sum);
}

int CorrelativeSearchRun::BlockBound() const {
  return block_keys_.empty() ? -1 : static_cast<int>(block_keys_.front() >> 32);
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
      const size_t index = 0xffffffffu - (block_keys_.front() & 0xffffffffu);
      std::pop_heap(block_keys_.begin(), block_keys_.end());
      block_keys_.pop_back();
      OpenBlock(blocks_[index]);
      meter->Spend(kBlockSize * kBlockSize);
    } else {
      OpenCoarse(coarse_[next_coarse_++]);
      meter->Spend(2 * half_group_ + 1);
    }
  }
}

// In steps of CoarseMaxima to values, as an upper bound of a sum of integers.
int CorrelativeSearchRun::FromCoarse(const int sum) {
  return static_cast<int>(static_cast<int64_t>(sum) * 255 /
                          CoarseMaxima::kMaxValue);
}

void CorrelativeSearchRun::OpenCoarse(const CoarseNode& node) {
  const int first = node.group * (2 * half_group_ + 1);
  const int last =
      std::min(first + 2 * half_group_, scans_.num_rotations() - 1);
  const int needed = Needed();
  const RectangleMaxima& maxima = grid_.blocks;
  for (int rotation = first; rotation <= last; ++rotation) {
    const RotatedScan& scan = scans_.Get(rotation);
    if (node.x > scan.offsets.max_x || node.y > scan.offsets.max_y ||
        node.x + kMargin < scan.offsets.min_x ||
        node.y + kMargin < scan.offsets.min_y) {
      continue;
    }
    ++statistics_.blocks_scored;
    Block block = {0, rotation, node.x, node.y, {}};
    // What the parts to come may add at most.
    int rest = 0;
    for (int part = 0; part != RotatedScans::kNumParts; ++part) {
      const int begin = scans_.PartBegin(part);
      block.sum += grid_.kernels.sum_values(
          maxima.values.data(), maxima.num_x, maxima.num_y, scan.x + begin,
          scan.y + begin, node.x + kMargin, node.y + kMargin,
          scans_.PartBegin(part + 1) - begin);
      rest = 0;
      if (part != kNumSumsSoFar) {
        block.so_far[part] = block.sum;
        rest = FromCoarse(node.sum - node.so_far[part]);
      }
      if (block.sum + rest < needed) break;
    }
    if (block.sum + rest < needed) continue;
    block_keys_.push_back(KeyOf(block.sum, blocks_.size()));
    std::push_heap(block_keys_.begin(), block_keys_.end());
    blocks_.push_back(block);
  }
}

uint64_t CorrelativeSearchRun::KeyOf(const int sum, const size_t index) {
  return static_cast<uint64_t>(sum) << 32 | (0xffffffffu - index);
}

void CorrelativeSearchRun::OpenBlock(const Block& block) {
  constexpr int kNumPoses = kBlockSize * kBlockSize;
  ++statistics_.blocks_opened;
  const RotatedScan& scan = scans_.Get(block.rotation);
  const int needed = Needed();
  uint16_t words[kNumPoses] = {};
  int32_t sums[kNumPoses] = {};
  int largest = 0;
  int num_in_words = 0;
  for (int part = 0; part != RotatedScans::kNumParts; ++part) {
    const int end = scans_.PartBegin(part + 1);
    for (int begin = scans_.PartBegin(part); begin != end;) {
      const int count = std::min(end - begin, int{kPointsPerSquareSum});
      if (num_in_words + count > kPointsPerSquareSum) {
        for (int k = 0; k != kNumPoses; ++k) sums[k] += words[k];
        std::fill(words, words + kNumPoses, uint16_t{0});
        num_in_words = 0;
      }
      const int num_places = grid_.kernels.find_places(
          grid_.blocks.num_x, grid_.blocks.num_y, grid_.padded_stride,
          scan.x + begin, scan.y + begin, block.x + kMargin, block.y + kMargin,
          count, places_);
      largest = grid_.kernels.add_squares(
          grid_.padded.data(), grid_.padded_stride, places_, num_places, words);
      num_in_words += count;
      begin += count;
    }
    // Only while all is in the words; a large scan is added to the end.
    const int rest = part == kNumSumsSoFar ? 0 : block.sum - block.so_far[part];
    if (end <= kPointsPerSquareSum && largest + rest < needed) {
      ++statistics_.blocks_cut;
      return;
    }
  }
  for (int k = 0; k != kNumPoses; ++k) sums[k] += words[k];
  for (int k = 0; k != kNumPoses; ++k) {
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
    const RectangleMaxima cells = grid_.Cells();
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
