// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One search of FastCorrelativeSearch2D under way; see there for the method.
// Scores are compared as sums over the points of values from 0 to 255.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_RUN_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_RUN_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartographer_ext/scan_matching/equal_scores.h"
#include "cartographer_ext/scan_matching/fast_correlative_search_2d.h"
#include "cartographer_ext/scan_matching/rotated_scans.h"
#include "cartographer_ext/scan_matching/search_kernels.h"
#include "cartographer_ext/scan_matching/search_maxima.h"

namespace cartographer_ext {
namespace scan_matching {

// How far, in cells, points may move within a coarse node to either side of
// where they are in its middle rotation. A point moves across its ray, so that
// one on an axis of the grid needs room along the other axis only.
struct Reach {
  int x;
  int y;
};
constexpr int kNumReaches = 5;
// Each point uses the first that suffices; the last is for all points.
constexpr Reach kReaches[kNumReaches] = {
    {1, 1}, {1, 4}, {4, 1}, {2, 2}, {4, 4}};

struct PreparedGrid {
  PreparedGrid(const SearchGrid2D& grid, int depth,
               const SearchKernels& search_kernels);

  float ToScore(const float value) const {
    return min_score + value * ((max_score - min_score) / 255.f);
  }

  const SearchKernels& kernels;
  GridGeometry geometry;
  float min_score;
  float max_score;
  int depth;               // of Cartographer's search
  RectangleMaxima blocks;  // of kBlockSize
  // The cells with kBlockSize - 1 zeros on every side.
  std::vector<uint8_t> padded;
  int padded_stride = 0;
  CoarseMaxima coarse[kNumReaches];
  // The smallest rectangle with all cells that are not 0; empty when max < min.
  OffsetBounds known;

  RectangleMaxima Cells() const;  // a copy without the margin
  size_t MemoryBytes() const;
};

// Counts down what a budget allows.
class BudgetMeter {
 public:
  explicit BudgetMeter(const SearchBudget& budget);
  // False when nothing is left.
  bool Spend(int64_t candidates);
  bool used_up() const { return used_up_; }

 private:
  const SearchBudget budget_;
  int64_t spent_ = 0;
  int calls_until_clock_ = 0;
  double start_seconds_ = 0.;
  bool used_up_ = false;
};

class CorrelativeSearchRun {
 public:
  // Computes the coarse bounds. All references must stay.
  CorrelativeSearchRun(const PreparedGrid& grid, const PlanarCloud& cloud,
                       const Pose2& initial, const SearchWindow& window,
                       float min_score);

  // No pose scores more, and a pose that scores so much exists once done.
  float UpperBound() const;
  // Nothing is left that could be better than what was found.
  bool done() const;
  // Goes on until done, until the upper bound is below `score`, or until the
  // meter is used up.
  void Run(float score, BudgetMeter* meter);
  // At the end.
  SearchResult Result();

 private:
  // 16 bits hold the values of so many points.
  static constexpr int kPointsPerSquareSum = 257;
  // Sums so far, after each part of the scan but the last.
  static constexpr int kNumSumsSoFar = RotatedScans::kNumParts - 1;
  struct CoarseNode {
    int32_t sum;    // bound, in steps of CoarseMaxima
    int32_t group;  // of rotations
    int32_t x;      // smallest offsets
    int32_t y;
    uint16_t so_far[kNumSumsSoFar];
  };
  struct Block {
    int32_t sum;  // bound
    int32_t rotation;
    int32_t x;
    int32_t y;
    int32_t so_far[kNumSumsSoFar];
  };

  int LargestSumNotAbove(float score) const;
  int SmallestSumOfScore(float score) const;
  void ChooseGroups();
  int ReachOf(double x, double y) const;
  bool ScoreCoarseNodes();
  void ScoreGroup(int group);
  OffsetBounds GroupBounds();
  void RestrictToKnown(OffsetBounds* bounds);
  void AddCoarse(const OffsetBounds& bounds, int num_x, int num_y, int begin,
                 int end);
  void CollectCoarse(int group, const OffsetBounds& bounds, int num_x,
                     int num_y);
  void SortCoarse();
  static int FromCoarse(int sum);
  int CoarseBound() const;
  int BlockBound() const;
  int BestBound() const;
  // The smallest sum that is of interest.
  int Needed() const;
  void OpenCoarse(const CoarseNode& node);
  static uint64_t KeyOf(int sum, size_t index);
  void OpenBlock(const Block& block);
  void TakePose(int sum, int rotation, int x, int y);

  const PreparedGrid& grid_;
  RotatedScans scans_;
  bool complete_ = true;
  int threshold_ = 0;  // sums up to this one are not wanted
  int best_sum_ = -1;
  // With the best sum; when there are too many of them, only the first few.
  std::vector<DiscretePose> best_;
  bool too_many_equal_ = false;

  int half_group_ = 0;
  double sine_ = 0.;     // of the angle from the middle of a group to its ends
  double versine_ = 0.;  // 1 - cosine
  std::vector<int32_t> group_x_;
  std::vector<int32_t> group_y_;
  std::vector<int32_t> ordered_;
  int stride_ = 0;  // of the rows of sums
  std::vector<uint8_t> byte_sums_;
  std::vector<uint16_t> word_sums_;
  std::vector<int32_t> wide_sums_;
  std::vector<uint16_t> sums_so_far_[kNumSumsSoFar];

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

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_RUN_H_
