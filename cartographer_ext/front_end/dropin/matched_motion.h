// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the prediction of motions learns from a match.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_MATCHED_MOTION_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_MATCHED_MOTION_H_

#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/dropin/local_match.h"
#include "cartographer_ext/front_end/motion_predictor.h"

namespace cartographer_ext {
namespace front_end {

// The motion from `last_pose`, (local <- robot), to the match of `cloud`,
// without what the map says of it.
MatchedMotion ToMatchedMotion(const Pose2& last_pose,
                              const MotionPrediction& prediction,
                              const LocalMatch& match,
                              const cartographer::sensor::PointCloud& cloud);

// Along the direction of translation that the scan determines best, and of the
// heading where only wheels predicted it; nothing where the scan determines none,
// or where a search (of which there is one for every scan where they are far
// apart) was left with a match beyond `gate`.
MatchInnovation InnovationOf(const Pose2& last_pose,
                             const MotionPrediction& prediction,
                             const LocalMatch& match, double gate);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_MATCHED_MOTION_H_
