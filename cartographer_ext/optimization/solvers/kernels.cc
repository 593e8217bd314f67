// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/kernels.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Eigenvalues"
#include "Eigen/LU"
#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace optimization {

KernelOptions DefaultKernel(const KernelType type) {
  KernelOptions options;
  options.type = type;
  switch (type) {
    case KernelType::kHuber:
      options.parameter = 1.345;
      break;
    case KernelType::kAcs:
    case KernelType::kTruncated:
      options.parameter = kChi2Gate;
      break;
    default:
      options.parameter = 1.;
  }
  return options;
}

absl::StatusOr<KernelType> KernelTypeFromName(const absl::string_view name) {
  for (const KernelType type :
       {KernelType::kNone, KernelType::kHuber, KernelType::kGemanMcClure,
        KernelType::kDcs, KernelType::kAcs, KernelType::kAcsPaper,
        KernelType::kTruncated}) {
    if (name == KernelName(type)) return type;
  }
  return absl::InvalidArgumentError(
      absl::StrCat("unknown kernel '", name,
                   "', expected none, huber, gm, dcs, acs, acs_paper or tls"));
}

std::string KernelName(const KernelType type) {
  switch (type) {
    case KernelType::kNone:
      return "none";
    case KernelType::kHuber:
      return "huber";
    case KernelType::kGemanMcClure:
      return "gm";
    case KernelType::kDcs:
      return "dcs";
    case KernelType::kAcs:
      return "acs";
    case KernelType::kAcsPaper:
      return "acs_paper";
    case KernelType::kTruncated:
      return "tls";
  }
  return "";
}

absl::StatusOr<CovarianceNorm> CovarianceNormFromName(
    const absl::string_view name) {
  if (name == "spectral") return CovarianceNorm::kSpectral;
  if (name == "determinant") return CovarianceNorm::kDeterminant;
  if (name == "root") return CovarianceNorm::kRoot;
  if (name == "information") return CovarianceNorm::kInformation;
  return absl::InvalidArgumentError(
      absl::StrCat("unknown norm '", name,
                   "', expected spectral, determinant, root or information"));
}

KernelValue EvaluateKernel(const KernelOptions& kernel, const double chi2,
                           const double shape) {
  const double p = kernel.parameter;
  KernelValue value;
  value.rho = chi2;
  switch (kernel.type) {
    case KernelType::kNone:
      break;
    case KernelType::kHuber:
      if (chi2 > p * p) {
        const double root = std::sqrt(chi2);
        value.rho = 2. * p * root - p * p;
        value.weight = p / root;
      }
      break;
    case KernelType::kGemanMcClure: {
      const double s = p / (p + chi2);
      value.rho = s * chi2;
      value.weight = s * s;
      break;
    }
    case KernelType::kDcs:
      if (chi2 > p) {
        const double s = 2. * p / (p + chi2);
        value.rho = p * (3. * chi2 - p) / (chi2 + p);
        value.weight = s * s;
      }
      break;
    case KernelType::kAcs:
    case KernelType::kAcsPaper: {
      const double root = std::sqrt(shape);
      const double s = 1. / (1. + shape * chi2 * chi2);
      // atan(u)/u -> 1 for u -> 0.
      const double u = root * chi2;
      value.rho =
          0.5 * chi2 * s + (u > 1e-8 ? 0.5 * std::atan(u) / root : 0.5 * chi2);
      value.weight = s * s;
      break;
    }
    case KernelType::kTruncated:
      if (chi2 > p) {
        value.rho = p;
        value.weight = 0.;
      }
      break;
  }
  return value;
}

double AcsPaperShape(const double chi2, const double unweighted_squared_error,
                     const double covariance_norm) {
  if (!(chi2 > 1e-300)) return covariance_norm;
  return unweighted_squared_error * covariance_norm / chi2;
}

double NormOfCovariance(const Eigen::Matrix3d& information,
                        const CovarianceNorm norm) {
  switch (norm) {
    case CovarianceNorm::kSpectral:
      return 1. / Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                      information, Eigen::EigenvaluesOnly)
                      .eigenvalues()[0];
    case CovarianceNorm::kDeterminant:
      return 1. / information.determinant();
    case CovarianceNorm::kRoot:
      return 1. / std::cbrt(information.determinant());
    case CovarianceNorm::kInformation:
      return information.determinant();
  }
  return 1.;
}

double GncTlsWeight(const double chi2, const double c, const double mu) {
  if (chi2 <= mu / (mu + 1.) * c) return 1.;
  if (chi2 >= (mu + 1.) / mu * c) return 0.;
  return std::min(1., std::max(0., std::sqrt(c * mu * (mu + 1.) / chi2) - mu));
}

}  // namespace optimization
}  // namespace cartographer_ext
