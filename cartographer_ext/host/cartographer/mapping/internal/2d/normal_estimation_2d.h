// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Options only: this host reads them, as Lua files name them, but builds no
// grid that would need normals.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_NORMAL_ESTIMATION_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_NORMAL_ESTIMATION_2D_H_

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/proto/normal_estimation_options_2d.pb.h"

namespace cartographer {
namespace mapping {

// Reads `num_normal_samples` and `sample_radius` (metres), both positive.
proto::NormalEstimationOptions2D CreateNormalEstimationOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_NORMAL_ESTIMATION_2D_H_
