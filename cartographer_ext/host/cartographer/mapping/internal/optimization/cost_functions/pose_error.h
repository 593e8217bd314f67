// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The residuals of relative pose measurements, in the plane and in space, for
// plain numbers and for Jets. In both, translations are compared in the frame
// of the first body, weighted, and followed by the weighted rotation error.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_POSE_ERROR_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_POSE_ERROR_H_

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/math.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "ceres/jet.h"

namespace cartographer {
namespace mapping {
namespace optimization {

// Square roots of information: 1/m and 1/rad.
struct ErrorWeights {
  double translation;
  double rotation;
};

// A pose in space that Ceres may differentiate.
template <typename T>
struct SpatialPose {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Quaternion = Eigen::Quaternion<T>;

  Quaternion rotation;
  Vector translation;

  // The tracking frame of a node whose pose in the plane is (x, y, theta).
  static SpatialPose OfNode(const T* const planar,
                            const Eigen::Quaterniond& gravity_alignment) {
    const Eigen::AngleAxis<T> heading(planar[2], Vector::UnitZ());
    return SpatialPose{
        (heading * gravity_alignment.template cast<T>()).normalized(),
        Vector(planar[0], planar[1], T(0.))};
  }

  // From parameter blocks (w, x, y, z) and (x, y, z).
  static SpatialPose OfBlocks(const T* const wxyz, const T* const xyz) {
    return SpatialPose{Quaternion(wxyz[0], wxyz[1], wxyz[2], wxyz[3]),
                       Eigen::Map<const Vector>(xyz)};
  }
};

// Moves at constant velocity from `first` (fraction 0) to `second` (1), turning
// along the shorter arc:
//   q(f) = q_1 Exp(f Log(q_1^-1 q_2)).
template <typename T>
SpatialPose<T> InterpolatePoses(const SpatialPose<T>& first,
                                const SpatialPose<T>& second,
                                const double fraction) {
  const Eigen::Matrix<T, 3, 1> whole_turn =
      transform::RotationQuaternionToAngleAxisVector<T>(
          first.rotation.conjugate() * second.rotation);
  return SpatialPose<T>{
      first.rotation * transform::AngleAxisVectorToRotationQuaternion<T>(
                           whole_turn * T(fraction)),
      first.translation +
          (second.translation - first.translation) * T(fraction)};
}

// measured - (start^-1 end) for poses (x, y, theta); the angle is wrapped to
// [-pi, pi].
template <typename T>
Eigen::Matrix<T, 3, 1> PlanarError(const transform::Rigid2d& measured,
                                   const ErrorWeights& weights,
                                   const T* const start, const T* const end) {
  using Point = Eigen::Matrix<T, 2, 1>;
  const Point moved =
      Eigen::Map<const Point>(end) - Eigen::Map<const Point>(start);
  Eigen::Matrix<T, 3, 1> error;
  error.template head<2>() =
      (measured.translation().cast<T>() -
       Eigen::Rotation2D<T>(start[2]).inverse() * moved) *
      T(weights.translation);
  const T turned = end[2] - start[2];
  error[2] = common::NormalizeAngleDifference<T>(
                 T(measured.rotation().angle()) - turned) *
             T(weights.rotation);
  return error;
}

// The same in space. The rotation error is the rotation vector that leads from
// the actual relative rotation to the measured one.
template <typename T>
Eigen::Matrix<T, 6, 1> SpatialError(const transform::Rigid3d& measured,
                                    const ErrorWeights& weights,
                                    const SpatialPose<T>& start,
                                    const SpatialPose<T>& end) {
  const Eigen::Quaternion<T> start_from_map = start.rotation.conjugate();
  const Eigen::Quaternion<T> actual = start_from_map * end.rotation;
  Eigen::Matrix<T, 6, 1> error;
  error.template head<3>() =
      (measured.translation().cast<T>() -
       start_from_map * (end.translation - start.translation)) *
      T(weights.translation);
  error.template tail<3>() =
      transform::RotationQuaternionToAngleAxisVector<T>(
          actual.conjugate() * measured.rotation().template cast<T>()) *
      T(weights.rotation);
  return error;
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_POSE_ERROR_H_
