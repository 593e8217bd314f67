// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops whose weights are still on the move when all else has settled.
//
// With H the system at the weights omega_0, s the step -H^-1 g and J the
// Jacobian of such loops, changing their weights by D changes the step and the
// residuals it leads to into
//
//   s' = s - H^-1 J' D r',   r' = (I + S D)^-1 (r + J s),   S = J H^-1 J'
//
// (Woodbury). Reweighting repeats D = omega(|r'|^2) - omega_0, which costs a
// factorisation each time on the whole graph and next to nothing here, where
// all but r' and D stays as it is.
#include <algorithm>
#include <cmath>

#include "Eigen/LU"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kMaxUndecided = 3;
// A loop is undecided whose weight is less than this and has last changed by
// more than that.
constexpr double kDecided = 0.9;
constexpr double kMoving = 0.02;
constexpr int kMaxRepetitions = 100;
constexpr double kWeightTolerance = 1e-4;

struct Jacobians {
  int from, to;  // rows of their poses, negative for the first pose
  Eigen::Matrix3d of_from, of_to;

  template <typename Rows>
  Eigen::Matrix<double, 3, Rows::ColsAtCompileTime> Times(
      const Rows& rows) const {
    Eigen::Matrix<double, 3, Rows::ColsAtCompileTime> result;
    result.setZero();
    if (from >= 0) result += of_from * rows.template middleRows<3>(from);
    if (to >= 0) result += of_to * rows.template middleRows<3>(to);
    return result;
  }
};

}  // namespace

// None when there are more than a few.
std::vector<int> RobustSolver::UndecidedLoops(
    const std::vector<double>& before, const std::vector<double>& now) const {
  std::vector<int> result;
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (!edges_[i].is_loop || !in_pattern_[i] || now[i] >= kDecided ||
        std::abs(now[i] - before[i]) <= kMoving) {
      continue;
    }
    if (result.size() == kMaxUndecided) return {};
    result.push_back(i);
  }
  return result;
}

// Changes the step from the present poses, which have the present factor; false
// if it stays as it is.
bool RobustSolver::CarryToTheLimit(const std::vector<int>& loops,
                                   const Evaluation& now,
                                   Eigen::VectorXd* const step) const {
  if (loops.empty()) return false;
  const int num = loops.size();
  std::vector<Jacobians> jacobians(num);
  std::vector<BlockLdlt::Columns> responses(num);  // H^-1 J'
  Eigen::VectorXd reached(3 * num);                // r + J s
  for (int k = 0; k != num; ++k) {
    const WhitenedEdge& edge = edges_[loops[k]];
    Jacobians& jacobian = jacobians[k];
    const Eigen::Vector3d residual =
        Linearize(edge, poses_[edge.from], poses_[edge.to], &jacobian.of_from,
                  &jacobian.of_to);
    jacobian.from = 3 * edge.from - 3;
    jacobian.to = 3 * edge.to - 3;
    reached.segment<3>(3 * k) = residual + jacobian.Times(*step);
    BlockLdlt::Columns& response = responses[k];
    response.setZero(step->size(), 3);
    if (jacobian.from >= 0) {
      response.middleRows<3>(jacobian.from) = jacobian.of_from.transpose();
    }
    if (jacobian.to >= 0) {
      response.middleRows<3>(jacobian.to) = jacobian.of_to.transpose();
    }
    factor_.Solve(&response);
  }
  Eigen::MatrixXd coupling(3 * num, 3 * num);  // S
  for (int k = 0; k != num; ++k) {
    for (int l = 0; l != num; ++l) {
      coupling.block<3, 3>(3 * k, 3 * l) = jacobians[k].Times(responses[l]);
    }
  }
  const bool is_literal = options_.kernel.type == KernelType::kAcsPaper;
  const double shape = is_literal ? 0. : AcsShape(options_.kernel);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(3 * num);  // D
  Eigen::VectorXd residuals = reached;                      // r'
  for (int repetition = 0; repetition != kMaxRepetitions; ++repetition) {
    double largest = 0.;
    for (int k = 0; k != num; ++k) {
      const int i = loops[k];
      const double factor =
          options_.edge_weights.empty() ? 1. : options_.edge_weights[i];
      const double weight =
          factor * EvaluateKernel(options_.kernel,
                                  residuals.segment<3>(3 * k).squaredNorm(),
                                  is_literal ? now.shapes[i] : shape)
                       .weight;
      const double difference = weight - now.weights[i];
      largest = std::max(largest, std::abs(difference - change[3 * k]));
      change.segment<3>(3 * k).setConstant(difference);
    }
    if (largest <= kWeightTolerance) break;
    Eigen::MatrixXd system = coupling * change.asDiagonal();
    system.diagonal().array() += 1.;
    residuals = system.partialPivLu().solve(reached);
  }
  if (!residuals.allFinite()) return false;
  for (int k = 0; k != num; ++k) {
    step->noalias() -=
        responses[k] * (change[3 * k] * residuals.segment<3>(3 * k));
  }
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
