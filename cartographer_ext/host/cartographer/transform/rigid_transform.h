// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_TRANSFORM_RIGID_TRANSFORM_H_
#define CARTOGRAPHER_TRANSFORM_RIGID_TRANSFORM_H_

#include <array>
#include <cmath>
#include <iostream>
#include <string>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "absl/strings/substitute.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/math.h"
#include "cartographer/common/port.h"

namespace cartographer {
namespace transform {

// A pose in the plane. As (a <- b) it maps points of frame b into frame a.
template <typename FloatType>
class Rigid2 {
 public:
  using Vector = Eigen::Matrix<FloatType, 2, 1>;
  using Rotation2D = Eigen::Rotation2D<FloatType>;

  Rigid2() : Rigid2(Vector::Zero(), Rotation2D::Identity()) {}
  Rigid2(const Vector& translation, const Rotation2D& rotation)
      : translation_(translation), rotation_(rotation) {}
  // `rotation` in radians.
  Rigid2(const Vector& translation, const double rotation)
      : Rigid2(translation, Rotation2D(rotation)) {}

  static Rigid2 Identity() { return Rigid2(); }
  static Rigid2 Rotation(const double rotation) {
    return Rigid2(Vector::Zero(), rotation);
  }
  static Rigid2 Rotation(const Rotation2D& rotation) {
    return Rigid2(Vector::Zero(), rotation);
  }
  static Rigid2 Translation(const Vector& vector) {
    return Rigid2(vector, Rotation2D::Identity());
  }

  template <typename OtherType>
  Rigid2<OtherType> cast() const {
    return {translation_.template cast<OtherType>(),
            rotation_.template cast<OtherType>()};
  }

  const Vector& translation() const { return translation_; }
  Rotation2D rotation() const { return rotation_; }
  // In [-pi, pi].
  double normalized_angle() const {
    return common::NormalizeAngleDifference(rotation_.angle());
  }

  Rigid2 inverse() const {
    const Rotation2D back = rotation_.inverse();
    return Rigid2(-(back * translation_), back);
  }

  std::string DebugString() const {
    return absl::Substitute("{ t: [$0, $1], r: [$2] }", translation_.x(),
                            translation_.y(), rotation_.angle());
  }

 private:
  Vector translation_;
  Rotation2D rotation_;
};

// The angle of the product is not wrapped.
template <typename FloatType>
Rigid2<FloatType> operator*(const Rigid2<FloatType>& lhs,
                            const Rigid2<FloatType>& rhs) {
  return {lhs * rhs.translation(), lhs.rotation() * rhs.rotation()};
}

template <typename FloatType>
typename Rigid2<FloatType>::Vector operator*(
    const Rigid2<FloatType>& rigid,
    const typename Rigid2<FloatType>::Vector& point) {
  return rigid.rotation() * point + rigid.translation();
}

template <typename T>
std::ostream& operator<<(std::ostream& os, const Rigid2<T>& rigid) {
  return os << rigid.DebugString();
}

using Rigid2d = Rigid2<double>;
using Rigid2f = Rigid2<float>;

// A pose in space, with a unit quaternion.
template <typename FloatType>
class Rigid3 {
 public:
  using Vector = Eigen::Matrix<FloatType, 3, 1>;
  using Quaternion = Eigen::Quaternion<FloatType>;
  using AngleAxis = Eigen::AngleAxis<FloatType>;

  Rigid3() : Rigid3(Vector::Zero(), Quaternion::Identity()) {}
  Rigid3(const Vector& translation, const Quaternion& rotation)
      : translation_(translation), rotation_(rotation) {}
  Rigid3(const Vector& translation, const AngleAxis& rotation)
      : Rigid3(translation, Quaternion(rotation)) {}

  static Rigid3 Identity() { return Rigid3(); }
  static Rigid3 Rotation(const AngleAxis& angle_axis) {
    return Rigid3(Vector::Zero(), angle_axis);
  }
  static Rigid3 Rotation(const Quaternion& rotation) {
    return Rigid3(Vector::Zero(), rotation);
  }
  static Rigid3 Translation(const Vector& vector) {
    return Rigid3(vector, Quaternion::Identity());
  }
  // `rotation` is (w, x, y, z).
  static Rigid3 FromArrays(const std::array<FloatType, 4>& rotation,
                           const std::array<FloatType, 3>& translation) {
    return Rigid3(
        Vector(translation[0], translation[1], translation[2]),
        Quaternion(rotation[0], rotation[1], rotation[2], rotation[3]));
  }

  template <typename OtherType>
  Rigid3<OtherType> cast() const {
    return {translation_.template cast<OtherType>(),
            rotation_.template cast<OtherType>()};
  }

  const Vector& translation() const { return translation_; }
  const Quaternion& rotation() const { return rotation_; }

  Rigid3 inverse() const {
    const Quaternion back = rotation_.conjugate();
    return Rigid3(-(back * translation_), back);
  }

  std::string DebugString() const {
    return absl::Substitute("{ t: [$0, $1, $2], q: [$3, $4, $5, $6] }",
                            translation_.x(), translation_.y(),
                            translation_.z(), rotation_.w(), rotation_.x(),
                            rotation_.y(), rotation_.z());
  }

  // No NaN, and a quaternion of length 1 within 1e-3.
  bool IsValid() const {
    return !translation_.hasNaN() &&
           std::abs(rotation_.norm() - FloatType(1)) < FloatType(1e-3);
  }

 private:
  Vector translation_;
  Quaternion rotation_;
};

// The quaternion of the product is renormalised.
template <typename FloatType>
Rigid3<FloatType> operator*(const Rigid3<FloatType>& lhs,
                            const Rigid3<FloatType>& rhs) {
  return {lhs * rhs.translation(),
          (lhs.rotation() * rhs.rotation()).normalized()};
}

template <typename FloatType>
typename Rigid3<FloatType>::Vector operator*(
    const Rigid3<FloatType>& rigid,
    const typename Rigid3<FloatType>::Vector& point) {
  return rigid.rotation() * point + rigid.translation();
}

template <typename T>
std::ostream& operator<<(std::ostream& os, const Rigid3<T>& rigid) {
  return os << rigid.DebugString();
}

using Rigid3d = Rigid3<double>;
using Rigid3f = Rigid3<float>;

// Rotation about x by `roll`, then y by `pitch`, then z by `yaw`, all about the
// fixed axes; radians.
Eigen::Quaterniond RollPitchYaw(double roll, double pitch, double yaw);

// Reads `translation` (3 numbers) and `rotation`, which is either an array of
// roll, pitch and yaw or a table of w, x, y, z.
Rigid3d FromDictionary(common::LuaParameterDictionary* dictionary);

}  // namespace transform
}  // namespace cartographer

#endif  // CARTOGRAPHER_TRANSFORM_RIGID_TRANSFORM_H_
