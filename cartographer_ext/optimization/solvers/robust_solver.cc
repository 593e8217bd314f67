// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/robust_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cartographer_ext/common/thread_time.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr double kMaxLambda = 1e12;
// A step that lowers the cost by less than this fraction is one of the last.
constexpr double kSettling = 1e-3;
// Such a step and all after it are small enough for the linearised graph to
// tell where the weights will end.
constexpr double kNearing = 1e-2;
// Where a step gains so many times what the quadratic model promised, a loop is
// being let go, and would be for many more such steps.
constexpr double kShedding = 1.5;
constexpr int kMaxProlongations = 5;
// A factor serves again while the gain that it promises is at most this share
// of what the last step has gained, and the damping is negligible.
constexpr double kContraction = 0.3;
constexpr double kNegligibleLambda = 1e-6;
// A solution that may end farther from the optimum than this has no steps to
// spare: what they gain with a new factor is part of it.
constexpr double kToTheEnd = 1e-4;
// Share of the promised gain that shows it to serve.
constexpr double kServes = 0.5;
// What an edge takes of the work of an iteration, in multiplications of the
// factorisation.
constexpr double kWorkOfEdge = 200.;

bool AreSame(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose2& p, const Pose2& q) {
                      return p.x == q.x && p.y == q.y && p.theta == q.theta;
                    });
}

std::vector<Pose2> Stepped(const std::vector<Pose2>& poses,
                           const Eigen::VectorXd& step) {
  std::vector<Pose2> result = poses;
  for (size_t i = 1; i != result.size(); ++i) {
    result[i].x += step[3 * i - 3];
    result[i].y += step[3 * i - 2];
    result[i].theta = NormalizeAngle(result[i].theta + step[3 * i - 1]);
  }
  return result;
}

}  // namespace

SolverSummary RobustSolver::Solve(const SolverOptions& options,
                                  std::vector<Pose2>* const poses) {
  CHECK(options.edge_weights.empty() ||
        options.edge_weights.size() == edges_.size());
  const double start = ThreadCpuSeconds();
  options_ = options;
  if (options.kernel.type == KernelType::kAcsPaper) ComputeCovarianceNorms();
  SetPoses(*poses);
  Descent descent;
  SolverSummary& summary = descent.summary;
  Evaluate(nullptr, &descent.now);
  summary.initial_cost = descent.now.cost;
  descent.lambda = options.initial_lambda;
  descent.done = poses_.size() < 2 || edges_.empty();
  summary.converged = descent.done;
  while (!descent.done && summary.iterations < options.max_iterations) {
    const bool analysed = UpdatePattern(descent.now.weights);
    summary.analyses += analysed;
    Assemble(descent.now.weights);
    const std::vector<Pose2> from = poses_;
    if (!analysed && TryLastFactor(from, &descent)) continue;
    bool accepted = false;
    while (!accepted && !descent.done &&
           summary.iterations < options.max_iterations) {
      ++summary.iterations;
      accepted = TryStep(from, &descent);
    }
    if (!accepted) SetPoses(from);
  }
  summary.final_cost = descent.now.cost;
  summary.factor_blocks = factor_.num_blocks();
  summary.cpu_seconds = ThreadCpuSeconds() - start;
  *poses = poses_;
  weights_ = std::move(descent.now.weights);
  return summary;
}

void RobustSolver::ComputeCovarianceNorms() {
  covariance_norms_.assign(edges_.size(), 1.);
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (!edges_[i].is_loop) continue;
    const Eigen::Matrix3d information =
        edges_[i].whitening.transpose() * edges_[i].whitening;
    covariance_norms_[i] = NormOfCovariance(information, options_.kernel.norm);
  }
}

// Ends the descent if the next step would, by the factor of the last one, gain
// nothing, or takes that step if it is nearly as good as with a new factor.
bool RobustSolver::TryLastFactor(const std::vector<Pose2>& from,
                                 Descent* const descent) {
  if (!descent->factor_serves) return false;
  Evaluation& now = descent->now;
  Evaluation& next = descent->next;
  Eigen::VectorXd& step = descent->step;
  step = -gradient_;
  factor_.Solve(&step);
  const double gain = -gradient_.dot(step);
  if (descent->settling && gain <= options_.cost_tolerance * now.cost) {
    descent->done = true;
    descent->summary.converged = true;
    return true;
  }
  descent->factor_serves = false;
  if (options_.cost_tolerance > kToTheEnd ||
      descent->lambda > kNegligibleLambda || !descent->undecided.empty() ||
      gain > kContraction * descent->last_decrease) {
    return false;
  }
  SetPoses(Stepped(from, step));
  Evaluate(&now.shapes, &next);
  const double decrease = now.cost - next.cost;
  if (!(decrease >= kServes * gain)) {
    SetPoses(from);
    return false;
  }
  work_ += kWorkOfEdge * edges_.size();
  ++descent->summary.iterations;
  Judge(decrease, step.cwiseAbs().maxCoeff(), descent);
  TakeNext(decrease, descent);
  return true;
}

// One step of Levenberg-Marquardt from the poses `from`, at which the system is
// assembled. Returns whether it lowers the cost; if not, the next one is
// shorter.
bool RobustSolver::TryStep(const std::vector<Pose2>& from,
                           Descent* const descent) {
  double& lambda = descent->lambda;
  Eigen::VectorXd& step = descent->step;
  Evaluation& now = descent->now;
  Evaluation& next = descent->next;
  ++descent->summary.factorizations;
  if (!Factorize(lambda)) {
    lambda = std::max(10. * lambda, 1e-8);
    descent->done = lambda > kMaxLambda;
    return false;
  }
  step = -gradient_;
  factor_.Solve(&step);
  const double predicted = PredictedDecrease(step, lambda);
  const bool carried = CarryToTheLimit(descent->undecided, now, &step);
  descent->undecided.clear();
  const double largest = step.cwiseAbs().maxCoeff();
  SetPoses(Stepped(from, step));
  // The shape of the literal ACS kernel is held during the step, so that both
  // costs are those of one function.
  Evaluate(&now.shapes, &next);
  const double decrease = now.cost - next.cost;
  if (!(decrease >= 0. && std::isfinite(next.cost))) {
    lambda = std::max(10. * lambda, 1e-8);
    if (largest < options_.step_tolerance || lambda > kMaxLambda) {
      descent->done = true;
      descent->summary.converged = true;
    }
    return false;
  }
  const double ratio = predicted > 0. ? decrease / predicted : 1.;
  if (ratio > 0.75) {
    lambda = lambda * 0.1 < 1e-10 ? 1e-10 : lambda * 0.1;
  } else if (ratio < 0.25) {
    lambda = std::min(4. * lambda, kMaxLambda);
  }
  Judge(decrease, largest, descent);
  if (descent->settling && !descent->done && !carried && ratio > kShedding) {
    Prolong(from, step, now.shapes, &next);
  }
  TakeNext(decrease, descent);
  return true;
}

// Whether a step that lowers the cost so far, and moves no pose farther than
// `largest`, is the last one or one of the last.
void RobustSolver::Judge(const double decrease, const double largest,
                         Descent* const descent) const {
  const double cost = descent->now.cost;
  descent->done = decrease <= options_.cost_tolerance * cost ||
                  largest < options_.step_tolerance;
  descent->summary.converged = descent->done;
  descent->settling = decrease <= kSettling * cost;
  descent->last_decrease = decrease;
  descent->factor_serves = true;
}

void RobustSolver::TakeNext(const double decrease, Descent* const descent) {
  Evaluation& now = descent->now;
  Evaluation& next = descent->next;
  // A kernel with a moving shape is weighed anew; the cost reported belongs to
  // the last shapes.
  if (options_.kernel.type == KernelType::kAcsPaper) Evaluate(nullptr, &next);
  std::swap(now, next);
  if (decrease <= kNearing * next.cost) {
    descent->undecided = UndecidedLoops(next.weights, now.weights);
  }
}

// Doubles an accepted step as long as that lowers the cost.
void RobustSolver::Prolong(const std::vector<Pose2>& from, Eigen::VectorXd step,
                           const std::vector<double>& held_shapes,
                           Evaluation* const reached) {
  Evaluation next;
  for (int i = 0; i != kMaxProlongations; ++i) {
    const std::vector<Pose2> last = poses_;
    step *= 2.;
    SetPoses(Stepped(from, step));
    Evaluate(&held_shapes, &next);
    if (!(next.cost < reached->cost)) {
      SetPoses(last);
      return;
    }
    std::swap(next, *reached);
  }
}

const BlockLdlt* RobustSolver::Factor(const std::vector<Pose2>& poses,
                                      const std::vector<double>& weights,
                                      Eigen::VectorXd* const rhs) {
  CHECK_EQ(weights.size(), edges_.size());
  const bool asked_before =
      weights == factored_weights_ && AreSame(poses, factored_poses_);
  SetPoses(poses);
  const bool analysed = UpdatePattern(weights);
  Assemble(weights);
  *rhs = -gradient_;
  // An edge that has changed since then changes the gradient.
  if (asked_before && !analysed && gradient_ == factored_gradient_) {
    CountFactorization();
    return &factor_;
  }
  if (!Factorize(0.)) return nullptr;
  factored_poses_ = poses;
  factored_weights_ = weights;
  factored_gradient_ = gradient_;
  return &factor_;
}

void RobustSolver::CountFactorization() {
  work_ += factor_.work() + kWorkOfEdge * edges_.size();
}

bool RobustSolver::Factorize(const double lambda) {
  CountFactorization();
  ++factorizations_;
  factored_poses_.clear();
  return factor_.Factorize(lambda);
}

void RobustSolver::SetPoses(const std::vector<Pose2>& poses) {
  const size_t known = std::min(poses.size(), rotations_.size());
  rotations_.resize(poses.size());
  for (size_t i = 0; i != poses.size(); ++i) {
    const double theta = poses[i].theta;
    if (i < known && poses_[i].theta == theta) continue;
    rotations_[i] = Eigen::Vector2d(std::cos(theta), std::sin(theta));
  }
  poses_ = poses;
}

void RobustSolver::Evaluate(const std::vector<double>* const held_shapes,
                            Evaluation* const result) {
  const KernelOptions& kernel = options_.kernel;
  const bool is_literal = kernel.type == KernelType::kAcsPaper;
  const double shape = is_literal ? 0. : AcsShape(kernel);
  result->cost = 0.;
  result->weights.resize(edges_.size());
  if (is_literal) result->shapes.resize(edges_.size());
  for (size_t i = 0; i != edges_.size(); ++i) {
    const WhitenedEdge& edge = edges_[i];
    const Eigen::Vector2d& rotation = rotations_[edge.from];
    const Eigen::Vector3d residual = Residual(
        edge, poses_[edge.from], poses_[edge.to], rotation.x(), rotation.y());
    const double chi2 = residual.squaredNorm();
    KernelValue value{chi2, 1.};
    if (edge.is_loop && is_literal) {
      result->shapes[i] =
          held_shapes != nullptr
              ? (*held_shapes)[i]
              : AcsPaperShape(chi2, UnwhitenedSquaredNorm(edge, residual),
                              covariance_norms_[i]);
      value = EvaluateKernel(kernel, chi2, result->shapes[i]);
    } else if (edge.is_loop) {
      value = EvaluateKernel(kernel, chi2, shape);
    }
    const double factor =
        options_.edge_weights.empty() ? 1. : options_.edge_weights[i];
    result->cost += factor * value.rho;
    result->weights[i] = factor * value.weight;
  }
}

SolverSummary SolveRobust(const std::vector<WhitenedEdge>& edges,
                          const SolverOptions& options,
                          std::vector<Pose2>* const poses) {
  return RobustSolver(edges).Solve(options, poses);
}

}  // namespace optimization
}  // namespace cartographer_ext
