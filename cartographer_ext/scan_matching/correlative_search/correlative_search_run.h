// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The state of one search of FastCorrelativeSearch2D, which describes the
// method. Scores are compared as sums over the points of values from 0 to 255.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_CORRELATIVE_SEARCH_RUN_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_CORRELATIVE_SEARCH_RUN_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/budget_meter.h"
#include "cartographer_ext/scan_matching/correlative_search/coarse_search.h"
#include "cartographer_ext/scan_matching/correlative_search/equal_scores.h"
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"
#include "cartographer_ext/scan_matching/correlative_search/prepared_grid.h"
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"

namespace cartographer_ext {
namespace scan_matching {

// A search that can be interrupted and resumed. Not thread-safe.
class CorrelativeSearchRun {
 public:
  // Computes the coarse bounds. `grid` must outlive this.
  CorrelativeSearchRun(const PreparedGrid& grid, const PlanarCloud& cloud,
                       const Pose2& initial, const SearchWindow& window,
                       float min_score);

  // No pose scores more; once done, a pose with this score exists.
  float UpperBound() const;
  // Whether no remaining pose can be better than the best one found.
  bool done() const;
  // Continues until done, until the upper bound is below `score`, or until the
  // budget is used up.
  void Run(float score, BudgetMeter* meter);
  // After the last `Run`.
  SearchResult Result();

 private:
  // The values of this many points fit into 16 bits.
  static constexpr int kPointsPerSquareSum = 257;
  struct Block {
    int32_t sum;  // bound
    int32_t rotation;
    int32_t x;
    int32_t y;
    int32_t partial_sums[kNumPartialSums];
  };

  int LargestSumNotAbove(float score) const;
  int SmallestSumOfScore(float score) const;
  int CoarseBound() const;
  int BlockBound() const;
  int BestBound() const;
  // The smallest sum that is relevant.
  int Needed() const;
  void OpenCoarse(const CoarseNode& node);
  static uint64_t KeyOf(int sum, size_t index);
  void OpenBlock(const Block& block);
  void TakePose(int sum, int rotation, int x, int y);

  const PreparedGrid& grid_;
  RotatedScans scans_;
  bool complete_ = true;
  int threshold_ = 0;  // only larger sums are relevant
  int best_sum_ = -1;
  // Poses with the best sum; only the first few if there are many.
  std::vector<DiscretePose> best_;
  bool too_many_equal_ = false;

  std::unique_ptr<CoarseSearch> coarse_search_;
  std::vector<CoarseNode> coarse_;  // best first
  size_t next_coarse_ = 0;
  std::vector<Block> blocks_;  // all so far
  // A heap of those to be opened: bound, then the earlier one; see KeyOf.
  std::vector<uint64_t> block_keys_;
  int32_t places_[kPointsPerSquareSum + 8];
  SearchStatistics statistics_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_CORRELATIVE_SEARCH_RUN_H_
