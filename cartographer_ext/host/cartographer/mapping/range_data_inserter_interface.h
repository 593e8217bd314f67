// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_RANGE_DATA_INSERTER_INTERFACE_H_
#define CARTOGRAPHER_MAPPING_RANGE_DATA_INSERTER_INTERFACE_H_

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/grid_interface.h"
#include "cartographer/mapping/proto/range_data_inserter_options.pb.h"
#include "cartographer/sensor/range_data.h"

namespace cartographer {
namespace mapping {

// Reads `range_data_inserter_type` and the tables of both kinds of inserter,
// whichever is chosen.
proto::RangeDataInserterOptions CreateRangeDataInserterOptions(
    common::LuaParameterDictionary* parameter_dictionary);

class RangeDataInserterInterface {
 public:
  virtual ~RangeDataInserterInterface() = default;

  // `range_data` is in the frame of the grid (local SLAM frame), metres.
  virtual void Insert(const sensor::RangeData& range_data,
                      GridInterface* grid) const = 0;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_RANGE_DATA_INSERTER_INTERFACE_H_
