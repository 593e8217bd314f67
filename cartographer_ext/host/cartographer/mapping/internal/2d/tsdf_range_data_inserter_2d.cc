// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/tsdf_range_data_inserter_2d.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/2d/normal_estimation_2d.h"

namespace cartographer {
namespace mapping {

proto::TSDFRangeDataInserterOptions2D CreateTSDFRangeDataInserterOptions2D(
    common::LuaParameterDictionary* const table) {
  auto options =
      common::ReadOptions<proto::TSDFRangeDataInserterOptions2D>(table);
  *options.mutable_normal_estimation_options() = common::ReadTable(
      table, "normal_estimation_options", &CreateNormalEstimationOptions2D);
  return options;
}

}  // namespace mapping
}  // namespace cartographer
