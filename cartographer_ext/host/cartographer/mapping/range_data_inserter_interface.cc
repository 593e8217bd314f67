// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/range_data_inserter_interface.h"

#include <string>

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "cartographer/mapping/internal/2d/tsdf_range_data_inserter_2d.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::RangeDataInserterOptions CreateRangeDataInserterOptions(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::RangeDataInserterOptions>(table);
  *options.mutable_probability_grid_range_data_inserter_options_2d() =
      common::ReadTable(table, "probability_grid_range_data_inserter",
                        &CreateProbabilityGridRangeDataInserterOptions2D);
  *options.mutable_tsdf_range_data_inserter_options_2d() = common::ReadTable(
      table, "tsdf_range_data_inserter", &CreateTSDFRangeDataInserterOptions2D);
  return options;
}

}  // namespace mapping
}  // namespace cartographer
