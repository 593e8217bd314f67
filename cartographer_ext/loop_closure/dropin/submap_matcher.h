// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The search in one submap: the interface that loop closure needs of a matcher.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_MATCHER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_MATCHER_H_

#include <cstddef>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/proto/scan_matching/fast_correlative_scan_matcher_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"
#include "cartographer_ext/scan_matching/dropin/fast_correlative_matcher_2d.h"

namespace cartographer_ext {
namespace loop_closure {

// The best pose found in a submap.
struct SubmapMatch {
  bool found = false;
  double score = 0.;
  Pose2 pose;  // (frame of the grid <- cloud)
};

// Does not refer to the grid after construction. Thread-safe.
class SubmapMatcher {
 public:
  SubmapMatcher(const cartographer::mapping::Grid2D& grid,
                const cartographer::mapping::scan_matching::proto::
                    FastCorrelativeScanMatcherOptions2D& options);
  SubmapMatcher(const SubmapMatcher&) = delete;
  SubmapMatcher& operator=(const SubmapMatcher&) = delete;

  // The best pose in the window (half widths, metres and radians) around
  // `initial` that scores more than `min_score`.
  SubmapMatch Match(const Pose2& initial, double linear_window,
                    double angular_window,
                    const cartographer::sensor::PointCloud& cloud,
                    double min_score) const;
  // The same in the whole submap.
  SubmapMatch MatchFullSubmap(const cartographer::sensor::PointCloud& cloud,
                              double min_score) const;

  size_t MemoryBytes() const { return matcher_.MemoryBytes(); }

  // For searches of several submaps at once.
  const scan_matching::FastCorrelativeSearch2D& search() const {
    return matcher_.search();
  }

 private:
  const scan_matching::FastCorrelativeMatcher2D matcher_;
};

// Finds in which part of a whole submap a scan fits best, in cells of four times
// the size: sixty times fewer poses than SubmapMatcher has, and the place is the
// same unless two score alike. Does not refer to the grid after
// construction. Thread-safe.
class PlaceMatcher {
 public:
  PlaceMatcher(const cartographer::mapping::Grid2D& grid,
               const cartographer::mapping::scan_matching::proto::
                   FastCorrelativeScanMatcherOptions2D& options);
  PlaceMatcher(const PlaceMatcher&) = delete;
  PlaceMatcher& operator=(const PlaceMatcher&) = delete;

  // (frame of the grid <- cloud) of the best place, or empty if the scan scores
  // more than `min_score` nowhere.
  absl::optional<Pose2> Find(const cartographer::sensor::PointCloud& cloud,
                             double min_score) const;
  // In which SubmapMatcher finds the pose around such a place.
  scan_matching::SearchWindow WindowOf(
      const cartographer::sensor::PointCloud& cloud) const;

  size_t MemoryBytes() const { return search_.MemoryBytes(); }

 private:
  const double resolution_;  // metres
  const scan_matching::FastCorrelativeSearch2D search_;
};

// The best poses of the scan in the `num_best` submaps that match best, best
// first. Other submaps are abandoned as soon as they cannot be among them. Not
// exact: the search uses a part of the points.
struct SubmapRanking {
  size_t submap = 0;  // index
  SubmapMatch match;
};
// Computes the ranking; `min_score` in [0, 1].
std::vector<SubmapRanking> MatchBestSubmaps(
    const std::vector<const SubmapMatcher*>& submaps,
    const cartographer::sensor::PointCloud& cloud, double min_score,
    int num_best);

// Cells with a probability above 0.5 are occupied, other known ones free. In a
// TSDF, cells within one cell of the surface are occupied.
OccupancyView MakeOccupancyView(const cartographer::mapping::Grid2D& grid);

// The same, prepared for temporal verification.
OccupancyView MakeReferenceView(const TemporalVerificationOptions& options,
                                const cartographer::mapping::Grid2D& grid);

// (grid <- cloud) of a match, refined by Cartographer's scan matcher.
Pose2 RefineMatch(
    const cartographer::mapping::scan_matching::CeresScanMatcher2D& matcher,
    const cartographer::mapping::Grid2D& grid,
    const cartographer::sensor::PointCloud& cloud, const Pose2& pose);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_MATCHER_H_
