// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path. Class and factory
// found there become StockCeresScanMatcher2D and
// StockCreateCeresScanMatcherOptions2D; those of the original names forward to
// them, or, where the options have our block, to ours.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER) || \
    defined(CeresScanMatcher2D)
// Not selected, or this is the stock source with its names renamed.
#include_next "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_CERES_SCAN_MATCHER_2D_H_
#define CARTOGRAPHER_EXT_OVERLAY_CERES_SCAN_MATCHER_2D_H_

#define CeresScanMatcher2D StockCeresScanMatcher2D
#define CreateCeresScanMatcherOptions2D StockCreateCeresScanMatcherOptions2D
#include_next "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#undef CeresScanMatcher2D
#undef CreateCeresScanMatcherOptions2D

#include <memory>

namespace cartographer_ext {
namespace scan_matching {
class DegeneracyAwareScanMatcher2D;
}  // namespace scan_matching
}  // namespace cartographer_ext

namespace cartographer {
namespace mapping {
namespace scan_matching {

proto::CeresScanMatcherOptions2D CreateCeresScanMatcherOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

// Exactly one of the two matchers exists, chosen once by the options.
class CeresScanMatcher2D {
 public:
  explicit CeresScanMatcher2D(const proto::CeresScanMatcherOptions2D& options);
  virtual ~CeresScanMatcher2D();
  CeresScanMatcher2D(const CeresScanMatcher2D&) = delete;
  CeresScanMatcher2D& operator=(const CeresScanMatcher2D&) = delete;

  // May be used by several threads at once; `pose_estimate` may be one of the
  // inputs.
  void Match(const Eigen::Vector2d& target_translation,
             const transform::Rigid2d& initial_pose_estimate,
             const sensor::PointCloud& point_cloud, const Grid2D& grid,
             transform::Rigid2d* pose_estimate,
             ceres::Solver::Summary* summary) const;

 private:
  std::unique_ptr<const StockCeresScanMatcher2D> stock_;
  std::unique_ptr<
      const ::cartographer_ext::scan_matching::DegeneracyAwareScanMatcher2D>
      degeneracy_aware_;
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_CERES_SCAN_MATCHER_2D_H_
#endif
