// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/loop_mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "Eigen/LU"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;

// Keeps the logarithm finite at S_t = 1: one beam in fifty more or less.
constexpr double kCostFloor = 0.02;

// A component with what its density needs worked out.
class Density {
 public:
  explicit Density(const MixtureComponent& component)
      : mean_(component.mean),
        inverse_(component.covariance.inverse()),
        log_factor_(std::log(component.weight) - kLogTwoPi -
                    0.5 * std::log(component.covariance.determinant())) {}

  double Log(const Eigen::Vector2d& scores) const {
    const Eigen::Vector2d difference = scores - mean_;
    return log_factor_ - 0.5 * difference.dot(inverse_ * difference);
  }

 private:
  const Eigen::Vector2d mean_;
  const Eigen::Matrix2d inverse_;
  const double log_factor_;
};

// Up to a constant, log of weight times density of S_g alone.
double LogWeightedGridDensity(const MixtureComponent& component,
                              const double grid_score) {
  const double difference = grid_score - component.mean.x();
  const double variance = component.covariance(0, 0);
  return std::log(component.weight) - 0.5 * std::log(variance) -
         0.5 * difference * difference / variance;
}

MixtureComponent Component(const Eigen::Vector2d& mean, const double sigma_grid,
                           const double sigma_temporal,
                           const double correlation) {
  MixtureComponent component;
  component.weight = 0.5;
  component.mean = mean;
  const double covariance = correlation * sigma_grid * sigma_temporal;
  component.covariance << sigma_grid * sigma_grid, covariance, covariance,
      sigma_temporal * sigma_temporal;
  return component;
}

}  // namespace

double ScoreOfCoordinate(const double coordinate) {
  return 1. + kCostFloor - std::exp(-coordinate);
}

double TemporalCoordinate(const double temporal_score) {
  return -std::log(1. + kCostFloor - std::min(1., temporal_score));
}

std::array<MixtureComponent, 2> LoopMixtureOptions::DefaultPrior() {
  // Scans that see little of the submap have lower scores of both kinds.
  constexpr double kCorrelation = 0.4;
  return {{Component(Eigen::Vector2d(0.64, 1.3), 0.07, 0.5, kCorrelation),
           Component(Eigen::Vector2d(0.72, 2.8), 0.09, 0.5, kCorrelation)}};
}

double LogWeightedDensity(const MixtureComponent& component,
                          const Eigen::Vector2d& scores) {
  return Density(component).Log(scores);
}

LoopMixture::LoopMixture(const LoopMixtureOptions& options)
    : options_(options),
      prior_(options.prior),
      components_(options.prior),
      clutter_density_(options.clutter_density) {
  CHECK_GT(options.capacity, 0);
  CHECK_GT(options.prior_strength, 0.);
  CHECK_GT(options.certain_prior_strength, 0.);
  CHECK_GT(options.clutter_density, 0.);
  CHECK_GT(options.clutter_prior_strength, 0.);
  CHECK_GT(options.likelihood_exponent, 0.);
}

double LoopMixture::ProbabilityTrue(const double grid_score,
                                    const double temporal_score) const {
  const Eigen::Vector2d scores(grid_score, TemporalCoordinate(temporal_score));
  return 1. / (1. + std::exp(LogWeightedDensity(components_[0], scores) -
                             LogWeightedDensity(components_[1], scores)));
}

double LoopMixture::ProbabilityTrue(const double grid_score) const {
  return 1. /
         (1. + std::exp(LogWeightedGridDensity(components_[0], grid_score) -
                        LogWeightedGridDensity(components_[1], grid_score)));
}

double LoopMixture::WrongDensity(const double grid_score,
                                 const double temporal_score) const {
  return clutter_density_ *
         TemperedRatio(
             Eigen::Vector2d(grid_score, TemporalCoordinate(temporal_score)));
}

double LoopMixture::WrongDensity(const double grid_score) const {
  const double log_ratio = LogWeightedGridDensity(components_[0], grid_score) -
                           LogWeightedGridDensity(components_[1], grid_score) -
                           LogWeightRatio();
  return clutter_density_ * std::exp(options_.likelihood_exponent * log_ratio);
}

double LoopMixture::LogWeightRatio() const {
  return std::log(components_[0].weight / components_[1].weight);
}

double LoopMixture::TemperedRatio(const Eigen::Vector2d& scores) const {
  const double log_ratio = LogWeightedDensity(components_[0], scores) -
                           LogWeightedDensity(components_[1], scores) -
                           LogWeightRatio();
  return std::exp(options_.likelihood_exponent * log_ratio);
}

void LoopMixture::Add(const double grid_score, const double temporal_score,
                      const double volume) {
  scores_.emplace_back(grid_score, TemporalCoordinate(temporal_score));
  volumes_.push_back(volume);
  if (scores_.size() > static_cast<size_t>(options_.capacity)) {
    scores_.pop_front();
    volumes_.pop_front();
  }
}

void LoopMixture::AddCertain(const double grid_score,
                             const double temporal_score,
                             const bool has_own_scans) {
  std::deque<Eigen::Vector2d>& scores =
      has_own_scans ? own_scores_ : certain_scores_;
  scores.emplace_back(grid_score, TemporalCoordinate(temporal_score));
  if (scores.size() > static_cast<size_t>(options_.capacity)) {
    scores.pop_front();
  }
}

double LoopMixture::temporal_scale() const {
  return std::min(1., ScoreOfCoordinate(prior_[1].mean.y()) /
                          ScoreOfCoordinate(options_.prior[1].mean.y()));
}

void LoopMixture::UpdatePrior() {
  const MixtureComponent& general = options_.prior[1];
  const double strength = options_.certain_prior_strength;
  std::vector<Eigen::Vector2d> certain(certain_scores_.begin(),
                                       certain_scores_.end());
  for (auto it = own_scores_.rbegin();
       it != own_scores_.rend() &&
       static_cast<double>(certain.size()) < strength;
       ++it) {
    certain.push_back(*it);
  }
  const double mass = strength + static_cast<double>(certain.size());
  MixtureComponent& of_run = prior_[1];
  of_run.mean = strength * general.mean;
  for (const Eigen::Vector2d& scores : certain) of_run.mean += scores;
  of_run.mean /= mass;
  const Eigen::Vector2d shift = general.mean - of_run.mean;
  of_run.covariance =
      strength * (general.covariance + shift * shift.transpose());
  for (const Eigen::Vector2d& scores : certain) {
    const Eigen::Vector2d difference = scores - of_run.mean;
    of_run.covariance += difference * difference.transpose();
  }
  of_run.covariance /= mass;

  const Eigen::Vector2d& wrong = options_.prior[0].mean;
  const double temporal_ratio =
      ScoreOfCoordinate(wrong.y()) / ScoreOfCoordinate(general.mean.y());
  prior_[0].mean =
      Eigen::Vector2d(wrong.x() / general.mean.x() * of_run.mean.x(),
                      TemporalCoordinate(temporal_ratio *
                                         ScoreOfCoordinate(of_run.mean.y())))
          .cwiseMin(wrong);
}

void LoopMixture::FitClutterDensity() {
  // A search of volume V ends at a wrong place with the probability
  // c V / (1 + c V), and r_i is the probability that candidate i is true.
  // Fixed-point iteration for the zero of the derivative of the log-posterior
  // by c,
  //   sum_i ((1 - r_i) / c - V_i / (1 + c V_i)) + a / c - a / c_0.
  constexpr int kIterations = 20;
  std::vector<double> ratios;
  for (const Eigen::Vector2d& scores : scores_) {
    ratios.push_back(TemperedRatio(scores));
  }
  const double a = options_.clutter_prior_strength;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double wrong = a;
    double exposure = a / options_.clutter_density;
    for (size_t i = 0; i < scores_.size(); ++i) {
      const double expected = clutter_density_ * volumes_[i];
      wrong += 1. - 1. / (1. + expected * ratios[i]);
      exposure += volumes_[i] / (1. + expected);
    }
    const double before = clutter_density_;
    clutter_density_ = wrong / exposure;
    if (std::abs(clutter_density_ - before) < options_.tolerance * before) {
      return;
    }
  }
}

int LoopMixture::Fit() {
  if (scores_.empty() && certain_scores_.empty() && own_scores_.empty()) {
    return 0;
  }
  const int iterations = FitComponents();
  FitClutterDensity();
  return iterations;
}

int LoopMixture::FitComponents() {
  const double strength = options_.prior_strength;
  const double n = static_cast<double>(scores_.size());
  UpdatePrior();
  std::vector<double> of_true(scores_.size());
  double last = -std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    // Expectation.
    const Density density_false(components_[0]);
    const Density density_true(components_[1]);
    double total = 0.;
    for (size_t i = 0; i < scores_.size(); ++i) {
      const double log_false = density_false.Log(scores_[i]);
      const double log_true = density_true.Log(scores_[i]);
      of_true[i] = 1. / (1. + std::exp(log_false - log_true));
      const double top = std::max(log_false, log_true);
      total += top + std::log1p(std::exp(-std::abs(log_false - log_true)));
    }
    total /= std::max(1., n);
    if (std::abs(total - last) < options_.tolerance) return iteration;
    last = total;
    // Maximisation with the priors as pseudo-observations.
    for (int c = 0; c < 2; ++c) {
      const MixtureComponent& prior = prior_[c];
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
