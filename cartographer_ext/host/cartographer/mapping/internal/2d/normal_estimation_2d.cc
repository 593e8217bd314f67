// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/normal_estimation_2d.h"

#include "cartographer/common/internal/read_options.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::NormalEstimationOptions2D CreateNormalEstimationOptions2D(
    common::LuaParameterDictionary* const table) {
  const auto options =
      common::ReadOptions<proto::NormalEstimationOptions2D>(table);
  CHECK_GT(options.num_normal_samples(), 0);
  CHECK_GT(options.sample_radius(), 0.f);
  return options;
}

}  // namespace mapping
}  // namespace cartographer
