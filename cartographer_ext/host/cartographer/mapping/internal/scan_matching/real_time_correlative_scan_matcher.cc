// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"

#include "cartographer/common/internal/read_options.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

proto::RealTimeCorrelativeScanMatcherOptions
CreateRealTimeCorrelativeScanMatcherOptions(
    common::LuaParameterDictionary* const table) {
  const auto options =
      common::ReadOptions<proto::RealTimeCorrelativeScanMatcherOptions>(table);
  CHECK_GE(options.translation_delta_cost_weight(), 0.);
  CHECK_GE(options.rotation_delta_cost_weight(), 0.);
  return options;
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
