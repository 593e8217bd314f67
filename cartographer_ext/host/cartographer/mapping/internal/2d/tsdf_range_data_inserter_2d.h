// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Options only: Lua files always carry them, but this host builds no TSDF
// submaps (see CreateSubmapsOptions2D).
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_TSDF_RANGE_DATA_INSERTER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_TSDF_RANGE_DATA_INSERTER_2D_H_

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/proto/tsdf_range_data_inserter_options_2d.pb.h"

namespace cartographer {
namespace mapping {

proto::TSDFRangeDataInserterOptions2D CreateTSDFRangeDataInserterOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_TSDF_RANGE_DATA_INSERTER_2D_H_
