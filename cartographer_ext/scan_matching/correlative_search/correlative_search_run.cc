// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/correlative_search_run.h"

#include <algorithm>

#include "absl/memory/memory.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

constexpr size_t kMostEqual = 64;
constexpr int kMostPoints = 1 << 22;

}  // namespace

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
  coarse_search_ = absl::make_unique<CoarseSearch>(grid_, &scans_, threshold_);
  if (!coarse_search_->Score(&statistics_, &coarse_)) {
    complete_ = false;
    coarse_.clear();
    return;
  }
  statistics_.rejected_early = coarse_.empty();
}

// By bisection, because rounding decides. No sum exceeds a minimum that is NaN.
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

int CorrelativeSearchRun::CoarseBound() const {
  if (next_coarse_ == coarse_.size()) return -1;
  return CoarseSearch::ToSum(coarse_[next_coarse_].sum);
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
      meter->Spend(coarse_search_->group_size());
    }
  }
}

void CorrelativeSearchRun::OpenCoarse(const CoarseNode& node) {
  const int first = coarse_search_->FirstRotation(node.group);
  const int last = coarse_search_->LastRotation(node.group);
  const int needed = Needed();
  const RectangleMaxima& maxima = grid_.blocks;
  for (int rotation = first; rotation <= last; ++rotation) {
    const RotatedScan& scan = scans_.Get(rotation);
    if (node.x > scan.offsets.max_x || node.y > scan.offsets.max_y ||
        node.x + kGridMargin < scan.offsets.min_x ||
        node.y + kGridMargin < scan.offsets.min_y) {
      continue;
    }
    ++statistics_.blocks_scored;
    Block block = {0, rotation, node.x, node.y, {}};
    // The most that the remaining parts can add.
    int rest = 0;
    for (int part = 0; part != RotatedScans::kNumParts; ++part) {
      const int begin = scans_.PartBegin(part);
      block.sum += grid_.kernels.sum_values(
          maxima.values.data(), maxima.num_x, maxima.num_y, scan.x + begin,
          scan.y + begin, node.x + kGridMargin, node.y + kGridMargin,
          scans_.PartBegin(part + 1) - begin);
      rest = 0;
      if (part != kNumPartialSums) {
        block.partial_sums[part] = block.sum;
        rest = CoarseSearch::ToSum(node.sum - node.partial_sums[part]);
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
          scan.x + begin, scan.y + begin, block.x + kGridMargin,
          block.y + kGridMargin, count, places_);
      largest = grid_.kernels.add_squares(
          grid_.padded.data(), grid_.padded_stride, places_, num_places, words);
      num_in_words += count;
      begin += count;
    }
    // Only while all is in the words; a large scan is added to the end.
    const int rest =
        part == kNumPartialSums ? 0 : block.sum - block.partial_sums[part];
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
