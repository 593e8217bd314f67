// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// CeresScanMatcher2D for options with our block: the same cost on probability
// grids, minimised by a dedicated solver for three unknowns; along directions
// that the scan does not observe the result follows the prediction
// (scan_information.h). A TSDF goes to the stock matcher.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_DEGENERACY_AWARE_SCAN_MATCHER_2D_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_DEGENERACY_AWARE_SCAN_MATCHER_2D_H_

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/proto/scan_matching/ceres_scan_matcher_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/scan_matcher_options.pb.h"
#include "cartographer_ext/scan_matching/match_report.h"
#include "cartographer_ext/scan_matching/scan_match.h"
#include "cartographer_ext/swaps.h"
#include "ceres/ceres.h"

namespace cartographer_ext {
namespace scan_matching {

// May be used by several threads at once. Never fails: without points, without
// known cells in the grid, or with values that are not finite, the result is
// the prediction.
class DegeneracyAwareScanMatcher2D {
 public:
  // The weights of `options` must be positive, as the stock matcher requires.
  DegeneracyAwareScanMatcher2D(const cartographer::mapping::scan_matching::
                                   proto::CeresScanMatcherOptions2D& options,
                               const proto::ScanMatcherOptions& extension);
  ~DegeneracyAwareScanMatcher2D();
  DegeneracyAwareScanMatcher2D(const DegeneracyAwareScanMatcher2D&) = delete;
  DegeneracyAwareScanMatcher2D& operator=(const DegeneracyAwareScanMatcher2D&) =
      delete;

  // As the stock matcher: poses are (grid <- cloud), `pose_estimate` may be one
  // of the inputs, `summary` (may be null) gets costs, iterations and
  // termination. The prediction is `target_translation` with the angle of
  // `initial_pose_estimate`; its confidence is given by the weights of the
  // options.
  void Match(const Eigen::Vector2d& target_translation,
             const cartographer::transform::Rigid2d& initial_pose_estimate,
             const cartographer::sensor::PointCloud& point_cloud,
             const cartographer::mapping::Grid2D& grid,
             cartographer::transform::Rigid2d* pose_estimate,
             ceres::Solver::Summary* summary) const;

  // Scan and prediction are weighed by their covariances. The search for the
  // minimum starts at `initial_pose_estimate`. `report` may be null.
  void MatchWithPrediction(
      const Prediction& prediction,
      const cartographer::transform::Rigid2d& initial_pose_estimate,
      const cartographer::sensor::PointCloud& point_cloud,
      const cartographer::mapping::Grid2D& grid,
      cartographer::transform::Rigid2d* pose_estimate,
      MatchReport* report) const;

 private:
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
  using StockMatcher =
      cartographer::mapping::scan_matching::StockCeresScanMatcher2D;
#else
  using StockMatcher = cartographer::mapping::scan_matching::CeresScanMatcher2D;
#endif

  void MatchTsdf(const Prediction& prediction,
                 const cartographer::transform::Rigid2d& initial_pose_estimate,
                 const cartographer::sensor::PointCloud& point_cloud,
                 const cartographer::mapping::Grid2D& grid,
                 cartographer::transform::Rigid2d* pose_estimate,
                 MatchReport* report) const;

  const ScanMatchOptions options_;
  const StockMatcher stock_;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_DROPIN_DEGENERACY_AWARE_SCAN_MATCHER_2D_H_
