// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What local SLAM knows of the error of one of its steps from node to node.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_STEP_ERROR_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_STEP_ERROR_H_

#include "Eigen/Core"
#include "absl/types/optional.h"

namespace cartographer_ext {
namespace uncertainty {

// Covariances in the frame of the end of the step, as in uncertain_pose.h.
struct StepError {
  // Added to the usual error of a step: its match may be wrong.
  Eigen::Matrix3d doubt = Eigen::Matrix3d::Zero();
  // Of dead reckoning, where the step bridges a gap between scans. A long step
  // without it is a jump that may have any error.
  absl::optional<Eigen::Matrix3d> bridged;

  bool is_usual() const { return !bridged.has_value() && doubt.isZero(0.); }
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_STEP_ERROR_H_
