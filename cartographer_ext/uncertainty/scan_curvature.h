// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Curvature of the cost of a scan around its match, and the motions along which
// it is small.
//
// The Gauss-Newton Hessian, sum of grad c grad c^T, does not distinguish a
// blank wall from a structured one: the cells of a wall differ by noise and
// quantisation, each of these differences has a gradient along the wall, and
// their squares add up. Measured on simulated corridors, the Hessian along a
// blank wall is 0.4 times that across it. The cost itself does not have this
// problem: if the scan is moved along a blank wall by two cells, its cost does
// not change, because the changes of individual points cancel. So the curvature
// is measured by second differences over a step of s cells,
//
//   e(v) = (F(+s v) + F(-s v) - 2 F(0)) / s^2,   F = sum of c^2 / (2 n),
//
// which along that wall is 0.02 times that across it.
//
// Motions are scaled to make metres and radians comparable: the scan rotates
// about the centroid of its points, and all three unknowns are measured by the
// displacement of the points in cells (root mean square). This makes the noise
// of e the same for all motions. Axes are found in three steps: the
// eigenvectors of the Hessian; the second differences along and between them,
// which give a 3 x 3 matrix and its eigenvectors; the second differences along
// these. Those between two axes are taken along their diagonals,
//
//   e_kl = (F(u) + F(-u) - F(w) - F(-w)) / (2 s^2),
//   u = s (v_k + v_l) / sqrt 2,   w = s (v_k - v_l) / sqrt 2,
//
// since the cost saturates a few cells away from a wall and is not quadratic.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_SCAN_CURVATURE_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_SCAN_CURVATURE_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace uncertainty {

// Scaled motions (cells, cells, cells at the spread) of a scan at a pose.
class ScaledMotion {
 public:
  // `points` in the frame of the node, metres; `cell` is the resolution of the
  // grid, metres, > 0.
  ScaledMotion(const std::vector<Eigen::Vector2d>& points, double cell,
               const Pose2& pose);

  // The pose after a scaled motion.
  Pose2 Moved(const Eigen::Vector3d& motion) const;
  // Linear part: (dx, dy, dtheta) of the pose per unit of motion.
  const Eigen::Matrix3d& ToPose() const { return to_pose_; }
  const Eigen::Matrix3d& FromPose() const { return from_pose_; }

 private:
  const Pose2 pose_;
  const double cell_;
  Eigen::Vector2d centroid_;  // from the node, in the frame of the grid
  double turn_;               // radians per unit of the third motion
  Eigen::Matrix3d to_pose_;
  Eigen::Matrix3d from_pose_;
};

// Curvatures of the cost at a pose along three orthogonal axes.
struct ScanCurvature {
  // Ascending; squared cost per squared cell, mean over the points. Negative if
  // the match is not at a minimum.
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  // 2 (F(s v) - F(0)) / s^2 towards the side where F rises more: the curvature
  // at a minimum. If a prior holds the scan on the slope beside the minimum,
  // the curvature may vanish but not the rise; along a blank wall both vanish.
  Eigen::Vector3d rises = Eigen::Vector3d::Zero();
  // Unit vectors of scaled motion, as columns.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

// `half_mean_squares(motion)` is F at a scaled motion, `hessian` any symmetric
// matrix whose eigenvectors are near the axes, in scaled motions. `step` in
// cells, > 0. F is evaluated 25 times.
template <typename Function>
ScanCurvature MeasureCurvature(const Function& half_mean_squares,
                               const Eigen::Matrix3d& hessian, double step);

namespace internal {

// Eigenvectors of a symmetric matrix as columns; the identity when it is not
// finite.
Eigen::Matrix3d Axes(const Eigen::Matrix3d& symmetric);

// Puts the axes in ascending order of values.
void Sort(ScanCurvature* curvature);

// (F(+step) + F(-step) - 2 F(0)) / |step|^2.
template <typename Function>
double SecondDifference(const Function& function, const double at_zero,
                        const Eigen::Vector3d& step) {
  return (function(step) + function(-step) - 2. * at_zero) / step.squaredNorm();
}

}  // namespace internal

template <typename Function>
ScanCurvature MeasureCurvature(const Function& half_mean_squares,
                               const Eigen::Matrix3d& hessian,
                               const double step) {
  ScanCurvature curvature;
  curvature.axes = internal::Axes(hessian);
  const double at_zero = half_mean_squares(Eigen::Vector3d(0., 0., 0.));
  Eigen::Matrix3d matrix;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = curvature.axes.col(k);
    matrix(k, k) =
        internal::SecondDifference(half_mean_squares, at_zero, step * axis);
    for (int l = 0; l < k; ++l) {
      const Eigen::Vector3d other = curvature.axes.col(l);
      const Eigen::Vector3d u = std::sqrt(0.5) * step * (axis + other);
      const Eigen::Vector3d w = std::sqrt(0.5) * step * (axis - other);
      matrix(k, l) = matrix(l, k) =
          (half_mean_squares(u) + half_mean_squares(-u) - half_mean_squares(w) -
           half_mean_squares(-w)) /
          (2. * step * step);
    }
  }
  curvature.axes = curvature.axes * internal::Axes(matrix);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d motion = step * curvature.axes.col(k);
    const double ahead = half_mean_squares(motion) - at_zero;
    const double behind = half_mean_squares(-motion) - at_zero;
    curvature.values(k) = (ahead + behind) / (step * step);
    curvature.rises(k) = 2. * std::max(ahead, behind) / (step * step);
  }
  internal::Sort(&curvature);
  return curvature;
}

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_SCAN_CURVATURE_H_
