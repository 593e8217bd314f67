// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the best pose of a scan in a grid within a large window: the same
// optimum as Cartographer's branch-and-bound matcher [Olson 2009; Hess et al.
// 2016, section V], bit for bit, several times faster.
//
// What is searched. A pose is a rotation out of 2 n + 1 equidistant ones and an
// offset of whole cells. It scores the mean, over the points, of the 8-bit
// values of the cells they fall into (0 outside the grid), mapped from [0, 255]
// to [min_score, max_score]. The best pose is wanted if it scores more than a
// given minimum. Sums of values are integers, so nothing depends on the order
// of summation or on the instruction set.
//
// How. Three kinds of nodes, each with an upper bound of all poses below it:
//  * coarse: neighbouring rotations x 8 x 8 offsets. For a point the bound is
//    the largest value of all cells it can meet: between two rotations it moves
//    by less than one cell, in proportion to its range and across its ray, so
//    that one of five rectangles of cells is enough. Bounds of all coarse nodes
//    are computed at once: cells eight apart are stored side by side,
//    so that one vector addition serves 32 nodes. Values have 5 bits there,
//    rounded up, so that eight points fit one byte.
//  * block: one rotation x 8 x 8 offsets.
//  * pose: the 64 poses of a block are scored together, as eight neighbouring
//    cells are eight neighbouring bytes; ended early when the rest of the block
//    cannot reach the best pose so far.
// The node with the largest bound comes next, until no bound exceeds the best
// score. Where nothing is above the minimum, the coarse bounds sometimes say so
// alone, and no node is opened ("rejected early").
//
// Ties: of poses with equal sums the one is returned that Cartographer's
// depth-first search meets first, see equal_scores.h.
//
// Objects are immutable after construction; all methods may be used by several
// threads at once. Only `max_seconds` makes a result depend on time.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_FAST_CORRELATIVE_SEARCH_2D_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_FAST_CORRELATIVE_SEARCH_2D_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"
#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

namespace cartographer_ext {
namespace scan_matching {

// A grid of scores. Cell (ix, iy) is values[num_x * iy + ix]; its centre is at
//   x = max_x - resolution * (iy + 0.5),  y = max_y - resolution * (ix + 0.5).
struct SearchGrid2D {
  int num_x = 0;
  int num_y = 0;
  double resolution = 0.;  // metres per cell
  double max_x = 0.;       // metres
  double max_y = 0.;
  float min_score = 0.f;  // of value 0, unknown cells, and outside the grid
  float max_score = 1.f;  // of value 255
  std::vector<uint8_t> values;
};

// Half sizes, to either side of the initial pose.
struct SearchWindow {
  double linear = 0.;   // metres
  double angular = 0.;  // radians
};

struct FastCorrelativeSearchOptions {
  SearchWindow window = {7., DegToRad(30.)};
  // Of Cartographer's search; decides only between poses of equal score.
  int branch_and_bound_depth = 7;
  // Null means the fastest of this machine. All give the same results.
  const SearchKernels* kernels = nullptr;
};

// Zero means without limit.
struct SearchBudget {
  // Nodes and poses scored after the coarse bounds; deterministic.
  int64_t max_candidates = 0;
  // Wall time after the coarse bounds, checked every few nodes; makes results
  // depend on the machine.
  double max_seconds = 0.;
};

struct SearchStatistics {
  int64_t num_poses = 0;        // in the window
  int64_t coarse_scored = 0;    // coarse nodes
  int64_t coarse_pruned = 0;    // of them, never opened
  int64_t blocks_scored = 0;    // one rotation, 8 x 8 offsets
  int64_t blocks_pruned = 0;    // of them, never opened
  int64_t blocks_opened = 0;    // poses scored 64 at a time
  int64_t blocks_cut = 0;       // of them, ended early
  bool rejected_early = false;  // by the coarse bounds alone

  void Add(const SearchStatistics& other);
};

struct SearchResult {
  // A pose above the minimum was found. When the search is not complete, it is
  // the best so far.
  bool found = false;
  // False when the budget was used up (or the window is absurdly large) first.
  bool complete = true;
  float score = 0.f;
  Pose2 pose;  // (grid <- cloud); the angle is not wrapped
  // No pose of the window scores more; equals `score` when found and complete.
  float upper_bound = 0.f;
  SearchStatistics statistics;
};

struct PreparedGrid;

class FastCorrelativeSearch2D {
 public:
  // A grid whose sizes do not fit its values, or without cells, makes a search
  // that never finds anything.
  FastCorrelativeSearch2D(SearchGrid2D grid,
                          const FastCorrelativeSearchOptions& options);
  ~FastCorrelativeSearch2D();
  FastCorrelativeSearch2D(const FastCorrelativeSearch2D&) = delete;
  FastCorrelativeSearch2D& operator=(const FastCorrelativeSearch2D&) = delete;

  // Searches the window of the options around `initial` (grid <- cloud).
  SearchResult Match(const Pose2& initial, const PlanarCloud& cloud,
                     float min_score) const;
  // Another window. Negative or NaN half sizes count as zero.
  SearchResult Match(const Pose2& initial, const PlanarCloud& cloud,
                     const SearchWindow& window, float min_score,
                     const SearchBudget& budget) const;
  // Every rotation and every offset that leaves a point in the grid.
  SearchResult MatchFullSubmap(const PlanarCloud& cloud, float min_score,
                               const SearchBudget& budget) const;

  size_t MemoryBytes() const;
  const FastCorrelativeSearchOptions& options() const;

  // For MatchBestFew. Null for a grid that cannot be searched.
  const PreparedGrid* prepared() const { return grid_.get(); }

 private:
  const FastCorrelativeSearchOptions options_;
  std::unique_ptr<const PreparedGrid> grid_;
};

// One of several places where a scan may belong. Pointees must outlive the
// search.
struct SearchTask {
  const FastCorrelativeSearch2D* grid = nullptr;
  const PlanarCloud* cloud = nullptr;
  bool full_submap = false;  // `initial` and `window` do not matter then
  Pose2 initial;
  SearchWindow window;
  float min_score = 0.f;
};

struct SearchTaskResult {
  size_t task = 0;  // index
  SearchResult result;
};

// The results of the `num_best` tasks whose best poses score highest, best
// first (of equals the earlier task first); fewer when fewer exceed their
// minimum. All tasks share one queue, so that a worse place is
// abandoned as soon as its bound shows it. With a budget, which is for all
// tasks together, results may be incomplete. `total`, if any, gets the sums.
std::vector<SearchTaskResult> MatchBestFew(const std::vector<SearchTask>& tasks,
                                           int num_best,
                                           const SearchBudget& budget,
                                           SearchStatistics* total);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_FAST_CORRELATIVE_SEARCH_2D_H_
