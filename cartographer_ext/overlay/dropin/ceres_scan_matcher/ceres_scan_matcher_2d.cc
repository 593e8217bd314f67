// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"

#include "absl/memory/memory.h"
#include "cartographer_ext/options/dropin/lua_options.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/lua_path.h"
#include "cartographer_ext/overlay/signature.h"
#include "cartographer_ext/overlay/start_line.h"
#include "cartographer_ext/scan_matcher_options.pb.h"
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_CERES_SCAN_MATCHER_2D_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

using Stock = StockCeresScanMatcher2D;

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    StockCreateCeresScanMatcherOptions2D,
    proto::CeresScanMatcherOptions2D (*)(common::LuaParameterDictionary*));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::Match,
    void (Stock::*)(const Eigen::Vector2d&, const transform::Rigid2d&,
                    const sensor::PointCloud&, const Grid2D&,
                    transform::Rigid2d*, ceres::Solver::Summary*) const);

}  // namespace

proto::CeresScanMatcherOptions2D CreateCeresScanMatcherOptions2D(
    common::LuaParameterDictionary* const parameter_dictionary) {
  namespace ext = ::cartographer_ext::options;
  proto::CeresScanMatcherOptions2D options =
      StockCreateCeresScanMatcherOptions2D(parameter_dictionary);
  ::cartographer_ext::proto::ScanMatcherOptions extension;
  if (ext::ReadExtension(
          ext::LuaPathOf("ceres_scan_matcher", "TRAJECTORY_BUILDER_2D"),
          parameter_dictionary, &extension)) {
    ext::SetExtension(extension, &options);
  }
  return options;
}

CeresScanMatcher2D::CeresScanMatcher2D(
    const proto::CeresScanMatcherOptions2D& options) {
  ::cartographer_ext::proto::ScanMatcherOptions extension;
  if (::cartographer_ext::options::GetExtension(options, &extension)) {
    ::cartographer_ext::LogStart(
        "CeresScanMatcher2D", "ceres_scan_matcher.cartographer_ext", extension);
    degeneracy_aware_ = absl::make_unique<
        ::cartographer_ext::scan_matching::DegeneracyAwareScanMatcher2D>(
        options, extension);
  } else {
    stock_ = absl::make_unique<Stock>(options);
  }
}

CeresScanMatcher2D::~CeresScanMatcher2D() = default;

void CeresScanMatcher2D::Match(const Eigen::Vector2d& target_translation,
                               const transform::Rigid2d& initial_pose_estimate,
                               const sensor::PointCloud& point_cloud,
                               const Grid2D& grid,
                               transform::Rigid2d* const pose_estimate,
                               ceres::Solver::Summary* const summary) const {
  if (stock_ != nullptr) {
    stock_->Match(target_translation, initial_pose_estimate, point_cloud, grid,
                  pose_estimate, summary);
  } else {
    degeneracy_aware_->Match(target_translation, initial_pose_estimate,
                             point_cloud, grid, pose_estimate, summary);
  }
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
