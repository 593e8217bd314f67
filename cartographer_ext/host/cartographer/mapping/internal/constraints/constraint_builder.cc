// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/constraints/constraint_builder.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/3d/options_3d.h"

namespace cartographer {
namespace mapping {
namespace constraints {

proto::ConstraintBuilderOptions CreateConstraintBuilderOptions(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::ConstraintBuilderOptions>(table);
  *options.mutable_fast_correlative_scan_matcher_options() = common::ReadTable(
      table, "fast_correlative_scan_matcher",
      &scan_matching::CreateFastCorrelativeScanMatcherOptions2D);
  *options.mutable_ceres_scan_matcher_options() =
      common::ReadTable(table, "ceres_scan_matcher",
                        &scan_matching::CreateCeresScanMatcherOptions2D);
  // Read for the sake of stock configurations.
  *options.mutable_fast_correlative_scan_matcher_options_3d() =
      common::ReadTable(
          table, "fast_correlative_scan_matcher_3d",
          &scan_matching::CreateFastCorrelativeScanMatcherOptions3D);
  *options.mutable_ceres_scan_matcher_options_3d() =
      common::ReadTable(table, "ceres_scan_matcher_3d",
                        &scan_matching::CreateCeresScanMatcherOptions3D);
  return options;
}

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer
