// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path: the stock factory
// becomes StockCreateLocalTrajectoryBuilderOptions2D, and the one of the
// original name also reads our block.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER) || \
    defined(CreateLocalTrajectoryBuilderOptions2D)
// Not selected, or this is the stock source with its function renamed.
#include_next "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_OPTIONS_2D_H_
#define CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_OPTIONS_2D_H_

#define CreateLocalTrajectoryBuilderOptions2D \
  StockCreateLocalTrajectoryBuilderOptions2D
#include_next "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"
#undef CreateLocalTrajectoryBuilderOptions2D

namespace cartographer {
namespace mapping {

proto::LocalTrajectoryBuilderOptions2D CreateLocalTrajectoryBuilderOptions2D(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_OPTIONS_2D_H_
#endif
