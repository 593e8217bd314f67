// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/pose_solver.h"

namespace cartographer_ext {
namespace scan_matching {

bool SolveDamped(const Eigen::Matrix3d& hessian, const Eigen::Vector3d& damping,
                 const Eigen::Vector3d& gradient, Eigen::Vector3d* const step) {
  Eigen::Vector3d scale = hessian.diagonal() + damping;
  for (int i = 0; i < 3; ++i) {
    if (!(scale(i) > 0.) || !std::isfinite(scale(i))) return false;
    scale(i) = 1. / std::sqrt(scale(i));
  }
  // The scaled matrix [1 a b; a 1 c; b c 1] = L D L^T.
  const double a = hessian(1, 0) * scale(0) * scale(1);
  const double b = hessian(2, 0) * scale(0) * scale(2);
  const double c = hessian(2, 1) * scale(1) * scale(2);
  const double d1 = 1. - a * a;
  if (!(d1 > 1e-14)) return false;
  const double l21 = (c - a * b) / d1;
  const double d2 = 1. - b * b - l21 * l21 * d1;
  if (!(d2 > 1e-14)) return false;
  const Eigen::Vector3d rhs = -gradient.cwiseProduct(scale);
  const double y0 = rhs(0);
  const double y1 = rhs(1) - a * y0;
  const double y2 = rhs(2) - b * y0 - l21 * y1;
  const double x2 = y2 / d2;
  const double x1 = y1 / d1 - l21 * x2;
  const double x0 = y0 - a * x1 - b * x2;
  *step = Eigen::Vector3d(x0, x1, x2).cwiseProduct(scale);
  return step->allFinite();
}

}  // namespace scan_matching
}  // namespace cartographer_ext
