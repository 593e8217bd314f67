// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The host maps in 2D, but Lua files written for Cartographer also hold the 3D
// tables, and a table that is there must be read. These functions read them
// into the messages that 3D SLAM would use.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_3D_OPTIONS_3D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_3D_OPTIONS_3D_H_

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_3d.pb.h"
#include "cartographer/mapping/proto/scan_matching/ceres_scan_matcher_options_3d.pb.h"
#include "cartographer/mapping/proto/scan_matching/fast_correlative_scan_matcher_options_3d.pb.h"

namespace cartographer {
namespace mapping {

namespace scan_matching {

proto::FastCorrelativeScanMatcherOptions3D
CreateFastCorrelativeScanMatcherOptions3D(
    common::LuaParameterDictionary* parameter_dictionary);

proto::CeresScanMatcherOptions3D CreateCeresScanMatcherOptions3D(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace scan_matching

proto::LocalTrajectoryBuilderOptions3D CreateLocalTrajectoryBuilderOptions3D(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_3D_OPTIONS_3D_H_
