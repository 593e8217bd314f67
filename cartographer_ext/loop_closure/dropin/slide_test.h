// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests whether a scan that was matched in a submap matches equally well
// elsewhere along its least observable direction. A search always returns a
// best pose; for a scan of a single straight wall, its position along the wall
// is arbitrary.
//
// The log-odds of the match against a pose displaced by d are
//
//   L(0) - L(d) + (|o + d|^2 - |o|^2) / (2 sigma^2),
//
// the evidence of the scan (scan_matching/dropin/scan_evidence.h) and that of
// the prediction, whose offset from the match is o.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SLIDE_TEST_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SLIDE_TEST_H_

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace loop_closure {

// The prediction of a pose, in the frame of the grid.
struct PredictedPosition {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double sigma = 0.;  // metres, > 0
};

// The smallest log-odds over displacements of half a metre and of a metre to
// both sides; infinite if no direction is much less observable than the other.
// `pose` is (grid <- cloud), `information` that of the match about it in the
// frame of the grid, 1/m^2 and 1/rad^2.
double SlideOdds(const Pose2& pose, const Eigen::Matrix3d& information,
                 const absl::optional<PredictedPosition>& predicted,
                 const cartographer::sensor::PointCloud& cloud,
                 const cartographer::mapping::Grid2D& grid);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SLIDE_TEST_H_
