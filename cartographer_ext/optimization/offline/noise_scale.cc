// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise_scale.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/solvers/loop_predictor.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Degrees of freedom that the prior of a factor of one is worth.
constexpr double kPriorDegrees = 3.;
constexpr size_t kMaxLoopsForTrace = 300;
// Quantiles of chi2 with three degrees of freedom.
constexpr double k5th = 0.351846317749272;
constexpr double kMedian = 2.365973884375338;

// Of some loops in force.
std::vector<LoopPrediction> Predict(const std::vector<Pose2>& poses,
                                    const std::vector<double>& weights,
                                    const size_t limit,
                                    RobustSolver* const solver) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  std::vector<int> loops;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (edges[i].is_loop && weights[i] > 0.) loops.push_back(i);
  }
  Eigen::VectorXd rhs;
  const BlockLdlt* const factorised = solver->Factor(poses, weights, &rhs);
  if (factorised == nullptr) return {};
  return LoopPredictor(edges, poses, *factorised)
      .Predict(Thinned(loops, limit));
}

// Quantile of chi2 by the approximation of Wilson and Hilferty; `z` is that of
// the normal distribution.
double Chi2Quantile(const double degrees, const double z) {
  const double a = 2. / (9. * degrees);
  const double root = std::max(0., 1. - a + z * std::sqrt(a));
  return degrees * root * root * root;
}

ScaleEstimate MakeEstimate(const double chi2, const double degrees) {
  ScaleEstimate result;
  result.degrees_of_freedom = std::max(0., degrees);
  const double posterior = result.degrees_of_freedom + kPriorDegrees;
  const double sum = chi2 + kPriorDegrees;
  result.factor = std::sqrt(sum / posterior);
  result.low = std::sqrt(sum / Chi2Quantile(posterior, 1.96));
  result.high =
      std::sqrt(sum / std::max(1e-12, Chi2Quantile(posterior, -1.96)));
  return result;
}

}  // namespace

double DeviateOfRatio(const ScaleEstimate& a, const ScaleEstimate& b) {
  const double of_a = 2. / (9. * (a.degrees_of_freedom + kPriorDegrees));
  const double of_b = 2. / (9. * (b.degrees_of_freedom + kPriorDegrees));
  const double root = std::cbrt(Squared(a.factor / b.factor));
  return ((1. - of_b) * root - (1. - of_a)) /
         std::sqrt(of_b * root * root + of_a);
}

NoiseScale EstimateNoiseScale(const std::vector<Pose2>& poses,
                              const std::vector<double>& weights,
                              RobustSolver* const solver) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  double odometry_chi2 = 0., loop_chi2 = 0.;
  size_t in_force = 0, loops = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (weights[i] <= 0.) continue;
    const WhitenedEdge& edge = edges[i];
    const double chi2 = Chi2(edge, poses[edge.from], poses[edge.to]);
    (edge.is_loop ? loop_chi2 : odometry_chi2) += chi2;
    ++in_force;
    loops += edge.is_loop;
  }
  double trace = 0.;
  const std::vector<LoopPrediction> predictions =
      Predict(poses, weights, kMaxLoopsForTrace, solver);
  for (const LoopPrediction& prediction : predictions) {
    trace += std::max(0., 3. - prediction.covariance.trace());
  }
  const double loop_redundancy =
      predictions.empty() ? 0. : trace * loops / predictions.size();
  const double redundancy = 3. * in_force - 3. * (poses.size() - 1.);
  NoiseScale result;
  result.loops = MakeEstimate(loop_chi2, loop_redundancy);
  result.odometry = MakeEstimate(odometry_chi2, redundancy - loop_redundancy);
  return result;
}

std::vector<double> LeaveOneOutInnovations(const std::vector<Pose2>& poses,
                                           const std::vector<double>& weights,
                                           const size_t limit,
                                           RobustSolver* const solver) {
  std::vector<double> result;
  for (const LoopPrediction& prediction :
       Predict(poses, weights, limit, solver)) {
    const Eigen::Matrix3d rest =
        Eigen::Matrix3d::Identity() - prediction.covariance;
    const Eigen::LLT<Eigen::Matrix3d> root(rest);
    if (root.info() != Eigen::Success ||
        root.matrixLLT().diagonal().minCoeff() < 1e-4) {
      continue;
    }
    result.push_back(prediction.residual.dot(root.solve(prediction.residual)));
  }
  return result;
}

bool IsLikeChi2(const std::vector<double>& values) {
  if (values.size() < 10) return false;
  const double n = values.size();
  const auto share_below = [&](const double limit) {
    return std::count_if(values.begin(), values.end(),
                         [=](const double value) { return value < limit; }) /
           n;
  };
  const double low = share_below(k5th), middle = share_below(kMedian);
  return low < 0.05 + 0.03 + 2.5 * std::sqrt(0.05 * 0.95 / n) &&
         std::abs(middle - 0.5) < 0.1 + 2.5 * std::sqrt(0.25 / n);
}

bool IsBelowChi2(const std::vector<double>& values) {
  constexpr double kOnceInAThousand = -3.09;
  return std::accumulate(values.begin(), values.end(), 0.) <
         2. * Chi2Quantile(1.5 * values.size(), kOnceInAThousand);
}

bool IsCutByGate(const std::vector<double>& values, const double gate) {
  // 12 % of a chi2 with three degrees of freedom lie in the upper half.
  constexpr double kSuspicious = 0.22;
  size_t upper = 0;
  for (const double value : values) upper += value > 0.5 * gate;
  return values.size() >= 10 && upper > kSuspicious * values.size();
}

double TypicalNoise(std::vector<double> innovations) {
  if (innovations.size() < 10) return 1.;
  const auto middle = innovations.begin() + innovations.size() / 2;
  std::nth_element(innovations.begin(), middle, innovations.end());
  return std::sqrt(*middle / kMedian);
}

bool ClaimTooMuchNoise(std::vector<double> innovations) {
  return TypicalNoise(std::move(innovations)) < 0.5;
}

PoseGraph WithNoiseScale(const PoseGraph& graph, const double odometry,
                         const double loops) {
  PoseGraph result = graph;
  for (PoseGraphEdge& edge : result.edges) {
    edge.information /= Squared(edge.is_loop ? loops : odometry);
  }
  return result;
}

std::vector<WhitenedEdge> WithNoiseScale(std::vector<WhitenedEdge> edges,
                                         const double odometry,
                                         const double loops) {
  for (WhitenedEdge& edge : edges) {
    edge.whitening /= edge.is_loop ? loops : odometry;
  }
  return edges;
}

}  // namespace optimization
}  // namespace cartographer_ext
