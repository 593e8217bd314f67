// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The first level of FastCorrelativeSearch2D: upper bounds of the scores of
// blocks of offsets, for groups of neighbouring rotations at once.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_COARSE_SEARCH_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_COARSE_SEARCH_H_

#include <cstdint>
#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"
#include "cartographer_ext/scan_matching/correlative_search/prepared_grid.h"
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"

namespace cartographer_ext {
namespace scan_matching {

// Bounds are stored after each part of the scan but the last.
constexpr int kNumPartialSums = RotatedScans::kNumParts - 1;

// Neighbouring rotations and 8 x 8 offsets with an upper bound of their scores.
struct CoarseNode {
  int32_t sum;    // bound, in steps of CoarseMaxima
  int32_t group;  // of rotations
  int32_t x;      // smallest offsets
  int32_t y;
  uint16_t partial_sums[kNumPartialSums];
};

// Computes the coarse nodes of a scan. Not thread-safe.
class CoarseSearch {
 public:
  // Nodes whose poses cannot exceed the sum `threshold` are dropped. `grid` and
  // `scans` must outlive this object.
  CoarseSearch(const PreparedGrid& grid, RotatedScans* scans, int threshold);

  CoarseSearch(const CoarseSearch&) = delete;
  CoarseSearch& operator=(const CoarseSearch&) = delete;

  // Computes the nodes, largest bounds first, equal ones in the order of
  // scoring. Returns false if there are too many.
  bool Score(SearchStatistics* statistics, std::vector<CoarseNode>* nodes);

  // Upper bound, as a sum of values from 0 to 255, of a sum in coarse steps.
  static int ToSum(int coarse_sum);

  int group_size() const { return 2 * half_group_ + 1; }
  // The rotations of a group, both included.
  int FirstRotation(int group) const { return group * group_size(); }
  int LastRotation(int group) const;

 private:
  void ChooseGroups();
  int ReachOf(double x, double y) const;
  void ScoreGroup(int group);
  OffsetBounds GroupBounds();
  void RestrictToKnown(OffsetBounds* bounds);
  void AddPoints(const OffsetBounds& bounds, int num_x, int num_y, int begin,
                 int end);
  void Collect(int group, const OffsetBounds& bounds, int num_x, int num_y);
  void Sort();

  const PreparedGrid& grid_;
  RotatedScans& scans_;
  const int threshold_;
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
  std::vector<uint16_t> partial_sums_[kNumPartialSums];
  // Of the current call of `Score`.
  SearchStatistics* statistics_ = nullptr;
  std::vector<CoarseNode>* nodes_ = nullptr;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_COARSE_SEARCH_H_
