// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/loop_evidence.h"

#include <algorithm>
#include <cmath>

#include "Eigen/LU"

namespace cartographer_ext {
namespace optimization {

double LogArea(const std::vector<Pose2>& poses) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Pose2& pose : poses) mean += pose.translation();
  mean /= poses.size();
  double sum = 0.;
  for (const Pose2& pose : poses) {
    sum += (pose.translation() - mean).squaredNorm();
  }
  return std::log(kPi * std::max(1e-6, 2. * sum / poses.size()));
}

double LogVolume(const WhitenedEdge& edge, const double log_area) {
  return log_area + std::log(2. * kPi) +
         std::log(std::abs(edge.whitening.determinant())) -
         1.5 * std::log(2. * kPi);
}

double LogEvidence(const WhitenedEdge& edge, const Innovation& innovation,
                   const double log_area) {
  return LogVolume(edge, log_area) -
         0.5 * (innovation.chi2 + innovation.log_determinant);
}

double ChanceToFit(const WhitenedEdge& edge, const double log_area,
                   const double gate, const double log_determinant) {
  const double log_ball =
      std::log(4. / 3. * kPi) + 1.5 * std::log(gate / (2. * kPi));
  return std::exp(std::min(
      0., log_ball + 0.5 * log_determinant - LogVolume(edge, log_area)));
}

}  // namespace optimization
}  // namespace cartographer_ext
