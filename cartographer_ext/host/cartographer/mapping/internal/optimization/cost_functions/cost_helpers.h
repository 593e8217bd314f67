// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors and interpolation shared by cost functions; all work on plain doubles
// and on Jets. Poses in the plane are (x, y, theta), quaternions (w, x, y, z).
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_COST_HELPERS_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_COST_HELPERS_H_

#include <array>
#include <cmath>
#include <tuple>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/math.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "ceres/jet.h"

namespace cartographer {
namespace mapping {
namespace optimization {

// relative_pose minus (start^-1 * end), the angle wrapped to [-pi, pi].
template <typename T>
std::array<T, 3> ComputeUnscaledError(const transform::Rigid2d& relative_pose,
                                      const T* const start,
                                      const T* const end) {
  using std::cos;
  using std::sin;
  const T c = cos(start[2]);
  const T s = sin(start[2]);
  const T dx = end[0] - start[0];
  const T dy = end[1] - start[1];
  const T angle_error =
      T(relative_pose.rotation().angle()) - (end[2] - start[2]);
  return {{T(relative_pose.translation().x()) - (c * dx + s * dy),
           T(relative_pose.translation().y()) - (c * dy - s * dx),
           common::NormalizeAngleDifference(angle_error)}};
}

// The same in space: three translations in the start frame, then the rotation
// from the actual to the measured relative rotation as an angle-axis vector.
template <typename T>
std::array<T, 6> ComputeUnscaledError(const transform::Rigid3d& relative_pose,
                                      const T* const start_rotation,
                                      const T* const start_translation,
                                      const T* const end_rotation,
                                      const T* const end_translation) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Quaternion = Eigen::Quaternion<T>;
  const auto quaternion = [](const T* const q) {
    return Quaternion(q[0], q[1], q[2], q[3]);
  };
  const Quaternion start = quaternion(start_rotation);
  const Quaternion end = quaternion(end_rotation);
  const Vector moved(end_translation[0] - start_translation[0],
                     end_translation[1] - start_translation[1],
                     end_translation[2] - start_translation[2]);
  const Vector translation_error =
      relative_pose.translation().cast<T>() - start.conjugate() * moved;
  const Quaternion start_from_end_inverse = end.conjugate() * start;
  const Quaternion rotation_error =
      start_from_end_inverse * relative_pose.rotation().cast<T>();
  const Vector angle_axis =
      transform::RotationQuaternionToAngleAxisVector(rotation_error);
  return {{translation_error[0], translation_error[1], translation_error[2],
           angle_axis[0], angle_axis[1], angle_axis[2]}};
}

template <typename T>
std::array<T, 3> ScaleError(const std::array<T, 3>& error,
                            double translation_weight, double rotation_weight) {
  return {{error[0] * translation_weight, error[1] * translation_weight,
           error[2] * rotation_weight}};
}

template <typename T>
std::array<T, 6> ScaleError(const std::array<T, 6>& error,
                            double translation_weight, double rotation_weight) {
  return {{error[0] * translation_weight, error[1] * translation_weight,
           error[2] * translation_weight, error[3] * rotation_weight,
           error[4] * rotation_weight, error[5] * rotation_weight}};
}

// Spherical interpolation along the shorter arc; linear where the two are so
// close that the arc's sine loses its digits. factor 0 is start, 1 is end.
template <typename T>
std::array<T, 4> SlerpQuaternions(const T* const start, const T* const end,
                                  double factor) {
  using std::acos;
  using std::sin;
  T cosine = start[0] * end[0] + start[1] * end[1] + start[2] * end[2] +
             start[3] * end[3];
  const double sign = cosine < T(0.) ? -1. : 1.;
  cosine = cosine * sign;
  T from_start(1. - factor);
  T from_end(factor);
  if (cosine < T(1. - 1e-5)) {
    const T angle = acos(cosine);
    const T sine = sin(angle);
    from_start = sin((1. - factor) * angle) / sine;
    from_end = sin(factor * angle) / sine;
  }
  from_end = from_end * sign;
  std::array<T, 4> result;
  for (int i = 0; i < 4; ++i) {
    result[i] = from_start * start[i] + from_end * end[i];
  }
  return result;
}

// The pose of the tracking frame between two poses in space.
template <typename T>
std::tuple<std::array<T, 4> /* rotation */, std::array<T, 3> /* translation */>
InterpolateNodes3D(const T* const prev_node_rotation,
                   const T* const prev_node_translation,
                   const T* const next_node_rotation,
                   const T* const next_node_translation,
                   const double interpolation_parameter) {
  std::array<T, 3> translation;
  for (int i = 0; i < 3; ++i) {
    translation[i] = prev_node_translation[i] +
                     interpolation_parameter *
                         (next_node_translation[i] - prev_node_translation[i]);
  }
  return std::make_tuple(
      SlerpQuaternions(prev_node_rotation, next_node_rotation,
                       interpolation_parameter),
      translation);
}

// The same between two nodes in the plane, given their gravity alignment.
template <typename T>
std::tuple<std::array<T, 4> /* rotation */, std::array<T, 3> /* translation */>
InterpolateNodes2D(const T* const prev_node_pose,
                   const Eigen::Quaterniond& prev_node_gravity_alignment,
                   const T* const next_node_pose,
                   const Eigen::Quaterniond& next_node_gravity_alignment,
                   const double interpolation_parameter) {
  const auto tracking_rotation =
      [](const T& yaw, const Eigen::Quaterniond& gravity_alignment) {
        const Eigen::Quaternion<T> q =
            (Eigen::AngleAxis<T>(yaw, Eigen::Matrix<T, 3, 1>::UnitZ()) *
             gravity_alignment.cast<T>())
                .normalized();
        return std::array<T, 4>{{q.w(), q.x(), q.y(), q.z()}};
      };
  const std::array<T, 4> prev_rotation =
      tracking_rotation(prev_node_pose[2], prev_node_gravity_alignment);
  const std::array<T, 4> next_rotation =
      tracking_rotation(next_node_pose[2], next_node_gravity_alignment);
  const std::array<T, 3> prev_translation{
      {prev_node_pose[0], prev_node_pose[1], T(0.)}};
  const std::array<T, 3> next_translation{
      {next_node_pose[0], next_node_pose[1], T(0.)}};
  return InterpolateNodes3D(prev_rotation.data(), prev_translation.data(),
                            next_rotation.data(), next_translation.data(),
                            interpolation_parameter);
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_COST_HELPERS_H_
