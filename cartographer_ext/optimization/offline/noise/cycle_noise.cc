// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/cycle_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/thinned.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Evenly chosen ones take milliseconds.
constexpr size_t kMaxCycles = 300;
// Of expectation and maximisation, for the share.
constexpr int kMixtureRounds = 30;
constexpr double kLeastShare = 1e-3;
// Half powers of two.
constexpr int kFirstStep = -1;
constexpr int kLastStep = 10;

// Logarithm of the density of the error of a right one.
double LogDensity(const LoopCycle& cycle, const double odometry,
                  const double loops) {
  const Eigen::Matrix3d covariance =
      odometry * odometry * cycle.of_odometry + loops * loops * cycle.of_loops;
  const Eigen::LLT<Eigen::Matrix3d> root(covariance);
  return -0.5 * cycle.error.dot(root.solve(cycle.error)) -
         root.matrixLLT().diagonal().array().log().sum() -
         1.5 * std::log(2. * kPi);
}

// The share of right ones that is the likeliest, and the logarithm of its likelihood.
double Mix(const std::vector<double>& densities, const double anywhere,
           double* const share) {
  *share = 0.5;
  double result = 0.;
  for (int round = 0; round != kMixtureRounds; ++round) {
    double right = 0.;
    for (const double density : densities) {
      const double of_right = *share * density;
      const double both = of_right + (1. - *share) * anywhere;
      right += of_right / both;
      if (round + 1 == kMixtureRounds) result += std::log(both);
    }
    *share = std::min(1. - kLeastShare,
                      std::max(kLeastShare, right / densities.size()));
  }
  return result;
}

}  // namespace

CycleNoise FindCycleNoise(const std::vector<LoopCycle>& all) {
  CycleNoise result;
  const std::vector<LoopCycle> cycles = Thinned(all, kMaxCycles);
  if (cycles.empty()) return result;
  result.log_likelihood = -std::numeric_limits<double>::infinity();
  double sum = 0.;
  for (const LoopCycle& cycle : cycles) {
    sum += cycle.error.head<2>().squaredNorm();
  }
  const double anywhere =
      1. / (4. * kPi * kPi * std::max(1e-6, sum / cycles.size()));
  std::vector<double> densities(cycles.size());
  for (int o = kFirstStep; o <= kLastStep; ++o) {
    for (int l = kFirstStep; l <= kLastStep; ++l) {
      const double odometry = std::exp2(-0.5 * o);
      const double loops = std::exp2(-0.5 * l);
      for (size_t i = 0; i != cycles.size(); ++i) {
        densities[i] = std::exp(LogDensity(cycles[i], odometry, loops));
      }
      double share = 0.;
      const double likelihood = Mix(densities, anywhere, &share);
      if (o == 0 && l == 0) result.of_given = likelihood;
      if (likelihood <= result.log_likelihood) continue;
      result.log_likelihood = likelihood;
      result.odometry = odometry;
      result.loops = loops;
      result.share = share;
    }
  }
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
