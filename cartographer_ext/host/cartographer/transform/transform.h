// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_TRANSFORM_TRANSFORM_H_
#define CARTOGRAPHER_TRANSFORM_TRANSFORM_H_

#include <cmath>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/math.h"
#include "cartographer/transform/proto/transform.pb.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace transform {

// The angle of the rotation, in [0, pi].
template <typename FloatType>
FloatType GetAngle(const Rigid3<FloatType>& transform) {
  const Eigen::Quaternion<FloatType>& q = transform.rotation();
  return FloatType(2) * std::atan2(q.vec().norm(), std::abs(q.w()));
}

// Where the rotated x axis points to, seen from above.
template <typename T>
T GetYaw(const Eigen::Quaternion<T>& rotation) {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const Vector3 ahead = rotation * Vector3::UnitX();
  using std::atan2;
  return atan2(ahead.y(), ahead.x());
}

template <typename T>
T GetYaw(const Rigid3<T>& transform) {
  return GetYaw(transform.rotation());
}

// Axis times angle, the angle in [0, pi].
template <typename T>
Eigen::Matrix<T, 3, 1> RotationQuaternionToAngleAxisVector(
    const Eigen::Quaternion<T>& quaternion) {
  using std::atan2;
  using std::sin;
  const Eigen::Quaternion<T> unit = quaternion.normalized();
  // q and -q are the same rotation; the one with w >= 0 turns by at most pi.
  const T sign = unit.w() < T(0.) ? T(-1.) : T(1.);
  const Eigen::Matrix<T, 3, 1> axis_part = sign * unit.vec();
  const T angle = T(2.) * atan2(axis_part.norm(), sign * unit.w());
  // Near zero angle / sin(angle / 2) tends to 2.
  if (angle < T(1e-7)) return T(2.) * axis_part;
  return (angle / sin(angle / T(2.))) * axis_part;
}

// Inverse of the above.
template <typename T>
Eigen::Quaternion<T> AngleAxisVectorToRotationQuaternion(
    const Eigen::Matrix<T, 3, 1>& angle_axis) {
  using std::cos;
  using std::sin;
  const T squared_angle = angle_axis.squaredNorm();
  if (!(squared_angle > T(1e-8))) {
    const Eigen::Matrix<T, 3, 1> half = T(0.5) * angle_axis;
    return {T(1.), half.x(), half.y(), half.z()};
  }
  const T angle = angle_axis.norm();
  const Eigen::Matrix<T, 3, 1> xyz = (sin(angle / T(2.)) / angle) * angle_axis;
  return {cos(angle / T(2.)), xyz.x(), xyz.y(), xyz.z()};
}

// Drops z, roll and pitch.
template <typename T>
Rigid2<T> Project2D(const Rigid3<T>& transform) {
  return {transform.translation().template head<2>(),
          Eigen::Rotation2D<T>(GetYaw(transform))};
}

template <typename T>
Rigid3<T> Embed3D(const Rigid2<T>& transform) {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const auto& xy = transform.translation();
  return {Vector3(xy.x(), xy.y(), T(0)),
          Eigen::AngleAxis<T>(transform.rotation().angle(), Vector3::UnitZ())};
}

Rigid2d ToRigid2(const proto::Rigid2d& transform);
Rigid3d ToRigid3(const proto::Rigid3d& rigid);

Eigen::Vector2d ToEigen(const proto::Vector2d& vector);
Eigen::Vector3f ToEigen(const proto::Vector3f& vector);
Eigen::Vector4f ToEigen(const proto::Vector4f& vector);
Eigen::Vector3d ToEigen(const proto::Vector3d& vector);
Eigen::Quaterniond ToEigen(const proto::Quaterniond& quaternion);

proto::Rigid2d ToProto(const Rigid2d& transform);
proto::Rigid2f ToProto(const Rigid2f& transform);
proto::Rigid3d ToProto(const Rigid3d& rigid);
proto::Rigid3f ToProto(const Rigid3f& rigid);

proto::Vector2d ToProto(const Eigen::Vector2d& vector);
proto::Vector3f ToProto(const Eigen::Vector3f& vector);
proto::Vector4f ToProto(const Eigen::Vector4f& vector);
proto::Vector3d ToProto(const Eigen::Vector3d& vector);
proto::Quaternionf ToProto(const Eigen::Quaternionf& quaternion);
proto::Quaterniond ToProto(const Eigen::Quaterniond& quaternion);

}  // namespace transform
}  // namespace cartographer

#endif  // CARTOGRAPHER_TRANSFORM_TRANSFORM_H_
