// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/search_prior.h"

#include <cmath>

#include "Eigen/Cholesky"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Scores of one place differ by about this much from scan to scan.
constexpr double kScoreNoise = 0.02;

}  // namespace

double SearchVolume(const double linear_window, const double angular_window) {
  const double width = 2. * linear_window;
  return width * width * 2. * angular_window;
}

double PredictedDensity(const Pose2& displacement,
                        const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d error(displacement.x, displacement.y,
                              NormalizeAngle(displacement.theta));
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  const Eigen::Matrix3d lower = factor.matrixL();
  return std::exp(-0.5 * error.dot(factor.solve(error))) /
         (std::pow(2. * kPi, 1.5) * lower.diagonal().prod());
}

double TrueDensity(const double predicted, const double otherwise_predicted,
                   const double search_density) {
  return 0.5 * (1. - kUnexpectedShare) * (predicted + otherwise_predicted) +
         kUnexpectedShare * search_density;
}

double LogLikelihoodOfMatch(const double score, const double predicted_density,
                            const double search_density) {
  return score / kScoreNoise +
         std::log((1. - kUnexpectedShare) * predicted_density +
                  kUnexpectedShare * search_density);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
