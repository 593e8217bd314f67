// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How sure local SLAM is of where a node lies in its submap, and what that
// makes of the constraint between the two.
//
// Cartographer gives all of these constraints the same two weights. In a
// corridor the scans leave the way open, and a submap is known less and less
// along it the further the robot goes from where the submap began. The
// covariance of that is followed from scan to scan,
//
//   predicted   P' = P + Q            Q: covariance of the motion
//   matched     P  = (P'^-1 + L)^-1   L: information of the scan alone
//
// from zero at the first scan of a submap. Against the covariance C that the
// constant weights stand for, the part of their information that is left is
// C^1/2 P^-1 C^1/2, its eigenvalues between `min_ratio` and 1: no node is made
// surer than before.
#ifndef CARTOGRAPHER_EXT_FRONT_END_NODE_WEIGHTS_H_
#define CARTOGRAPHER_EXT_FRONT_END_NODE_WEIGHTS_H_

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

enum class NodeWeightForm {
  kFull,        // each direction by itself
  kTwoScalars,  // a factor for the way and one for the turn
};

struct NodeWeightOptions {
  bool enabled = false;
  NodeWeightForm form = NodeWeightForm::kFull;
  double translation_sigma = 0.01;  // metres, > 0
  double rotation_sigma = 0.002;    // radians, > 0
  double min_ratio = 1e-4;          // in (0, 1]
};

// Standard deviations that stand for a covariance of (x, y, theta): of the
// worst direction of translation (metres), and of the rotation (radians).
Eigen::Vector2d TwoSigmas(const Eigen::Matrix3d& covariance);

// The part of the information that is left, as above: no unit, symmetric,
// positive definite. `covariance` of (x, y, theta) in the frame of the submap.
// Not finite or not positive semi-definite: `min_ratio` in every direction.
Eigen::Matrix3d RelativeInformation(const NodeWeightOptions& options,
                                    const Eigen::Matrix3d& covariance);

// The covariance of the newest scan in the frame in which one submap began.
class ScanUncertainty {
 public:
  // `motion` is the covariance of the motion since the last scan that was
  // kept, `scan` the information of the match alone; both in the local frame,
  // about (x, y, theta). What is not finite counts as nothing known.
  void Add(const Eigen::Matrix3d& motion, const Eigen::Matrix3d& scan);
  // From now on motions are since the scan that was added last.
  void Keep() { kept_ = newest_; }

  const Eigen::Matrix3d& covariance() const { return newest_; }

 private:
  Eigen::Matrix3d kept_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d newest_ = Eigen::Matrix3d::Zero();
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_NODE_WEIGHTS_H_
