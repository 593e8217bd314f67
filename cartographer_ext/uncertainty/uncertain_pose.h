// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Relative poses with covariance, and how errors propagate through their
// composition.
//
// One frame convention holds everywhere. The error e = (x, y, theta) of an
// estimate z of a relative pose (a <- b) applies on its right, that is, in the
// frame of its end b:
//
//   truth = z Exp(e),   e ~ N(0, C)
//
// This is the convention of g2o, of GTSAM's BetweenFactor and of Cartographer's
// constraints (Konolige et al., "Efficient sparse pose adjustment for 2D
// mapping", IROS 2010): the inverse of C is the information matrix that they
// expect. To first order Exp(e) is the pose (x, y, theta).
//
// An error in frame b is Ad(a <- b) e in frame a, with the adjoint
//
//             | cos  -sin   y |
//   Ad(z)  =  | sin   cos  -x |      of z = (x, y, theta).
//             |  0     0    1 |
//
// Hence, for independent errors,
//
//   (a <- c) = (a <- b)(b <- c)   C_ac = Ad(c <- b) C_ab Ad(c <- b)^T + C_bc
//   (b <- a) = (a <- b)^-1        C_ba = Ad(a <- b) C_ab Ad(a <- b)^T
//
// For example, one degree of error in the heading of (a <- b), followed by ten
// metres straight ahead, puts c off by 17 cm to the side.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_UNCERTAIN_POSE_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_UNCERTAIN_POSE_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace uncertainty {

// A relative pose (a <- b) with the covariance of its error in frame b; x, y in
// metres, theta in radians.
struct UncertainPose {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// Standard deviation of the translation of a pose in the worst direction, metres.
double WorstTranslationSigma(const Eigen::Matrix3d& covariance);

// The adjoint of (a <- b): maps an error in frame b to the same error in frame
// a.
Eigen::Matrix3d Adjoint(const Pose2& pose);

// (a <- c) = (a <- b)(b <- c) of poses with independent errors.
UncertainPose Compose(const UncertainPose& lhs, const UncertainPose& rhs);

// (b <- a) from (a <- b).
UncertainPose Invert(const UncertainPose& pose);

// (a <- b) from (m <- a) and (m <- b) with independent errors.
UncertainPose Between(const UncertainPose& a, const UncertainPose& b);

// Computes the inverse and returns true if `covariance` is finite and positive
// definite; otherwise returns false.
bool InvertCovariance(const Eigen::Matrix3d& covariance,
                      Eigen::Matrix3d* information);

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_UNCERTAIN_POSE_H_
