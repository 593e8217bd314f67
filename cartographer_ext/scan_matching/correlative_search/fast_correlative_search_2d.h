// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the best pose of a scan in a grid within a large window: the same
// optimum as Cartographer's branch-and-bound matcher [Olson 2009; Hess et al.
// 2016, section V], bit for bit, several times faster.
//
// Problem. A pose is one of 2 n + 1 equidistant rotations and an offset of
// whole cells. Its score is the mean, over the points, of the 8-bit values of
// the cells they fall into (0 outside the grid), mapped from [0, 255] to
// [min_score, max_score]. The search returns the best pose if its score exceeds
// a given minimum. Sums of values are integers, so nothing depends on the order
// of summation or on the instruction set.
//
// Method. Three kinds of nodes, each with an upper bound of all poses below it:
//  * coarse: neighbouring rotations x 8 x 8 offsets. For a point the bound is
//    the largest value of all cells it can meet: between two rotations it moves
//    by less than one cell, in proportion to its range and across its ray, so
//    that one of five rectangles of cells is enough. Bounds of all coarse nodes
//    are computed at once: cells eight apart are stored side by side,
//    so that one vector addition serves 32 nodes. Values have 5 bits there,
//    rounded up, so that eight points fit one byte.
//  * block: one rotation x 8 x 8 offsets.
//  * pose: the 64 poses of a block are scored together, as eight neighbouring
//    cells are eight neighbouring bytes; abandoned when the rest of the block
//    cannot reach the best pose so far.
// The node with the largest bound is opened next, until no bound exceeds the
// best score. If no pose is above the minimum, the coarse bounds alone often
// prove it, and no node is opened ("rejected early").
//
// Ties: of several poses with equal sums, the search returns the one that
// Cartographer's depth-first search finds first, see equal_scores.h.
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

// Window and details of the search.
struct FastCorrelativeSearchOptions {
  SearchWindow window = {7., DegToRad(30.)};
  // Depth of Cartographer's search; only affects the choice between poses of
  // equal score.
  int branch_and_bound_depth = 7;
  // Null: the fastest on this machine. All give the same results.
  const SearchKernels* kernels = nullptr;
};

// Limits of a search; zero: no limit.
struct SearchBudget {
  // Nodes and poses scored after the coarse bounds; deterministic.
  int64_t max_candidates = 0;
  // Wall time after the coarse bounds, checked every few nodes; makes results
  // depend on the machine.
  double max_seconds = 0.;
};

// Counts of nodes, for tests and benchmarks.
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

// The best pose of one search.
struct SearchResult {
  // Whether a pose above the minimum was found; if the search is not complete,
  // it is the best so far.
  bool found = false;
  // False if the budget was used up, or if the window is too large.
  bool complete = true;
  float score = 0.f;
  Pose2 pose;  // (grid <- cloud); the angle is not wrapped
  // No pose of the window has a higher score; equals `score` if found and
  // complete.
  float upper_bound = 0.f;
  SearchStatistics statistics;
};

struct PreparedGrid;

// The search in one grid, see above. Thread-safe.
class FastCorrelativeSearch2D {
 public:
  // With an empty grid, or if its dimensions do not match its values, no search
  // finds a pose.
  FastCorrelativeSearch2D(SearchGrid2D grid,
                          const FastCorrelativeSearchOptions& options);
  ~FastCorrelativeSearch2D();
  FastCorrelativeSearch2D(const FastCorrelativeSearch2D&) = delete;
  FastCorrelativeSearch2D& operator=(const FastCorrelativeSearch2D&) = delete;

  // Searches the window of the options around `initial` (grid <- cloud).
  SearchResult Match(const Pose2& initial, const PlanarCloud& cloud,
                     float min_score) const;
  // The same with a different window. Negative or NaN half sizes count as zero.
  SearchResult Match(const Pose2& initial, const PlanarCloud& cloud,
                     const SearchWindow& window, float min_score,
                     const SearchBudget& budget) const;
  // Searches every rotation and every offset that keeps a point in the grid.
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

// One of several submaps in which a scan is searched. Pointees must outlive the
// search.
struct SearchTask {
  const FastCorrelativeSearch2D* grid = nullptr;
  const PlanarCloud* cloud = nullptr;
  bool full_submap = false;  // then `initial` and `window` are ignored
  Pose2 initial;
  SearchWindow window;
  float min_score = 0.f;
};

// The result of one of several tasks.
struct SearchTaskResult {
  size_t task = 0;  // index
  SearchResult result;
};

// Returns the results of the `num_best` tasks with the highest scores, best
// first (of equals the earlier task first); fewer if fewer exceed their
// minimum. All tasks share one queue, so that a worse task is abandoned as soon
// as its bound shows it. The budget applies to all tasks together; if it is
// used up, results may be incomplete. `total`, unless null, receives the summed
// statistics.
std::vector<SearchTaskResult> MatchBestFew(const std::vector<SearchTask>& tasks,
                                           int num_best,
                                           const SearchBudget& budget,
                                           SearchStatistics* total);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_FAST_CORRELATIVE_SEARCH_2D_H_
