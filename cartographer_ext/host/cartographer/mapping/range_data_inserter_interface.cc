// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/range_data_inserter_interface.h"

#include <string>

#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "cartographer/mapping/internal/2d/tsdf_range_data_inserter_2d.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::RangeDataInserterOptions CreateRangeDataInserterOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  proto::RangeDataInserterOptions options;
  const std::string type_name =
      parameter_dictionary->GetString("range_data_inserter_type");
  proto::RangeDataInserterOptions::RangeDataInserterType type;
  CHECK(proto::RangeDataInserterOptions::RangeDataInserterType_Parse(type_name,
                                                                     &type))
      << "range_data_inserter_type: there is no inserter '" << type_name
      << "'; use PROBABILITY_GRID_INSERTER_2D.";
  options.set_range_data_inserter_type(type);

  const auto probability_grid_dictionary = parameter_dictionary->GetDictionary(
      "probability_grid_range_data_inserter");
  *options.mutable_probability_grid_range_data_inserter_options_2d() =
      CreateProbabilityGridRangeDataInserterOptions2D(
          probability_grid_dictionary.get());
  const auto tsdf_dictionary =
      parameter_dictionary->GetDictionary("tsdf_range_data_inserter");
  *options.mutable_tsdf_range_data_inserter_options_2d() =
      CreateTSDFRangeDataInserterOptions2D(tsdf_dictionary.get());
  return options;
}

}  // namespace mapping
}  // namespace cartographer
