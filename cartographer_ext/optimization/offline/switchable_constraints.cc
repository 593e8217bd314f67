// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/switchable_constraints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "cartographer_ext/common/thread_time.h"
#include "ceres/ceres.h"
#include "ceres/version.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Pose2 ToPose(const double* const values) {
  return Pose2(values[0], values[1], values[2]);
}

// r(X) of an edge.
class EdgeCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit EdgeCost(const WhitenedEdge& edge) : edge_(edge) {}
  bool Evaluate(double const* const* parameters, double* const residuals,
                double** const jacobians) const override {
    Eigen::Matrix3d from, to;
    Eigen::Map<Eigen::Vector3d>(residuals, 3) = Linearize(
        edge_, ToPose(parameters[0]), ToPose(parameters[1]), &from, &to);
    if (jacobians != nullptr) {
      if (jacobians[0] != nullptr) {
        Eigen::Map<RowMajor3>(jacobians[0], 3, 3) = from;
      }
      if (jacobians[1] != nullptr) {
        Eigen::Map<RowMajor3>(jacobians[1], 3, 3) = to;
      }
    }
    return true;
  }

 private:
  const WhitenedEdge edge_;
};

// s r(X).
class SwitchedCost : public ceres::SizedCostFunction<3, 3, 3, 1> {
 public:
  explicit SwitchedCost(const WhitenedEdge& edge) : edge_(edge) {}
  bool Evaluate(double const* const* parameters, double* const residuals,
                double** const jacobians) const override {
    const double s = parameters[2][0];
    Eigen::Matrix3d from, to;
    const Eigen::Vector3d r = Linearize(edge_, ToPose(parameters[0]),
                                        ToPose(parameters[1]), &from, &to);
    Eigen::Map<Eigen::Vector3d>(residuals, 3) = s * r;
    if (jacobians != nullptr) {
      if (jacobians[0] != nullptr) {
        Eigen::Map<RowMajor3>(jacobians[0], 3, 3) = s * from;
      }
      if (jacobians[1] != nullptr) {
        Eigen::Map<RowMajor3>(jacobians[1], 3, 3) = s * to;
      }
      if (jacobians[2] != nullptr) {
        Eigen::Map<Eigen::Vector3d>(jacobians[2], 3) = r;
      }
    }
    return true;
  }

 private:
  const WhitenedEdge edge_;
};

// sqrt(w) (1 - s).
class PenaltyCost : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit PenaltyCost(const double penalty) : root_(std::sqrt(penalty)) {}
  bool Evaluate(double const* const* parameters, double* const residuals,
                double** const jacobians) const override {
    residuals[0] = root_ * (1. - parameters[0][0]);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      jacobians[0][0] = -root_;
    }
    return true;
  }

 private:
  const double root_;
};

// [0, 1], steps clamped.
#if CERES_VERSION_MAJOR > 2 || \
    (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
class UnitInterval : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 1; }
  int TangentSize() const override { return 1; }
  bool Plus(const double* x, const double* delta,
            double* x_plus_delta) const override {
    x_plus_delta[0] = std::min(1., std::max(0., x[0] + delta[0]));
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    jacobian[0] = 1.;
    return true;
  }
  bool Minus(const double* y, const double* x,
             double* y_minus_x) const override {
    y_minus_x[0] = y[0] - x[0];
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    jacobian[0] = 1.;
    return true;
  }
};
void KeepInUnitInterval(ceres::Problem* const problem, double* const s) {
  problem->SetManifold(s, new UnitInterval);
}
#else
class UnitInterval : public ceres::LocalParameterization {
 public:
  int GlobalSize() const override { return 1; }
  int LocalSize() const override { return 1; }
  bool Plus(const double* x, const double* delta,
            double* x_plus_delta) const override {
    x_plus_delta[0] = std::min(1., std::max(0., x[0] + delta[0]));
    return true;
  }
  bool ComputeJacobian(const double*, double* jacobian) const override {
    jacobian[0] = 1.;
    return true;
  }
};
void KeepInUnitInterval(ceres::Problem* const problem, double* const s) {
  problem->SetParameterization(s, new UnitInterval);
}
#endif

class KernelLoss : public ceres::LossFunction {
 public:
  explicit KernelLoss(const KernelOptions& kernel)
      : kernel_(kernel), shape_(AcsShape(kernel)) {}
  void Evaluate(const double chi2, double out[3]) const override {
    const KernelValue value = EvaluateKernel(kernel_, chi2, shape_);
    out[0] = value.rho;
    out[1] = value.weight;
    // rho'' <= 0 for every kernel here. Ceres then leaves it out, which makes
    // its step that of reweighted least squares, as ours is.
    out[2] = std::min(0., (EvaluateKernel(kernel_, chi2 + 1e-6, shape_).weight -
                           value.weight) /
                              1e-6);
  }

 private:
  const KernelOptions kernel_;
  const double shape_;
};

std::vector<std::array<double, 3>> ToArrays(const std::vector<Pose2>& poses) {
  std::vector<std::array<double, 3>> result;
  result.reserve(poses.size());
  for (const Pose2& pose : poses) {
    result.push_back({{pose.x, pose.y, pose.theta}});
  }
  return result;
}

void FromArrays(const std::vector<std::array<double, 3>>& values,
                std::vector<Pose2>* const poses) {
  for (size_t i = 0; i != values.size(); ++i) {
    (*poses)[i] =
        Pose2(values[i][0], values[i][1], NormalizeAngle(values[i][2]));
  }
}

// Ends a solution by processor time; Ceres' own limit is the time of the wall,
// of which a busy machine gives little.
class TimeLimit : public ceres::IterationCallback {
 public:
  explicit TimeLimit(const double seconds)
      : end_(ThreadCpuSeconds() + seconds) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary&) override {
    return ThreadCpuSeconds() < end_ ? ceres::SOLVER_CONTINUE
                                     : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const double end_;
};

SolverSummary SolveProblem(const int max_iterations,
                           const double function_tolerance,
                           const double max_seconds,
                           ceres::Problem* const problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = function_tolerance;
  options.num_threads = 1;
  TimeLimit time_limit(max_seconds);
  options.callbacks.push_back(&time_limit);
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  const double start = ThreadCpuSeconds();
  ceres::Solve(options, problem, &summary);
  SolverSummary result;
  result.cpu_seconds = ThreadCpuSeconds() - start;
  result.iterations =
      summary.num_successful_steps + summary.num_unsuccessful_steps;
  result.analyses = 1;
  result.initial_cost = 2. * summary.initial_cost;
  result.final_cost = 2. * summary.final_cost;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  return result;
}

}  // namespace

SolverSummary SolveSwitchable(const std::vector<WhitenedEdge>& edges,
                              const SwitchableOptions& options,
                              std::vector<Pose2>* const poses,
                              std::vector<double>* const switches) {
  std::vector<std::array<double, 3>> values = ToArrays(*poses);
  if (switches->size() != edges.size()) switches->assign(edges.size(), 1.);
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) (*switches)[i] = 1.;
  }
  SolverSummary summary;
  if (edges.empty()) return summary;
  ceres::Problem problem;
  for (size_t i = 0; i != edges.size(); ++i) {
    double* const from = values[edges[i].from].data();
    double* const to = values[edges[i].to].data();
    if (!edges[i].is_loop) {
      problem.AddResidualBlock(new EdgeCost(edges[i]), nullptr, from, to);
      continue;
    }
    double* const s = &(*switches)[i];
    problem.AddResidualBlock(new SwitchedCost(edges[i]), nullptr, from, to, s);
    problem.AddResidualBlock(new PenaltyCost(options.penalty), nullptr, s);
    KeepInUnitInterval(&problem, s);
  }
  if (problem.HasParameterBlock(values[0].data())) {
    problem.SetParameterBlockConstant(values[0].data());
  }
  summary = SolveProblem(options.max_iterations, options.function_tolerance,
                         options.max_seconds, &problem);
  FromArrays(values, poses);
  return summary;
}

SolverSummary SolveWithCeres(const std::vector<WhitenedEdge>& edges,
                             const KernelOptions& kernel,
                             const int max_iterations,
                             const double function_tolerance,
                             std::vector<Pose2>* const poses) {
  CHECK(kernel.type != KernelType::kAcsPaper &&
        kernel.type != KernelType::kTruncated);
  std::vector<std::array<double, 3>> values = ToArrays(*poses);
  if (edges.empty()) return SolverSummary();
  KernelLoss loss(kernel);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  for (const WhitenedEdge& edge : edges) {
    problem.AddResidualBlock(new EdgeCost(edge), edge.is_loop ? &loss : nullptr,
                             values[edge.from].data(), values[edge.to].data());
  }
  if (problem.HasParameterBlock(values[0].data())) {
    problem.SetParameterBlockConstant(values[0].data());
  }
  const SolverSummary summary =
      SolveProblem(max_iterations, function_tolerance, 1e9, &problem);
  FromArrays(values, poses);
  return summary;
}

}  // namespace optimization
}  // namespace cartographer_ext
