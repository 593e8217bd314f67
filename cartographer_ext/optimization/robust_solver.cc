// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/robust_solver.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr double kMaxLambda = 1e12;

// Weights and shapes of all edges at given poses.
struct Evaluation {
  double cost = 0.;
  std::vector<double> weights;
  std::vector<double> shapes;
};

class Solver {
 public:
  Solver(const std::vector<WhitenedEdge>& edges, const SolverOptions& options,
         std::vector<Pose2>* poses)
      : edges_(edges), options_(options), poses_(*poses) {
    if (options.kernel.type == KernelType::kAcsPaper) {
      covariance_norms_.resize(edges.size(), 1.);
      for (size_t i = 0; i != edges.size(); ++i) {
        if (!edges[i].is_loop) continue;
        const Eigen::Matrix3d information =
            edges[i].whitening.transpose() * edges[i].whitening;
        covariance_norms_[i] =
            NormOfCovariance(information, options.kernel.norm);
      }
    }
    in_pattern_.assign(edges.size(), false);
  }

  SolverSummary Run() {
    SolverSummary summary;
    const double start = ThreadCpuSeconds();
    Evaluation now = Evaluate(poses_, nullptr);
    summary.initial_cost = now.cost;
    double lambda = options_.initial_lambda;
    bool done = poses_.size() < 2 || edges_.empty();
    summary.converged = done;
    while (!done && summary.iterations < options_.max_iterations) {
      if (UpdatePattern(now)) ++summary.analyses;
      Assemble(now);
      bool accepted = false;
      while (!accepted && !done &&
             summary.iterations < options_.max_iterations) {
        ++summary.iterations;
        Eigen::VectorXd step = -gradient_;
        if (!factor_.Factorize(lambda)) {
          lambda = std::max(10. * lambda, 1e-8);
          done = lambda > kMaxLambda;
          continue;
        }
        factor_.Solve(&step);
        const std::vector<Pose2> candidate = Stepped(step);
        const double largest = step.cwiseAbs().maxCoeff();
        // The shape of the literal ACS kernel is held during the step, so that
        // both costs are those of one function.
        const double cost = Cost(candidate, now.shapes);
        const double predicted = PredictedDecrease(step, lambda);
        const double decrease = now.cost - cost;
        if (decrease >= 0. && std::isfinite(cost)) {
          accepted = true;
          poses_ = candidate;
          const double ratio = predicted > 0. ? decrease / predicted : 1.;
          if (ratio > 0.75) {
            lambda = lambda * 0.1 < 1e-10 ? 1e-10 : lambda * 0.1;
          } else if (ratio < 0.25) {
            lambda = std::min(4. * lambda, kMaxLambda);
          }
          done = decrease <= options_.cost_tolerance * now.cost ||
                 largest < options_.step_tolerance;
          summary.converged = done;
          // A kernel with a moving shape is weighed anew; the cost reported
          // belongs to the last shapes.
          now = Evaluate(poses_, nullptr);
        } else {
          lambda = std::max(10. * lambda, 1e-8);
          if (largest < options_.step_tolerance || lambda > kMaxLambda) {
            done = true;
            summary.converged = true;
          }
        }
      }
    }
    summary.final_cost = now.cost;
    summary.factor_blocks = factor_.num_blocks();
    summary.cpu_seconds = ThreadCpuSeconds() - start;
    return summary;
  }

  const std::vector<Pose2>& poses() const { return poses_; }

 private:
  double EdgeFactor(const size_t i) const {
    return options_.edge_weights.empty() ? 1. : options_.edge_weights[i];
  }

  KernelValue EvaluateEdge(const size_t i, const std::vector<Pose2>& poses,
                           const std::vector<double>* held_shapes,
                           double* const shape) const {
    const WhitenedEdge& edge = edges_[i];
    const Eigen::Vector3d residual =
        Residual(edge, poses[edge.from], poses[edge.to]);
    const double chi2 = residual.squaredNorm();
    if (!edge.is_loop) return KernelValue{chi2, 1.};
    *shape = 0.;
    if (options_.kernel.type == KernelType::kAcs) {
      *shape = AcsShape(options_.kernel);
    } else if (options_.kernel.type == KernelType::kAcsPaper) {
      *shape = held_shapes != nullptr
                   ? (*held_shapes)[i]
                   : AcsPaperShape(chi2, UnwhitenedSquaredNorm(edge, residual),
                                   covariance_norms_[i]);
    }
    return EvaluateKernel(options_.kernel, chi2, *shape);
  }

  Evaluation Evaluate(const std::vector<Pose2>& poses,
                      const std::vector<double>* const held_shapes) const {
    Evaluation result;
    result.weights.resize(edges_.size());
    result.shapes.assign(edges_.size(), 0.);
    for (size_t i = 0; i != edges_.size(); ++i) {
      const KernelValue value =
          EvaluateEdge(i, poses, held_shapes, &result.shapes[i]);
      const double factor = EdgeFactor(i);
      result.cost += factor * value.rho;
      result.weights[i] = factor * value.weight;
    }
    return result;
  }

  double Cost(const std::vector<Pose2>& poses,
              const std::vector<double>& shapes) const {
    double cost = 0., unused;
    for (size_t i = 0; i != edges_.size(); ++i) {
      cost += EdgeFactor(i) * EvaluateEdge(i, poses, &shapes, &unused).rho;
    }
    return cost;
  }

  // Chooses the edges of the linear systems; true when they were analysed anew.
  bool UpdatePattern(const Evaluation& now) {
    int entering = 0, dead = 0, loops = 0;
    std::vector<bool> wanted(edges_.size());
    for (size_t i = 0; i != edges_.size(); ++i) {
      wanted[i] = !edges_[i].is_loop || !options_.prune ||
                  now.weights[i] >= options_.prune_weight;
      if (wanted[i] && !in_pattern_[i]) ++entering;
      if (!wanted[i] && in_pattern_[i]) ++dead;
      if (wanted[i] && edges_[i].is_loop) ++loops;
    }
    // A few dead edges cost less than a new analysis.
    if (analysed_ && entering == 0 && dead <= 5 + loops / 50) return false;
    in_pattern_ = wanted;
    analysed_ = true;
    pattern_.clear();
    std::vector<std::pair<int, int>> pairs;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!in_pattern_[i]) continue;
      const int a = edges_[i].from - 1, b = edges_[i].to - 1;
      if (a >= 0 && b >= 0) {
        pattern_.push_back(
            {static_cast<int>(i), static_cast<int>(pairs.size())});
        pairs.push_back({a, b});
      } else {
        pattern_.push_back({static_cast<int>(i), -1});
      }
    }
    factor_.Analyze(poses_.size() - 1, pairs, {});
    return true;
  }

  void Assemble(const Evaluation& now) {
    const int size = poses_.size() - 1;
    gradient_.setZero(3 * size);
    diagonal_.setZero(3 * size);
    factor_.SetZero();
    Eigen::Matrix3d jacobian_from, jacobian_to;
    for (const std::pair<int, int>& entry : pattern_) {
      const WhitenedEdge& edge = edges_[entry.first];
      const double weight = now.weights[entry.first];
      const Eigen::Vector3d residual =
          weight * Linearize(edge, poses_[edge.from], poses_[edge.to],
                             &jacobian_from, &jacobian_to);
      const int a = edge.from - 1, b = edge.to - 1;
      if (a >= 0) {
        const Eigen::Matrix3d block =
            weight * jacobian_from.transpose() * jacobian_from;
        factor_.AddDiagonal(a, block);
        diagonal_.segment<3>(3 * a) += block.diagonal();
        gradient_.segment<3>(3 * a).noalias() +=
            jacobian_from.transpose() * residual;
      }
      if (b >= 0) {
        const Eigen::Matrix3d block =
            weight * jacobian_to.transpose() * jacobian_to;
        factor_.AddDiagonal(b, block);
        diagonal_.segment<3>(3 * b) += block.diagonal();
        gradient_.segment<3>(3 * b).noalias() +=
            jacobian_to.transpose() * residual;
      }
      if (entry.second >= 0) {
        factor_.AddOffDiagonal(
            entry.second, weight * jacobian_from.transpose() * jacobian_to);
      }
    }
  }

  // Decrease of the quadratic model; costs are sums of squares without 1/2.
  double PredictedDecrease(const Eigen::VectorXd& step,
                           const double lambda) const {
    return step.dot(lambda * diagonal_.cwiseProduct(step) - gradient_);
  }

  std::vector<Pose2> Stepped(const Eigen::VectorXd& step) const {
    std::vector<Pose2> result = poses_;
    for (size_t i = 1; i != result.size(); ++i) {
      result[i].x += step[3 * i - 3];
      result[i].y += step[3 * i - 2];
      result[i].theta = NormalizeAngle(result[i].theta + step[3 * i - 1]);
    }
    return result;
  }

  const std::vector<WhitenedEdge>& edges_;
  const SolverOptions& options_;
  std::vector<Pose2> poses_;
  std::vector<double> covariance_norms_;
  std::vector<bool> in_pattern_;
  bool analysed_ = false;
  std::vector<std::pair<int, int>> pattern_;  // (edge, pair of factor_ or -1)
  BlockLdlt factor_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd diagonal_;
};

}  // namespace

SolverSummary SolveRobust(const std::vector<WhitenedEdge>& edges,
                          const SolverOptions& options,
                          std::vector<Pose2>* const poses) {
  CHECK(options.edge_weights.empty() ||
        options.edge_weights.size() == edges.size());
  Solver solver(edges, options, poses);
  const SolverSummary summary = solver.Run();
  *poses = solver.poses();
  return summary;
}

SolverSummary SolveGnc(const std::vector<WhitenedEdge>& edges,
                       const GncOptions& options,
                       std::vector<Pose2>* const poses,
                       std::vector<double>* const weights) {
  const double start = ThreadCpuSeconds();
  SolverOptions inner;
  inner.max_iterations = options.inner_iterations;
  inner.cost_tolerance = 1e-4;
  inner.edge_weights.assign(edges.size(), 1.);
  SolverSummary total = SolveRobust(edges, inner, poses);
  const double c = options.truncation;
  double mu = -1.;
  for (int outer = 0; outer != options.max_outer_iterations; ++outer) {
    const std::vector<double> chi2 = Chi2OfEdges(edges, *poses);
    if (mu < 0.) {
      double largest = 0.;
      for (size_t i = 0; i != edges.size(); ++i) {
        if (edges[i].is_loop) largest = std::max(largest, chi2[i]);
      }
      if (2. * largest <= c) break;  // nothing looks wrong
      mu = c / (2. * largest - c);
    }
    bool binary = true;
    for (size_t i = 0; i != edges.size(); ++i) {
      if (!edges[i].is_loop) continue;
      const double weight = GncTlsWeight(chi2[i], c, mu);
      inner.edge_weights[i] = weight;
      binary = binary && (weight < 1e-4 || weight > 1. - 1e-4);
    }
    const SolverSummary summary = SolveRobust(edges, inner, poses);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.final_cost = summary.final_cost;
    total.factor_blocks = summary.factor_blocks;
    total.converged = binary && mu > 1.;
    if (total.converged) break;
    mu *= options.mu_step;
  }
  inner.max_iterations = 20;
  inner.cost_tolerance = 1e-7;
  const SolverSummary last = SolveRobust(edges, inner, poses);
  total.iterations += last.iterations;
  total.analyses += last.analyses;
  total.final_cost = last.final_cost;
  if (weights != nullptr) *weights = inner.edge_weights;
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

SolverSummary PolishTruncated(const std::vector<WhitenedEdge>& edges,
                              const double gate, const int max_rounds,
                              std::vector<Pose2>* const poses,
                              std::vector<double>* const weights) {
  const double start = ThreadCpuSeconds();
  SolverSummary total;
  SolverOptions options;
  options.initial_lambda = 1e-8;
  options.max_iterations = 20;
  for (int round = 0; round < max_rounds; ++round) {
    std::vector<double> decisions = Chi2OfEdges(edges, *poses);
    for (size_t i = 0; i != edges.size(); ++i) {
      decisions[i] = !edges[i].is_loop || decisions[i] < gate ? 1. : 0.;
    }
    if (decisions == options.edge_weights) {
      total.converged = true;
      break;
    }
    options.edge_weights = decisions;
    const SolverSummary summary = SolveRobust(edges, options, poses);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.factor_blocks = summary.factor_blocks;
  }
  if (weights != nullptr) *weights = options.edge_weights;
  total.final_cost = TruncatedCost(edges, *poses);
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

double AdaptiveGate(const std::vector<WhitenedEdge>& edges,
                    const std::vector<Pose2>& poses) {
  // Quantiles of chi2 with 3 degrees of freedom.
  constexpr double kMedian = 2.365973884375338;
  constexpr double k98th = 9.837409311192957;
  constexpr double kSafety = 4.;
  std::vector<double> inside;
  for (const WhitenedEdge& edge : edges) {
    if (!edge.is_loop) continue;
    const double chi2 = Chi2(edge, poses[edge.from], poses[edge.to]);
    if (chi2 < kChi2Gate) inside.push_back(chi2);
  }
  // Too few loops say nothing about their scale.
  if (inside.size() < 20) return kChi2Gate;
  std::sort(inside.begin(), inside.end());
  const double scale = std::max(inside[inside.size() / 2] / kMedian,
                                inside[inside.size() * 98 / 100] / k98th);
  return kChi2Gate * std::min(1., kSafety * scale);
}

SolverSummary PolishAdapted(const std::vector<WhitenedEdge>& edges,
                            const int max_rounds,
                            std::vector<Pose2>* const poses,
                            std::vector<double>* const weights) {
  constexpr int kMaxGates = 5;
  const double start = ThreadCpuSeconds();
  SolverSummary total;
  double gate = std::numeric_limits<double>::infinity();
  for (int k = 0; k != kMaxGates; ++k) {
    const double next = AdaptiveGate(edges, *poses);
    if (next >= 0.99 * gate) break;
    gate = next;
    const SolverSummary summary =
        PolishTruncated(edges, gate, max_rounds, poses, weights);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.factor_blocks = summary.factor_blocks;
    total.converged = summary.converged;
    total.final_cost = summary.final_cost;
  }
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

double TruncatedCost(const std::vector<WhitenedEdge>& edges,
                     const std::vector<Pose2>& poses, const double gate) {
  double cost = 0.;
  for (const WhitenedEdge& edge : edges) {
    const double chi2 = Chi2(edge, poses[edge.from], poses[edge.to]);
    cost += edge.is_loop ? std::min(chi2, gate) : chi2;
  }
  return cost;
}

double ThreadCpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec + 1e-9 * now.tv_nsec;
}

}  // namespace optimization
}  // namespace cartographer_ext
