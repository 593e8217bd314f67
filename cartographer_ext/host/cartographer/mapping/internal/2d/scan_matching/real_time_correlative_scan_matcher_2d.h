// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_REAL_TIME_CORRELATIVE_SCAN_MATCHER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_REAL_TIME_CORRELATIVE_SCAN_MATCHER_2D_H_

#include <vector>

#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/internal/2d/scan_matching/correlative_scan_matcher_2d.h"
#include "cartographer/mapping/proto/scan_matching/real_time_correlative_scan_matcher_options.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// Tries every pose of a small window in a grid that changes all the time, so
// that nothing can be prepared. A pose scores the mean probability of the cells
// the points fall into, times
//   exp(-(translation_weight * distance + rotation_weight * |angle|)^2)
// for its difference from the initial pose. The first of equals wins.
class RealTimeCorrelativeScanMatcher2D {
 public:
  explicit RealTimeCorrelativeScanMatcher2D(
      const proto::RealTimeCorrelativeScanMatcherOptions& options);
  RealTimeCorrelativeScanMatcher2D(const RealTimeCorrelativeScanMatcher2D&) =
      delete;
  RealTimeCorrelativeScanMatcher2D& operator=(
      const RealTimeCorrelativeScanMatcher2D&) = delete;

  // Poses are (frame of the grid <- frame of the cloud). Returns the score; an
  // empty cloud leaves the initial pose and scores 0.
  double Match(const transform::Rigid2d& initial_pose_estimate,
               const sensor::PointCloud& point_cloud, const Grid2D& grid,
               transform::Rigid2d* pose_estimate) const;

  // Fills in the scores of the candidates, one by one. On a TSDF the mean is
  // that of closeness to a surface, weighted by the cells' weights.
  void ScoreCandidates(const Grid2D& grid,
                       const std::vector<DiscreteScan2D>& discrete_scans,
                       const SearchParameters& search_parameters,
                       std::vector<Candidate2D>* candidates) const;

 private:
  Candidate2D FindBest(const sensor::PointCloud& rotated_cloud,
                       const transform::Rigid2d& initial_pose_estimate,
                       const SearchParameters& search_parameters,
                       const Grid2D& grid) const;
  // The same for probability grids, without touching a candidate twice.
  Candidate2D FindBestInProbabilityGrid(
      const sensor::PointCloud& rotated_cloud,
      const transform::Rigid2d& initial_pose_estimate,
      const SearchParameters& search_parameters,
      const ProbabilityGrid& grid) const;
  double DeltaFactor(double x, double y, double orientation) const;

  const proto::RealTimeCorrelativeScanMatcherOptions options_;
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_REAL_TIME_CORRELATIVE_SCAN_MATCHER_2D_H_
