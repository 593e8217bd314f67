// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Covariance and information matrices of planar poses, 3x3: x, y in metres and
// the heading in radians.
#ifndef CARTOGRAPHER_EXT_COMMON_PLANAR_MATRIX_H_
#define CARTOGRAPHER_EXT_COMMON_PLANAR_MATRIX_H_

#include <cmath>

#include "Eigen/Core"

namespace cartographer_ext {

// Rotation R of a frame b by `angle` (radians) relative to a: a covariance C in
// b is R C R^T in a, one in a is R^T C R in b. The heading is unchanged.
inline Eigen::Matrix3d PlanarRotation(const double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  result.topLeftCorner<2, 2>() << c, -s, s, c;
  return result;
}

// The symmetric part, to remove rounding errors.
inline Eigen::Matrix3d Symmetric(const Eigen::Matrix3d& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_PLANAR_MATRIX_H_
