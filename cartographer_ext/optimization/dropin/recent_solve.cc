// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Only where the swap is selected; see the overlay.
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/optimization/dropin/loops_in_force.h"
#include "cartographer_ext/optimization/dropin/recent_solve.h"
#include "ceres/ceres.h"

namespace cartographer_ext {
namespace optimization {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using mapping::NodeId;
using mapping::SubmapId;
using Constraint = mapping::PoseGraphInterface::Constraint;
using Values = std::array<double, 3>;  // x, y, theta

// A loop that is off by more is contradicted, metres and radians.
constexpr double kContradictedMetres = 0.25;
constexpr double kContradictedRadians = 0.05;

Values ToValues(const transform::Rigid2d& pose) {
  return {{pose.translation().x(), pose.translation().y(),
           pose.normalized_angle()}};
}

transform::Rigid2d ToPose(const Values& values) {
  return transform::Rigid2d({values[0], values[1]}, values[2]);
}

// One optimisation: collects the terms, solves, writes the poses back.
class RecentSolver {
 public:
  RecentSolver(
      const mapping::optimization::proto::OptimizationProblemOptions& options,
      const NodeId& first_node, const GraphPoses& poses)
      : options_(options), first_node_(first_node), poses_(poses) {}

  // From the newest constraint to the oldest, as far as they may touch an
  // unknown.
  void Collect(const std::vector<Constraint>& constraints,
               const std::function<bool(const Constraint&)>& is_in_force) {
    FindFreeSubmaps(constraints);
    if (free_submaps_.empty()) return;
    const int oldest_submap = free_submaps_.begin()->submap_index;
    for (auto it = constraints.rbegin(); it != constraints.rend(); ++it) {
      if (it->tag == Constraint::INTRA_SUBMAP &&
          it->submap_id.trajectory_id == first_node_.trajectory_id &&
          it->submap_id.submap_index < oldest_submap && !IsFree(it->node_id)) {
        // It and the older ones are of nodes that have left the free submaps,
        // unless it belongs to the older one of its node's two submaps.
        if (++num_older_ > 1) break;
        continue;
      }
      if (it->tag == Constraint::INTRA_SUBMAP) num_older_ = 0;
      if ((IsFree(it->node_id) || IsFree(it->submap_id)) && is_in_force(*it)) {
        terms_.push_back(&*it);
      }
    }
  }

  RecentResult Solve() {
    RecentResult result;
    if (terms_.empty()) return result;
    // In the order in which they were added.
    for (auto it = terms_.rbegin(); it != terms_.rend(); ++it) {
      const Constraint& term = **it;
      problem_.AddResidualBlock(
          mapping::optimization::CreateAnalyticalSpaCostFunction(term.pose),
          term.tag == Constraint::INTER_SUBMAP
              ? new ceres::HuberLoss(options_.huber_scale())
              : nullptr,
          ValuesOf(term.submap_id)->data(), ValuesOf(term.node_id)->data());
    }
    AddLocalSlam();
    for (const NodeId& id : held_nodes_) {
      problem_.SetParameterBlockConstant(nodes_.at(id).data());
    }
    for (const SubmapId& id : held_submaps_) {
      problem_.SetParameterBlockConstant(submaps_.at(id).data());
    }
    ceres::Solver::Options options =
        cartographer::common::CreateCeresSolverOptions(
            options_.ceres_solver_options());
    // With several threads the order of summation in Ceres varies.
    options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    result.usable = summary.IsSolutionUsable();
    if (!result.usable) return result;
    Store(&result);
    return result;
  }

 private:
  bool IsFree(const NodeId& id) const {
    return id.trajectory_id == first_node_.trajectory_id &&
           id.node_index >= first_node_.node_index;
  }
  bool IsFree(const SubmapId& id) const { return free_submaps_.count(id) != 0; }

  void FindFreeSubmaps(const std::vector<Constraint>& constraints) {
    for (auto it = constraints.rbegin(); it != constraints.rend(); ++it) {
      if (it->tag != Constraint::INTRA_SUBMAP ||
          it->node_id.trajectory_id != first_node_.trajectory_id) {
        continue;
      }
      if (!IsFree(it->node_id)) break;
      if (it->submap_id != (*poses_.submaps->begin()).id) {
        free_submaps_.insert(it->submap_id);
      }
    }
  }

  Values* ValuesOf(const NodeId& id) {
    const auto added = nodes_.emplace(id, Values());
    if (added.second) {
      added.first->second = ToValues(poses_.nodes->at(id).global_pose_2d);
      if (!IsFree(id)) held_nodes_.insert(id);
    }
    return &added.first->second;
  }

  Values* ValuesOf(const SubmapId& id) {
    const auto added = submaps_.emplace(id, Values());
    if (added.second) {
      added.first->second = ToValues(poses_.submaps->at(id).global_pose);
      if (!IsFree(id)) held_submaps_.insert(id);
    }
    return &added.first->second;
  }

  // Between nodes that follow each other, without a trimmed one in between.
  void AddLocalSlam() {
    const auto end = poses_.nodes->EndOfTrajectory(first_node_.trajectory_id);
    auto previous = poses_.nodes->find(first_node_);
    if (previous !=
        poses_.nodes->BeginOfTrajectory(first_node_.trajectory_id)) {
      --previous;
    }
    for (auto next = std::next(previous); next != end;
         previous = next, ++next) {
      const auto first = *previous;
      const auto second = *next;
      if (second.id.node_index != first.id.node_index + 1) continue;
      const Constraint::Pose step{
          transform::Embed3D(first.data.local_pose_2d.inverse() *
                             second.data.local_pose_2d),
          options_.local_slam_pose_translation_weight(),
          options_.local_slam_pose_rotation_weight()};
      problem_.AddResidualBlock(
          mapping::optimization::CreateAnalyticalSpaCostFunction(step), nullptr,
          ValuesOf(first.id)->data(), ValuesOf(second.id)->data());
    }
  }

  void Store(RecentResult* const result) {
    for (const auto& node : nodes_) {
      if (held_nodes_.count(node.first) != 0) continue;
      transform::Rigid2d& pose = poses_.nodes->at(node.first).global_pose_2d;
      const transform::Rigid2d move = pose.inverse() * ToPose(node.second);
      pose = ToPose(node.second);
      ++result->num_nodes;
      result->largest_move =
          std::max(result->largest_move, move.translation().norm());
      result->largest_turn =
          std::max(result->largest_turn, std::abs(move.normalized_angle()));
    }
    for (const auto& submap : submaps_) {
      if (held_submaps_.count(submap.first) != 0) continue;
      poses_.submaps->at(submap.first).global_pose = ToPose(submap.second);
    }
    for (const Constraint* const term : terms_) {
      if (term->tag != Constraint::INTER_SUBMAP) continue;
      ++result->num_loops;
      result->num_contradicted +=
          IsOff(*term, ToPose(submaps_.at(term->submap_id)),
                ToPose(nodes_.at(term->node_id)), kContradictedMetres,
                kContradictedRadians);
    }
  }

  const mapping::optimization::proto::OptimizationProblemOptions& options_;
  const NodeId first_node_;
  const GraphPoses poses_;
  std::set<SubmapId> free_submaps_;
  int num_older_ = 0;
  std::vector<const Constraint*> terms_;  // newest first
  // Ceres keeps pointers to these values.
  std::map<NodeId, Values> nodes_;
  std::map<SubmapId, Values> submaps_;
  std::set<NodeId> held_nodes_;
  std::set<SubmapId> held_submaps_;
  ceres::Problem problem_;
};

}  // namespace

RecentResult SolveRecent(
    const mapping::optimization::proto::OptimizationProblemOptions& options,
    const std::vector<Constraint>& constraints,
    const std::function<bool(const Constraint&)>& is_in_force,
    const NodeId& first_node, const GraphPoses& poses) {
  RecentSolver solver(options, first_node, poses);
  solver.Collect(constraints, is_in_force);
  return solver.Solve();
}

}  // namespace optimization
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
