// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_MATH_H_
#define CARTOGRAPHER_COMMON_MATH_H_

#include <cmath>

#include "Eigen/Core"
#include "cartographer/common/port.h"

namespace cartographer {
namespace common {

template <typename T>
T Clamp(const T value, const T min, const T max) {
  return value < min ? min : (max < value ? max : value);
}

// `exponent` >= 0.
template <typename T>
constexpr T Power(T base, int exponent) {
  return exponent == 0 ? T(1) : Power(base, exponent - 1) * base;
}

template <typename T>
constexpr T Pow2(T a) {
  return a * a;
}

constexpr double DegToRad(double degrees) { return degrees * M_PI / 180.; }
constexpr double RadToDeg(double radians) { return radians * 180. / M_PI; }

// Adds turns until the angle is in [-pi, pi]. Works for automatic
// differentiation types. Takes a bounded number of steps: far angles lose
// several turns at once; infinities and NaN come back as they are.
template <typename T>
T NormalizeAngleDifference(T difference) {
  if (!(difference - difference == T(0.))) return difference;
  const T pi = T(M_PI);
  while (difference > pi || difference < -pi) {
    const bool positive = difference > pi;
    T turns = T(2. * M_PI);
    while ((positive ? difference : -difference) > 2. * turns) turns *= T(2.);
    difference -= positive ? turns : -turns;
  }
  return difference;
}

// Direction of a vector, in [-pi, pi].
template <typename T>
T atan2(const Eigen::Matrix<T, 2, 1>& vector) {
  using std::atan2;
  return atan2(vector.y(), vector.x());
}

// Quaternion product zw = z * w of arrays in the order (w, x, y, z), where `z`
// is constant.
template <typename T>
inline void QuaternionProduct(const double* const z, const T* const w,
                              T* const zw) {
  const T product[4] = {w[0] * z[0] - w[1] * z[1] - w[2] * z[2] - w[3] * z[3],
                        w[1] * z[0] + w[0] * z[1] + w[3] * z[2] - w[2] * z[3],
                        w[2] * z[0] - w[3] * z[1] + w[0] * z[2] + w[1] * z[3],
                        w[3] * z[0] + w[2] * z[1] - w[1] * z[2] + w[0] * z[3]};
  for (int i = 0; i != 4; ++i) zw[i] = product[i];
}

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_MATH_H_
