// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the best pose of a scan in a small window of a grid that changes with
// every scan, so no structures can be prepared: the same optimum as
// Cartographer's real-time correlative matcher, bit for bit.
//
// A pose scores the mean probability of the cells that the points fall into,
// summed in single precision in the order of the points, times
//   exp(-(w_t |translation| + w_r |rotation|)^2)
// for its difference from the initial pose. Of equals the first wins, in the
// order rotation, x, y.
//
// Cartographer scores every pose. Here the part of the grid that the scan can
// reach is copied with 8 bits per cell, rounded up. Sums of these bound the
// scores of groups of rotations, of single rotations, and of poses, in this
// order and the largest bound first; only the few poses whose bound reaches the
// best score so far are scored as defined. Bounds allow for the rounding of the
// single precision sum.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_REAL_TIME_SEARCH_2D_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_REAL_TIME_SEARCH_2D_H_

#include <cstdint>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"
#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

namespace cartographer_ext {
namespace scan_matching {

// A grid of probabilities between 0.1 and 0.9.
class ProbabilityView {
 public:
  static constexpr float kMinProbability = 0.1f;
  static constexpr float kMaxProbability = 0.9f;

  virtual ~ProbabilityView() = default;
  virtual GridGeometry Geometry() const = 0;
  // All cells outside this rectangle have the smallest probability. Bounds are
  // inclusive; empty if max < min.
  virtual OffsetBounds Known() const = 0;
  // Writes the probabilities of cells (x_begin, y) to (x_end - 1, y), which
  // must be in Known(), in 256 steps, rounded up (within 1e-3 of a step).
  virtual void CopyRow(int y, int x_begin, int x_end,
                       uint8_t* values) const = 0;
  // Probability of any cell.
  virtual float Probability(int x, int y) const = 0;
};

// Half widths of the window and weights of the difference from the initial
// pose.
struct RealTimeSearchOptions {
  SearchWindow window = {0.1, DegToRad(20.)};
  double translation_delta_cost_weight = 0.1;
  double rotation_delta_cost_weight = 0.1;
  // Null: the fastest on this machine. All give the same results.
  const SearchKernels* kernels = nullptr;
};

// The best pose in the window.
struct RealTimeSearchResult {
  // False, with the initial pose, if the window is too large or the initial
  // pose is not finite.
  bool complete = true;
  float score = 0.f;
  Pose2 pose;  // (grid <- cloud); the angle is not wrapped
  int64_t poses_in_window = 0;
  int64_t poses_scored = 0;
};

// An empty cloud gives the initial pose and a score of 0.
RealTimeSearchResult SearchInRealTime(const RealTimeSearchOptions& options,
                                      const ProbabilityView& grid,
                                      const Pose2& initial,
                                      const PlanarCloud& cloud);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_CORRELATIVE_SEARCH_REAL_TIME_SEARCH_2D_H_
