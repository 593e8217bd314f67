// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/path_agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "Eigen/LU"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/verification/search_prior.h"
#include "cartographer_ext/uncertainty/drift_estimator.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Three standard deviations to both sides, in each of three directions.
constexpr double kWindow = 216.;

// Logarithms of the factors at which the posterior is computed; each represents
// its cell.
constexpr double kFirstLevel = -6.;
constexpr double kLevelStep = 0.25;
constexpr int kNumLevels = 33;

// No loop is certain to be right: one that is impossible for a factor would rule
// it out.
constexpr double kMostProbable = 0.99;

double LogOfLevel(const int level) { return kFirstLevel + kLevelStep * level; }

}  // namespace

PathAgreement AgreementWithPath(const uncertainty::PathUncertainty& paths,
                                const uncertainty::LoopEdge& loop,
                                const double search_density) {
  PathAgreement agreement;
  if (search_density <= 0.) return agreement;
  const absl::optional<uncertainty::UncertainPose> path =
      paths.Between(loop.a, loop.b);
  if (!path.has_value()) return agreement;
  const InnovationResult innovation =
      TestInnovation(InnovationOptions().chi_square_bound, *path, loop.pose);
  const double volume =
      kWindow * std::sqrt(std::max(0., innovation.covariance.determinant()));
  if (volume == 0. || !std::isfinite(innovation.chi_square)) return agreement;
  agreement.length = *paths.Travelled(loop.a, loop.b);
  agreement.chi_square = innovation.chi_square;
  agreement.wrong_density = std::min(1., search_density * volume);
  return agreement;
}

double FactorOfPath(const double factor, const double length) {
  return length <= kLongPath ? 1. : std::max(factor, kLongPath / length);
}

double DensityOfRight(const PathAgreement& agreement, const double factor) {
  const double variance = FactorOfPath(factor, agreement.length);
  return kWindow / std::pow(2. * kPi * variance, 1.5) *
         std::exp(-0.5 * agreement.chi_square / variance);
}

double OddsByPath(const PathAgreement& agreement, const double factor) {
  return (1. - kUnexpectedShare) * DensityOfRight(agreement, factor) /
             agreement.wrong_density +
         kUnexpectedShare;
}

double LearnPathFactor(const std::vector<PathSample>& samples) {
  const uncertainty::DriftEstimatorOptions prior;
  std::array<double, kNumLevels> mass;
  for (int level = 0; level < kNumLevels; ++level) {
    // Of the standard deviation.
    const double log_factor = 0.5 * LogOfLevel(level);
    const double offset =
        (log_factor - prior.prior_translation) / prior.prior_sigma;
    mass[level] = -0.5 * offset * offset;
    for (const PathSample& sample : samples) {
      const double density =
          DensityOfRight(sample.agreement, std::exp(LogOfLevel(level)));
      const double right = std::min(kMostProbable, sample.probability);
      mass[level] += sample.share *
                     std::log(right * density +
                              (1. - right) * sample.agreement.wrong_density);
    }
  }
  const double most = *std::max_element(mass.begin(), mass.end());
  double total = 0.;
  for (double& value : mass) {
    value = std::exp(value - most);
    total += value;
  }
  double sum = 0.;
  int level = 0;
  while (level < kNumLevels - 1) {
    sum += mass[level];
    if (sum >= prior.upper_quantile * total) break;
    ++level;
  }
  return std::min(1., std::exp(LogOfLevel(level) + 0.5 * kLevelStep));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
