// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_mixture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "Eigen/LU"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;

double LogPosterior(const std::array<MixtureComponent, 2>& components,
                    const Eigen::Vector2d& scores) {
  const double a = LogWeightedDensity(components[0], scores);
  const double b = LogWeightedDensity(components[1], scores);
  const double top = std::max(a, b);
  return top + std::log(std::exp(a - top) + std::exp(b - top));
}

double Responsibility(const std::array<MixtureComponent, 2>& components,
                      const Eigen::Vector2d& scores) {
  const double log_false = LogWeightedDensity(components[0], scores);
  const double log_true = LogWeightedDensity(components[1], scores);
  return 1. / (1. + std::exp(log_false - log_true));
}

}  // namespace

std::array<MixtureComponent, 2> LoopMixtureOptions::DefaultPrior() {
  std::array<MixtureComponent, 2> prior;
  prior[0].weight = 0.5;
  prior[0].mean = Eigen::Vector2d(0.60, 0.50);
  prior[0].covariance = Eigen::Vector2d(0.08 * 0.08, 0.20 * 0.20).asDiagonal();
  prior[1].weight = 0.5;
  prior[1].mean = Eigen::Vector2d(0.66, 0.82);
  prior[1].covariance = Eigen::Vector2d(0.09 * 0.09, 0.10 * 0.10).asDiagonal();
  return prior;
}

double LogWeightedDensity(const MixtureComponent& component,
                          const Eigen::Vector2d& scores) {
  const Eigen::Vector2d difference = scores - component.mean;
  const double mahalanobis =
      difference.dot(component.covariance.inverse() * difference);
  return std::log(component.weight) - kLogTwoPi -
         0.5 * std::log(component.covariance.determinant()) - 0.5 * mahalanobis;
}

LoopMixture::LoopMixture(const LoopMixtureOptions& options)
    : options_(options), components_(options.prior) {
  CHECK_GT(options.capacity, 0);
  CHECK_GT(options.prior_strength, 0.);
}

double LoopMixture::ProbabilityTrue(const double grid_score,
                                    const double temporal_score) const {
  return Responsibility(components_,
                        Eigen::Vector2d(grid_score, temporal_score));
}

void LoopMixture::Add(const double grid_score, const double temporal_score) {
  scores_.emplace_back(grid_score, temporal_score);
  if (scores_.size() > static_cast<size_t>(options_.capacity)) {
    scores_.pop_front();
  }
}

int LoopMixture::Fit() {
  const double strength = options_.prior_strength;
  const double n = static_cast<double>(scores_.size());
  if (scores_.empty()) return 0;
  std::vector<double> of_true(scores_.size());
  double last = -std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    // Expectation.
    double total = 0.;
    for (size_t i = 0; i < scores_.size(); ++i) {
      of_true[i] = Responsibility(components_, scores_[i]);
      total += LogPosterior(components_, scores_[i]);
    }
    total /= n;
    if (std::abs(total - last) < options_.tolerance) return iteration;
    last = total;
    // Maximisation with the priors as pseudo-observations.
    for (int c = 0; c < 2; ++c) {
      const MixtureComponent& prior = options_.prior[c];
      double mass = strength;
      Eigen::Vector2d mean = strength * prior.mean;
      for (size_t i = 0; i < scores_.size(); ++i) {
        const double r = c == 1 ? of_true[i] : 1. - of_true[i];
        mass += r;
        mean += r * scores_[i];
      }
      mean /= mass;
      Eigen::Matrix2d scatter = strength * prior.covariance;
      scatter +=
          strength * (prior.mean - mean) * (prior.mean - mean).transpose();
      for (size_t i = 0; i < scores_.size(); ++i) {
        const double r = c == 1 ? of_true[i] : 1. - of_true[i];
        const Eigen::Vector2d difference = scores_[i] - mean;
        scatter += r * difference * difference.transpose();
      }
      components_[c].weight = mass / (n + 2. * strength);
      components_[c].mean = mean;
      components_[c].covariance = scatter / mass;
    }
    // "True" is the component with the better scores, by definition.
    for (int d = 0; d < 2; ++d) {
      if (components_[1].mean(d) < components_[0].mean(d)) {
        const double middle =
            0.5 * (components_[0].mean(d) + components_[1].mean(d));
        components_[0].mean(d) = middle;
        components_[1].mean(d) = middle;
      }
    }
  }
  return options_.max_iterations;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
