// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The Levenberg-Marquardt method for the three unknowns of a pose.
//
// Each iteration solves (H + D / radius) step = -g, with g and H gradient and
// Gauss-Newton Hessian of the cost at the pose, D the diagonal of H
// (Marquardt's scaling: metres and radians need no common unit). With rho the
// ratio of actual to predicted decrease of the cost, a step with rho > 0.001 is
// accepted and the radius divided by max(1/3, 1 - (2 rho - 1)^3) (Nielsen 1999,
// "Damping parameter in Marquardt's method"); otherwise the radius is divided
// by 2, 4, 8, ... and the step is repeated. Initial radius, bounds and stopping
// rules are the defaults of Ceres, so that both stop at the same minimum.
//
// D is bounded from below, so along a direction without information (one point,
// a blank wall, no prior) the step is zero rather than infinite.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_POSE_SOLVER_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_POSE_SOLVER_H_

#include <algorithm>
#include <cmath>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace scan_matching {

// A cost and its derivatives by (x, y, theta) at a pose.
struct PoseCost {
  double cost = 0.;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// Limits and tolerances, with the defaults of Ceres.
struct PoseSolverOptions {
  // Accepted steps; at most twice as many are tried.
  int max_iterations = 20;
  double function_tolerance = 1e-6;   // relative to the cost
  double gradient_tolerance = 1e-10;  // largest component
  double parameter_tolerance = 1e-8;  // relative to the pose
  double initial_radius = 1e4;
};

// The minimum found by the solver.
struct PoseSolution {
  Pose2 pose;  // the angle is not wrapped
  PoseCost at_pose;
  double initial_cost = 0.;
  int iterations = 0;  // steps tried
  int successful_iterations = 0;
  bool converged = false;
};

// The step that solves (hessian + diag(damping)) step = -gradient, by a
// Cholesky factorisation of the matrix scaled to a unit diagonal. False if it
// is not positive definite, or if a value is not finite.
bool SolveDamped(const Eigen::Matrix3d& hessian, const Eigen::Vector3d& damping,
                 const Eigen::Vector3d& gradient, Eigen::Vector3d* step);

// `evaluate(const Pose2&)` returns a PoseCost. The pose returned never costs
// more than `initial`; a cost or derivative that is not finite ends the search
// at the best pose so far.
template <typename Function>
PoseSolution SolvePose(const PoseSolverOptions& options, const Pose2& initial,
                       Function&& evaluate) {
  constexpr double kMinDiagonal = 1e-6;
  constexpr double kMaxDiagonal = 1e32;
  constexpr double kMinRadius = 1e-32;
  constexpr double kMaxRadius = 1e16;
  constexpr double kMinRelativeDecrease = 1e-3;

  PoseSolution solution;
  solution.pose = initial;
  solution.at_pose = evaluate(initial);
  solution.initial_cost = solution.at_pose.cost;
  double radius = options.initial_radius;
  double shrink = 2.;
  while (solution.successful_iterations < options.max_iterations &&
         solution.iterations < 2 * options.max_iterations) {
    const PoseCost& here = solution.at_pose;
    if (!std::isfinite(here.cost) || !here.gradient.allFinite())
      return solution;
    if (here.gradient.cwiseAbs().maxCoeff() <= options.gradient_tolerance) {
      solution.converged = true;
      return solution;
    }
    ++solution.iterations;
    const Eigen::Vector3d damping =
        here.hessian.diagonal().cwiseMax(kMinDiagonal).cwiseMin(kMaxDiagonal) /
        radius;
    Eigen::Vector3d step;
    double rho = -1.;
    if (SolveDamped(here.hessian, damping, here.gradient, &step)) {
      const Pose2& p = solution.pose;
      if (step.norm() <=
          options.parameter_tolerance *
              (std::sqrt(p.x * p.x + p.y * p.y + p.theta * p.theta) +
               options.parameter_tolerance)) {
        solution.converged = true;
        return solution;
      }
      const double predicted =
          -step.dot(here.gradient + 0.5 * here.hessian * step);
      const Pose2 trial(p.x + step.x(), p.y + step.y(), p.theta + step.z());
      const PoseCost there = evaluate(trial);
      const double decrease = here.cost - there.cost;
      rho = predicted > 0. && std::isfinite(there.cost) ? decrease / predicted
                                                        : -1.;
      const bool small =
          std::abs(decrease) <= options.function_tolerance * here.cost;
      if (rho > kMinRelativeDecrease) {
        solution.pose = trial;
        solution.at_pose = there;
        ++solution.successful_iterations;
        const double t = 2. * rho - 1.;
        radius =
            std::min(kMaxRadius, radius / std::max(1. / 3., 1. - t * t * t));
        shrink = 2.;
      }
      if (small && std::isfinite(there.cost)) {
        solution.converged = true;
        return solution;
      }
    }
    if (!(rho > kMinRelativeDecrease)) {
      radius /= shrink;
      shrink *= 2.;
      if (radius < kMinRadius) {
        solution.converged = true;
        return solution;
      }
    }
  }
  return solution;
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_POSE_SOLVER_H_
