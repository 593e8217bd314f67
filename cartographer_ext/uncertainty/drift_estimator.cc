// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

// Levels of the logarithm of a factor on the grid; at first from a twelfth to
// eighteen.
constexpr int kLevels = 7;
constexpr double kFirstCenter = 0.2;
constexpr double kFirstStep = 0.9;
// Later in steps of this many standard deviations of the posterior before.
constexpr double kStepInSigmas = 0.75;
constexpr double kLeastStep = 0.03;

// Levels of the share of wrong cycles, equidistant within (0, 1).
constexpr int kShares = 8;

constexpr int kReweightings = 5;
constexpr int kAlternations = 5;

// Starts for the drift that is the same all along, in standard deviations of its
// prior, and by how much (a logarithm) a result must be likelier than that from
// none.
constexpr double kFarthestStart = 3.;
constexpr double kBetter = 1e-3;

// Range of the headings of wrong loops that are not aligned, radians.
constexpr double kHeadings = 1.;
// Wrong cycles that the prior of the share of aligned ones is worth.
constexpr double kPriorWrong = 2.;

constexpr double kLogTwoPi = 1.8378770664093453;

// `factor` is that of the covariance.
double LogNormalDensity(const Eigen::Vector3d& error,
                        const Eigen::LLT<Eigen::Matrix3d>& factor) {
  if (factor.info() != Eigen::Success) {
    return -std::numeric_limits<double>::infinity();
  }
  const Eigen::Matrix3d lower = factor.matrixL();
  return -0.5 * error.dot(factor.solve(error)) -
         std::log(lower.diagonal().prod()) - 1.5 * kLogTwoPi;
}

double NormalDensity(const double error, const double variance) {
  return std::exp(-0.5 * (Squared(error) / variance + kLogTwoPi)) /
         std::sqrt(variance);
}

// Of loops whose heading is wrong, too.
double UnalignedShare(const DriftFit& fit) {
  return fit.wrong_share * (1. - fit.aligned_share);
}

// The probability that the heading of a loop is a wrong one.
double Unaligned(const HeadingCycle& heading, const double variance,
                 const Eigen::Vector3d& common, const double share) {
  const double error = heading.error + heading.common.dot(common);
  const double wrong = share / kHeadings;
  return wrong / (wrong + (1. - share) * NormalDensity(error, variance));
}

double HeadingVariance(const HeadingCycle& heading,
                       const DriftFactors& factors) {
  return Squared(factors.rotation) * heading.rotation +
         Squared(factors.turning) * heading.turning + heading.other;
}

double ShareOf(const int level) { return (level + 0.5) / kShares; }

DriftFactors FactorsOf(const Eigen::Vector3d& logarithms) {
  DriftFactors factors;
  factors.translation = std::exp(logarithms(0));
  factors.rotation = std::exp(logarithms(1));
  factors.turning = std::exp(logarithms(2));
  return factors;
}

}  // namespace

DriftEstimator::DriftEstimator(const DriftEstimatorOptions& options)
    : options_(options) {
  CHECK_GT(options.prior_sigma, 0.);
  CHECK_GT(options.least_window, 0.);
  CHECK_GT(options.max_cycles, 0u);
}

void DriftEstimator::Add(const DriftCycle& cycle) {
  if (!cycle.error.allFinite()) return;
  ++num_cycles_;
  cycles_.push_back(cycle);
  if (cycles_.size() > options_.max_cycles) cycles_.pop_front();
}

void DriftEstimator::SetHeadings(std::vector<HeadingCycle> headings,
                                 const double driven) {
  headings_ = std::move(headings);
  double sum = 0.;
  for (const HeadingCycle& heading : headings_) sum += heading.length;
  heading_weight_ = sum > 0. ? std::min(1., driven / sum) : 1.;
}

DriftEstimator::WrongDensity DriftEstimator::DensityOfWrong(
    const DriftCycle& cycle, const double aligned_share) const {
  const double window = std::min(options_.largest_window,
                                 std::max(options_.least_window, cycle.window));
  const double of_translation = 1. / Squared(2. * window);
  const CovarianceParts& parts = cycle.parts;
  const double variance =
      parts.rotation(2, 2) + parts.turning(2, 2) + parts.other(2, 2);
  WrongDensity density;
  density.anywhere = (1. - aligned_share) * of_translation / kHeadings;
  if (variance > 0.) {
    density.aligned =
        aligned_share * of_translation *
        std::exp(-0.5 * (Squared(cycle.error.z()) / variance + kLogTwoPi)) /
        std::sqrt(variance);
  }
  return density;
}

Eigen::Vector3d DriftEstimator::PriorSigma() const {
  return Eigen::Vector3d(options_.prior_heading, options_.prior_turning,
                         options_.prior_scale);
}

double DriftEstimator::LogOfHeadings(const DriftFit& fit,
                                     const Eigen::Vector3d& common) const {
  const double unaligned = UnalignedShare(fit);
  double sum = 0.;
  for (const HeadingCycle& heading : headings_) {
    const double error = heading.error + heading.common.dot(common);
    sum +=
        std::log((1. - unaligned) *
                     NormalDensity(error, HeadingVariance(heading, fit.mean)) +
                 unaligned / kHeadings);
  }
  return heading_weight_ * sum -
         0.5 * common.cwiseQuotient(PriorSigma()).squaredNorm();
}

double DriftEstimator::LogPosterior(const DriftFit& fit,
                                    const Eigen::Vector3d& common) const {
  double sum = LogOfHeadings(fit, common);
  for (const DriftCycle& cycle : cycles_) {
    const Eigen::LLT<Eigen::Matrix3d> factor(
        Symmetric(cycle.parts.Total(fit.mean, Eigen::Matrix3d::Zero())));
    const double right = std::exp(
        LogNormalDensity(cycle.error + cycle.parts.common * common, factor));
    sum += std::log((1. - fit.wrong_share) * right +
                    fit.wrong_share *
                        DensityOfWrong(cycle, fit.aligned_share).Sum());
  }
  return sum;
}

Eigen::Vector3d DriftEstimator::StartByHeadings(const DriftFit& fit,
                                                const int axis) const {
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double most = LogOfHeadings(fit, best);
  for (const HeadingCycle& heading : headings_) {
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    start(axis) = -heading.error / heading.common(axis);
    if (!(std::abs(start(axis)) < kFarthestStart * PriorSigma()(axis))) {
      continue;
    }
    const double log = LogOfHeadings(fit, start);
    if (log <= most) continue;
    most = log;
    best = start;
  }
  return best;
}

CommonDrift DriftEstimator::FitCommon(const DriftFit& fit) const {
  CommonDrift best = FitCommonFrom(fit, Eigen::Vector3d::Zero());
  double most = LogPosterior(fit, best.mean) + kBetter;
  for (const int axis : {0, 1}) {
    const Eigen::Vector3d start = StartByHeadings(fit, axis);
    if (start.isZero(0.)) continue;
    const CommonDrift found = FitCommonFrom(fit, start);
    const double log = LogPosterior(fit, found.mean);
    if (log <= most) continue;
    most = log;
    best = found;
  }
  return best;
}

CommonDrift DriftEstimator::FitCommonFrom(const DriftFit& fit,
                                          const Eigen::Vector3d& start) const {
  const double log_right = std::log1p(-fit.wrong_share);
  const Eigen::Vector3d prior_sigma = PriorSigma();
  CommonDrift common;
  common.mean = start;
  for (int iteration = 0; iteration < kReweightings; ++iteration) {
    // In units of the prior.
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (const DriftCycle& cycle : cycles_) {
      const Eigen::LLT<Eigen::Matrix3d> factor(
          Symmetric(cycle.parts.Total(fit.mean, Eigen::Matrix3d::Zero())));
      if (factor.info() != Eigen::Success) continue;
      const double density =
          log_right +
          LogNormalDensity(cycle.error + cycle.parts.common * common.mean,
                           factor);
      const double wrong =
          fit.wrong_share * DensityOfWrong(cycle, fit.aligned_share).Sum();
      const double weight = 1. / (1. + wrong * std::exp(-density));
      const Eigen::Matrix3d effects =
          cycle.parts.common * prior_sigma.asDiagonal();
      information += weight * effects.transpose() * factor.solve(effects);
      gradient -= weight * effects.transpose() * factor.solve(cycle.error);
    }
    for (const HeadingCycle& heading : headings_) {
      const double variance = HeadingVariance(heading, fit.mean);
      const double weight =
          heading_weight_ *
          (1. - Unaligned(heading, variance, common.mean, UnalignedShare(fit)));
      const Eigen::Vector3d effects = heading.common.cwiseProduct(prior_sigma);
      information += weight / variance * effects * effects.transpose();
      gradient -= weight / variance * heading.error * effects;
    }
    const Eigen::Matrix3d inverse = Symmetric(information.inverse());
    common.mean = prior_sigma.asDiagonal() * (inverse * gradient);
    common.covariance =
        prior_sigma.asDiagonal() * inverse * prior_sigma.asDiagonal();
  }
  return common;
}

double DriftEstimator::Marginal::LogFactor(const int level) const {
  return center + step * (level - kLevels / 2);
}

double DriftEstimator::Marginal::Mean() const {
  double mean = 0.;
  for (int i = 0; i < kLevels; ++i) mean += mass[i] * LogFactor(i);
  return mean;
}

double DriftEstimator::Marginal::Sigma() const {
  const double mean = Mean();
  double variance = Squared(step) / 12.;
  for (int i = 0; i < kLevels; ++i) {
    variance += mass[i] * Squared(LogFactor(i) - mean);
  }
  return std::sqrt(variance);
}

double DriftEstimator::Marginal::Quantile(const double quantile) const {
  double below = 0.;
  for (int i = 0; i < kLevels; ++i) {
    if (below + mass[i] >= quantile) {
      return LogFactor(i) + step * ((quantile - below) / mass[i] - 0.5);
    }
    below += mass[i];
  }
  return LogFactor(kLevels - 1) + 0.5 * step;
}

double DriftEstimator::FitFactors(const DriftFit& fit,
                                  std::array<Marginal, 3>* const grid) const {
  const CommonDrift& common = fit.common;
  std::vector<DriftCycle> residuals(cycles_.begin(), cycles_.end());
  std::vector<double> wrong;
  for (DriftCycle& cycle : residuals) {
    cycle.error += cycle.parts.common * common.mean;
    wrong.push_back(DensityOfWrong(cycle, fit.aligned_share).Sum());
  }
  const double unaligned = UnalignedShare(fit);
  const Eigen::Vector3d prior_mean(options_.prior_translation, 0., 0.);
  // Of one point of the grid: for each share, the logarithm.
  const auto log_posterior = [&](const Eigen::Vector3d& logarithms) {
    const DriftFactors factors = FactorsOf(logarithms);
    std::array<double, kShares> sums;
    sums.fill(-0.5 * (logarithms - prior_mean).squaredNorm() /
              Squared(options_.prior_sigma));
    for (size_t i = 0; i < residuals.size(); ++i) {
      const DriftCycle& cycle = residuals[i];
      const Eigen::LLT<Eigen::Matrix3d> factor(
          Symmetric(cycle.parts.Total(factors, common.covariance)));
      const double density = std::exp(LogNormalDensity(cycle.error, factor));
      for (int k = 0; k < kShares; ++k) {
        const double share = ShareOf(k);
        sums[k] += std::log((1. - share) * density + share * wrong[i]);
      }
    }
    double of_headings = 0.;
    for (const HeadingCycle& heading : headings_) {
      const double variance =
          HeadingVariance(heading, factors) +
          heading.common.dot(common.covariance * heading.common);
      const double error = heading.error + heading.common.dot(common.mean);
      of_headings +=
          heading_weight_ *
          std::log((1. - unaligned) * NormalDensity(error, variance) +
                   unaligned / kHeadings);
    }
    for (double& sum : sums) sum += of_headings;
    return sums;
  };
  std::array<Marginal, 3>& axes = *grid;
  std::vector<std::array<double, kShares>> values;
  double top = -std::numeric_limits<double>::infinity();
  for (int t = 0; t < kLevels; ++t) {
    for (int r = 0; r < kLevels; ++r) {
      for (int u = 0; u < kLevels; ++u) {
        values.push_back(log_posterior(Eigen::Vector3d(
            axes[0].LogFactor(t), axes[1].LogFactor(r), axes[2].LogFactor(u))));
        top = std::max(
            top, *std::max_element(values.back().begin(), values.back().end()));
      }
    }
  }
  for (Marginal& axis : axes) axis.mass.assign(kLevels, 0.);
  double total = 0.;
  double share = 0.;
  size_t index = 0;
  for (int t = 0; t < kLevels; ++t) {
    for (int r = 0; r < kLevels; ++r) {
      for (int u = 0; u < kLevels; ++u, ++index) {
        for (int k = 0; k < kShares; ++k) {
          const double mass = std::exp(values[index][k] - top);
          axes[0].mass[t] += mass;
          axes[1].mass[r] += mass;
          axes[2].mass[u] += mass;
          share += mass * ShareOf(k);
          total += mass;
        }
      }
    }
  }
  for (Marginal& axis : axes) {
    for (double& mass : axis.mass) mass /= total;
  }
  return share / total;
}

double DriftEstimator::FitAlignedShare(const DriftFit& fit) const {
  double aligned = 0.5 * kPriorWrong;
  double total = kPriorWrong;
  for (DriftCycle cycle : cycles_) {
    cycle.error += cycle.parts.common * fit.common.mean;
    const Eigen::LLT<Eigen::Matrix3d> factor(
        Symmetric(cycle.parts.Total(fit.mean, fit.common.covariance)));
    const double right = (1. - fit.wrong_share) *
                         std::exp(LogNormalDensity(cycle.error, factor));
    const WrongDensity wrong = DensityOfWrong(cycle, fit.aligned_share);
    const double sum = right + fit.wrong_share * wrong.Sum();
    if (sum <= 0.) continue;
    aligned += fit.wrong_share * wrong.aligned / sum;
    total += fit.wrong_share * wrong.Sum() / sum;
  }
  return aligned / total;
}

DriftFit DriftEstimator::Fit() const {
  DriftFit fit;
  std::array<Marginal, 3> grid;
  for (int iteration = 0; iteration < kAlternations; ++iteration) {
    for (Marginal& axis : grid) {
      const bool first = iteration == 0;
      const double center = first ? kFirstCenter : axis.Mean();
      axis.step = first ? kFirstStep
                        : std::max(kLeastStep, kStepInSigmas * axis.Sigma());
      axis.center = center;
    }
    fit.common = FitCommon(fit);
    fit.wrong_share = FitFactors(fit, &grid);
    fit.mean = FactorsOf(
        Eigen::Vector3d(grid[0].Mean(), grid[1].Mean(), grid[2].Mean()));
    fit.aligned_share = FitAlignedShare(fit);
  }
  const double quantile = options_.upper_quantile;
  fit.upper = FactorsOf(Eigen::Vector3d(grid[0].Quantile(quantile),
                                        grid[1].Quantile(quantile),
                                        grid[2].Quantile(quantile)));
  return fit;
}

}  // namespace uncertainty
}  // namespace cartographer_ext
