// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"

#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

proto::RealTimeCorrelativeScanMatcherOptions
CreateRealTimeCorrelativeScanMatcherOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  common::LuaParameterDictionary& lua = *parameter_dictionary;
  proto::RealTimeCorrelativeScanMatcherOptions options;
  options.set_linear_search_window(lua.GetDouble("linear_search_window"));
  options.set_angular_search_window(lua.GetDouble("angular_search_window"));
  options.set_translation_delta_cost_weight(
      lua.GetDouble("translation_delta_cost_weight"));
  options.set_rotation_delta_cost_weight(
      lua.GetDouble("rotation_delta_cost_weight"));
  CHECK_GE(options.translation_delta_cost_weight(), 0.);
  CHECK_GE(options.rotation_delta_cost_weight(), 0.);
  return options;
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
