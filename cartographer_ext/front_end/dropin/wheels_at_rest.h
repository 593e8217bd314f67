// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a robot has moved whose wheels say that it has not, ever since the start.
//
// Such odometry may be dead (motion_predictor.h), so it does not hold the matches,
// and what the matches take for motion ends its use. But robots stand before they
// drive, and outdoors a laser may see nothing but somebody who passes: the scans
// fit a robot that turns the other way round. What one object says is therefore no
// motion: without it (PoseEvidence::AgainstWithoutObject) the scan must still be
// likelier where it was matched than where the robot stood.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_WHEELS_AT_REST_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_WHEELS_AT_REST_H_

#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/dropin/local_match.h"
#include "cartographer_ext/front_end/motion_predictor.h"

namespace cartographer_ext {
namespace front_end {

// `match`, or where the wheels left the robot if they have never moved and the scan
// does not show that it has. `last_pose`: (local <- robot) at the scan before.
LocalMatch UnlessAtRest(const Pose2& last_pose,
                        const MotionPrediction& prediction,
                        const LocalMatch& match,
                        const cartographer::sensor::PointCloud& cloud,
                        const cartographer::mapping::Grid2D& grid);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_WHEELS_AT_REST_H_
