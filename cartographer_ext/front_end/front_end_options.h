// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From the option message of local SLAM to the options of its parts.
#ifndef CARTOGRAPHER_EXT_FRONT_END_FRONT_END_OPTIONS_H_
#define CARTOGRAPHER_EXT_FRONT_END_FRONT_END_OPTIONS_H_

#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end/point_cloud/adaptive_features.h"
#include "cartographer_ext/front_end/point_cloud/wall_filling.h"
#include "cartographer_ext/front_end_options.pb.h"

namespace cartographer_ext {
namespace front_end {

MotionPredictorOptions ToMotionPredictorOptions(
    const proto::FrontEndOptions& options);
AdaptiveFeatureOptions ToAdaptiveFeatureOptions(
    const proto::FrontEndOptions& options);
// `resolution` of the grid, metres. If disabled, max_gap is 0.
WallFillingOptions ToWallFillingOptions(const proto::FrontEndOptions& options,
                                        double resolution);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_FRONT_END_OPTIONS_H_
