// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Only where the swap is selected; see the overlay.
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include <iterator>

#include "Eigen/Core"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/optimization/dropin/running_solve.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using Constraint = mapping::PoseGraphInterface::Constraint;
using Problem = mapping::optimization::StockOptimizationProblem2D;
using ProblemOptions = mapping::optimization::proto::OptimizationProblemOptions;
using TrajectoryState = mapping::PoseGraphInterface::TrajectoryState;

// Relative decrease of the cost at which Ceres ends, too.
constexpr double kCostTolerance = 1e-6;
// Odometry with less than this share of the weights of local SLAM has less than
// a ten thousandth of its information, and does not count.
constexpr double kNegligibleOdometry = 1e-2;

bool IsOdometryNegligible(const ProblemOptions& options) {
  return options.odometry_translation_weight() <=
             kNegligibleOdometry *
                 options.local_slam_pose_translation_weight() &&
         options.odometry_rotation_weight() <=
             kNegligibleOdometry * options.local_slam_pose_rotation_weight();
}

Eigen::Matrix3d SqrtOfWeights(const double translation_weight,
                              const double rotation_weight) {
  return Eigen::Vector3d(translation_weight, translation_weight,
                         rotation_weight)
      .asDiagonal();
}

// Cartographer's problem as edges between poses: submaps first, then nodes.
class RunningProblem {
 public:
  explicit RunningProblem(Problem* const problem) : problem_(*problem) {
    for (const auto& submap : problem_.submap_data()) {
      submaps_.emplace_hint(submaps_.end(), submap.id,
                            AddPose(submap.data.global_pose));
    }
    for (const auto& node : problem_.node_data()) {
      nodes_.emplace_hint(nodes_.end(), node.id,
                          AddPose(node.data.global_pose_2d));
    }
  }

  void AddConstraints(const std::vector<Constraint>& constraints,
                      const LoopInformation* const information) {
    edges_.reserve(constraints.size() + nodes_.size());
    for (const Constraint& constraint : constraints) {
      WhitenedEdge edge;
      edge.from = submaps_.at(constraint.submap_id);
      edge.to = nodes_.at(constraint.node_id);
      edge.is_loop = constraint.tag == Constraint::INTER_SUBMAP;
      if (!edge.is_loop || information == nullptr ||
          !information->FindSqrt(
              MakeLoopId(constraint.submap_id, constraint.node_id),
              &edge.whitening)) {
        edge.whitening = SqrtOfWeights(constraint.pose.translation_weight,
                                       constraint.pose.rotation_weight);
      }
      AddEdge(transform::Project2D(constraint.pose.zbar_ij), edge);
    }
  }

  // Between nodes that follow each other, without a trimmed one in between.
  void AddLocalSlam(const ProblemOptions& options) {
    WhitenedEdge edge;
    edge.whitening = SqrtOfWeights(options.local_slam_pose_translation_weight(),
                                   options.local_slam_pose_rotation_weight());
    const auto& nodes = problem_.node_data();
    for (const int trajectory_id : nodes.trajectory_ids()) {
      const auto end = nodes.EndOfTrajectory(trajectory_id);
      auto previous = nodes.BeginOfTrajectory(trajectory_id);
      for (auto next = std::next(previous); next != end;
           previous = next, ++next) {
        const auto first = *previous;
        const auto second = *next;
        if (second.id.node_index != first.id.node_index + 1) continue;
        edge.from = nodes_.at(first.id);
        edge.to = nodes_.at(second.id);
        AddEdge(first.data.local_pose_2d.inverse() * second.data.local_pose_2d,
                edge);
      }
    }
  }

  bool Solve(const double huber_scale, const int max_iterations,
             const double tolerance) {
    SolverOptions options;
    options.kernel.type = KernelType::kHuber;
    options.kernel.parameter = huber_scale;
    options.max_iterations = max_iterations;
    options.cost_tolerance = kCostTolerance;
    options.step_tolerance = tolerance;
    options.prune = false;
    const SolverSummary summary = SolveRobust(edges_, options, &poses_);
    return summary.converged || summary.iterations == max_iterations;
  }

  // Cartographer's problem has no function for this. Its poses are parts of an
  // object that is not constant, seen through a constant reference.
  void Store() const {
    for (const auto& submap : submaps_) {
      const auto& data = problem_.submap_data().at(submap.first);
      const_cast<transform::Rigid2d&>(data.global_pose) =
          ToRigid2d(poses_[submap.second]);
    }
    for (const auto& node : nodes_) {
      const auto& data = problem_.node_data().at(node.first);
      const_cast<transform::Rigid2d&>(data.global_pose_2d) =
          ToRigid2d(poses_[node.second]);
    }
  }

 private:
  int AddPose(const transform::Rigid2d& pose) {
    poses_.push_back(ToPose2(pose));
    return static_cast<int>(poses_.size()) - 1;
  }

  void AddEdge(const transform::Rigid2d& measured, WhitenedEdge edge) {
    edge.measurement =
        Eigen::Vector3d(measured.translation().x(), measured.translation().y(),
                        measured.rotation().angle());
    edges_.push_back(edge);
  }

  const Problem& problem_;
  std::map<mapping::SubmapId, int> submaps_;  // indices into poses_
  std::map<mapping::NodeId, int> nodes_;
  std::vector<Pose2> poses_;
  std::vector<WhitenedEdge> edges_;
};

}  // namespace

bool SolveRunning(const ProblemOptions& options,
                  const std::vector<Constraint>& constraints,
                  const std::map<int, TrajectoryState>& trajectories_state,
                  const double tolerance, PoseGraphContext* const context,
                  Problem* const problem) {
  if (!IsOdometryNegligible(options)) return false;
  for (const auto& state : trajectories_state) {
    if (state.second == TrajectoryState::FROZEN) return false;
  }
  RunningProblem running(problem);
  running.AddConstraints(constraints, context == nullptr
                                          ? nullptr
                                          : context->Get<LoopInformation>());
  running.AddLocalSlam(options);
  if (!running.Solve(options.huber_scale(),
                     options.ceres_solver_options().max_num_iterations(),
                     tolerance)) {
    return false;
  }
  running.Store();
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
