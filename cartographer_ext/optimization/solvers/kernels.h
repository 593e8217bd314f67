// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Robust kernels for loop edges, all as iteratively reweighted least squares:
// an edge with squared Mahalanobis error z = chi2 contributes rho(z) to the
// objective and enters each linear solve with weight omega = rho'(z). The
// papers speak of a switch s in [0, 1] which scales the residual, so omega =
// s^2.
//
//   none    rho = z
//
//   Huber   rho = z                       up to b^2,
//                 2 b sqrt(z) - b^2       beyond
//
//   SC      Switchable constraints with s eliminated from s^2 z + w (1 - s)^2
//           [ACS eq. 7, 8]:
//             s   = w / (w + z)
//             rho = w z / (w + z)
//           This is the kernel of Geman and McClure, exactly.
//
//   DCS     s   = min(1, 2 P / (P + z))
//           rho = z                       up to P,
//                 P (3 z - P) / (z + P)   beyond
//
//   ACS     The ACS paper makes w a function of the error [ACS eq. 12, 13],
//             w = 1 / (chi' |L|)
//             s = 1 / (1 + chi2 chi' |L|)
//           with chi' the same error without its metric and |L| a norm of the
//           covariance. Taken literally s depends on the unit of length. The
//           dimensionless form replaces chi' |L| by chi2 / c^2:
//             s   = 1 / (1 + (z / c)^2)
//             rho = z / (2 (1 + k z^2)) + atan(sqrt(k) z) / (2 sqrt(k))
//             k   = 1 / c^2
//           and c is the 99 % quantile of chi2, so s = 1/2 exactly at the gate.
//           The literal form has the same rho with k = chi' |L| / chi2, which
//           is constant for an isotropic covariance and is otherwise held
//           during one iteration. As an objective, eq. (14) of the paper with
//           (12) inserted would reward violating every loop; only this form
//           is a consistent objective.
//
//   TLS     rho = min(z, c), the target of graduated non-convexity.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_KERNELS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_KERNELS_H_

#include <string>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace optimization {

// 99 % quantile of chi2 with three degrees of freedom: the gate which decides
// whether an error is compatible with its information matrix.
constexpr double kChi2Gate = 11.344866730144373;

// The kernels above.
enum class KernelType {
  kNone,
  kHuber,
  kGemanMcClure,
  kDcs,
  kAcs,
  kAcsPaper,
  kTruncated,
};

// The meaning of |Lambda| of the ACS paper, which does not define it.
enum class CovarianceNorm {
  kSpectral,     // largest eigenvalue of the covariance (the default)
  kDeterminant,  // det(covariance)
  kRoot,         // det(covariance)^(1/3)
  kInformation,  // det(information): the matrix of the g2o file taken as Lambda
};

// A kernel with its parameter.
struct KernelOptions {
  KernelType type = KernelType::kNone;
  // Huber: b. Geman-McClure: w. DCS: P. ACS and TLS: c. Not used otherwise.
  double parameter = 1.;
  CovarianceNorm norm = CovarianceNorm::kSpectral;  // kAcsPaper
};

// The kernel with its usual parameter: Huber b = 1.345, w = 1, P = 1, c =
// kChi2Gate.
KernelOptions DefaultKernel(KernelType type);

// "none", "huber", "gm", "dcs", "acs", "acs_paper", "tls".
absl::StatusOr<KernelType> KernelTypeFromName(absl::string_view name);
// The name of a kernel, see KernelTypeFromName.
std::string KernelName(KernelType type);
// "spectral", "determinant", "root", "information".
absl::StatusOr<CovarianceNorm> CovarianceNormFromName(absl::string_view name);

// Value and derivative of a kernel.
struct KernelValue {
  double rho = 0.;     // contribution to the objective
  double weight = 1.;  // d rho / d chi2, in [0, 1]
};

// `shape` is k of the ACS kernels (see AcsShape) and ignored by all others.
KernelValue EvaluateKernel(const KernelOptions& kernel, double chi2,
                           double shape);

// k of the dimensionless kernel: 1 / c^2.
inline double AcsShape(const KernelOptions& kernel) {
  return 1. / (kernel.parameter * kernel.parameter);
}

// k of the literal kernel: chi' |Lambda| / chi2 (its limit for chi2 -> 0 is not
// unique unless the covariance is isotropic; there the weight is 1 whatever k).
double AcsPaperShape(double chi2, double unweighted_squared_error,
                     double covariance_norm);

// |Lambda| of an edge with this information matrix.
double NormOfCovariance(const Eigen::Matrix3d& information,
                        CovarianceNorm norm);

// Weight of graduated non-convexity with truncated least squares at control
// parameter mu (Yang et al. 2020, eq. 14), c the truncation of chi2.
double GncTlsWeight(double chi2, double c, double mu);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_KERNELS_H_
