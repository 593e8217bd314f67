// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What local SLAM doubts of the step from one node to the next. A match that is
// wrong with probability p leaves its scan about where the prediction put it, so
// that of the prediction's covariance a share of p is left, added up over the scans
// of the step,
//
//   D_k = Ad(m_k^-1) D_(k-1) Ad(m_k^-1)^T + p_k P_k,
//
// with the motion m_k since the scan before and P_k in the frame of its end
// (uncertain_pose.h). Where odometry bridges a gap (wheel_reckoning.h), the error of
// the step is that of the gap, whatever the match says: there may be nothing that
// it could be matched with.
#ifndef CARTOGRAPHER_EXT_FRONT_END_STEP_DOUBT_H_
#define CARTOGRAPHER_EXT_FRONT_END_STEP_DOUBT_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/step_error.h"

namespace cartographer_ext {
namespace front_end {

// The sum above. Not thread-safe.
class StepDoubt {
 public:
  // A scan. `motion`: (robot at the last scan <- robot now); `covariance`: of its
  // prediction, in the frame of the robot at the last scan; `probability`: of a
  // wrong match, 0 to 1, which counts as far as a search would cover.
  void Add(const Pose2& motion, const Eigen::Matrix3d& covariance,
           double probability, bool bridges_gap);
  // Since the last call, in the frame of the robot now; begins anew.
  uncertainty::StepError Take();

 private:
  uncertainty::StepError sum_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_STEP_DOUBT_H_
