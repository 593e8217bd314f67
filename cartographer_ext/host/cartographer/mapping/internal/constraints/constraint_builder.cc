// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/constraints/constraint_builder.h"

#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/3d/options_3d.h"

namespace cartographer {
namespace mapping {
namespace constraints {

proto::ConstraintBuilderOptions CreateConstraintBuilderOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  common::LuaParameterDictionary& lua = *parameter_dictionary;
  proto::ConstraintBuilderOptions options;
  // Which candidates are tried, and which matches count.
  options.set_sampling_ratio(lua.GetDouble("sampling_ratio"));
  options.set_max_constraint_distance(lua.GetDouble("max_constraint_distance"));
  options.set_min_score(lua.GetDouble("min_score"));
  options.set_global_localization_min_score(
      lua.GetDouble("global_localization_min_score"));
  // What a match weighs.
  options.set_loop_closure_translation_weight(
      lua.GetDouble("loop_closure_translation_weight"));
  options.set_loop_closure_rotation_weight(
      lua.GetDouble("loop_closure_rotation_weight"));
  options.set_log_matches(lua.GetBool("log_matches"));
  *options.mutable_fast_correlative_scan_matcher_options() =
      scan_matching::CreateFastCorrelativeScanMatcherOptions2D(
          lua.GetDictionary("fast_correlative_scan_matcher").get());
  *options.mutable_fast_correlative_scan_matcher_options_3d() =
      scan_matching::CreateFastCorrelativeScanMatcherOptions3D(
          lua.GetDictionary("fast_correlative_scan_matcher_3d").get());
  *options.mutable_ceres_scan_matcher_options() =
      scan_matching::CreateCeresScanMatcherOptions2D(
          lua.GetDictionary("ceres_scan_matcher").get());
  *options.mutable_ceres_scan_matcher_options_3d() =
      scan_matching::CreateCeresScanMatcherOptions3D(
          lua.GetDictionary("ceres_scan_matcher_3d").get());
  return options;
}

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer
