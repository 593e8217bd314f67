// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Dead reckoning by the wheels alone, over a gap between scans: a laser of short
// range that crosses a square, a scanner that was away for a minute.
//
// Between two scans the correction of the calibration (odometry_calibration.h) may
// be applied to the motion as a whole, as on an arc. Over tens of metres it may
// not: each step from reading to reading is corrected, and the steps are composed.
// Their errors are of three kinds:
//
//   * of the calibration, the same in every step. With b_k the effects of its
//     three parameters on step k, they add B P B^T, where P is the covariance of
//     the parameters and B the sum of the b_k, transported to the end;
//   * of the wheels, independent from step to step: a random walk whose variance
//     grows with the length of the path;
//   * of faults that no scan could notice: as many per metre as there were where
//     scans did notice them, each of the size of a short slip.
//
// Covariances are transported as in uncertain_pose.h.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_WHEEL_RECKONING_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_WHEEL_RECKONING_H_

#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace front_end {

// Motion over successive steps, each (robot <- robot at the next reading) as
// received. `faults_per_metre` of odometry, see above.
struct ReckonedMotion {
  uncertainty::UncertainPose motion;  // (start <- end)
  double length = 0.;                 // of the path, metres
};
ReckonedMotion ReckonByWheels(const std::vector<Pose2>& steps,
                              const OdometryCalibration& calibration,
                              double faults_per_metre);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_WHEEL_RECKONING_H_
