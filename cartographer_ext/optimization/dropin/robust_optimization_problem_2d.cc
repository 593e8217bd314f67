// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Only where the swap is selected; see the overlay.
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include <algorithm>
#include <iterator>
#include <utility>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/full_information.h"
#include "cartographer_ext/optimization/dropin/robust_optimization_problem_2d.h"
#include "cartographer_ext/optimization/robust_solver.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using Constraint = mapping::PoseGraphInterface::Constraint;
using TrajectoryState = mapping::PoseGraphInterface::TrajectoryState;

// Standard deviation (metres, radians) that holds frozen trajectories in place.
constexpr double kFrozenSigma = 1e-4;

// Factor from the relative weights of the problem to real ones: the median loop
// has the given sigma.
double WeightScale(const std::vector<Constraint>& constraints,
                   const double loop_sigma) {
  std::vector<double> weights;
  for (const Constraint& constraint : constraints) {
    if (constraint.tag == Constraint::INTER_SUBMAP) {
      weights.push_back(constraint.pose.translation_weight);
    }
  }
  const auto middle = weights.begin() + weights.size() / 2;
  std::nth_element(weights.begin(), middle, weights.end());
  return *middle > 0. ? 1. / (*middle * loop_sigma) : 1.;
}

// Of the number of nodes until the next thorough selection.
constexpr double kThoroughGrowth = 2.;

}  // namespace

RobustOptimizationProblem2D::LoopKey RobustOptimizationProblem2D::KeyOf(
    const Constraint& constraint) {
  return LoopKey(
      constraint.submap_id.trajectory_id, constraint.submap_id.submap_index,
      constraint.node_id.trajectory_id, constraint.node_id.node_index);
}

RobustOptimizationProblem2D::RobustOptimizationProblem2D(
    const mapping::optimization::proto::OptimizationProblemOptions& options,
    const proto::RobustOptimizationOptions& extension)
    : extension_(extension),
      local_slam_translation_weight_(
          options.local_slam_pose_translation_weight()),
      local_slam_rotation_weight_(options.local_slam_pose_rotation_weight()),
      stock_(options),
      stock_iterations_(options.ceres_solver_options().max_num_iterations()) {}

RobustOptimizationProblem2D::Problem RobustOptimizationProblem2D::MakeProblem(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state) const {
  Problem problem;
  PoseGraph& graph = problem.graph;
  // In the order of mapping: a submap follows the first node inserted in it, so
  // that the graph can be replayed.
  std::map<SubmapId, NodeId> first_node;
  for (const Constraint& constraint : constraints) {
    if (constraint.tag != Constraint::INTRA_SUBMAP) continue;
    const auto found = first_node.find(constraint.submap_id);
    if (found == first_node.end()) {
      first_node.emplace(constraint.submap_id, constraint.node_id);
    } else if (constraint.node_id < found->second) {
      found->second = constraint.node_id;
    }
  }
  std::map<NodeId, std::vector<SubmapId>> submaps_of_node;
  for (const auto& submap_node : first_node) {
    submaps_of_node[submap_node.second].push_back(submap_node.first);
  }
  std::map<SubmapId, int> vertex_of_submap;
  std::map<NodeId, int> vertex_of_node;
  std::vector<int> frozen;
  const auto is_frozen = [&](const int trajectory_id) {
    const auto it = trajectories_state.find(trajectory_id);
    return it != trajectories_state.end() &&
           it->second == TrajectoryState::FROZEN;
  };
  const auto add_vertex = [&](const int trajectory_id, const Pose2& pose) {
    const int vertex = graph.poses.size();
    graph.ids.push_back(vertex);
    graph.poses.push_back(pose);
    if (is_frozen(trajectory_id) && vertex != 0) frozen.push_back(vertex);
    return vertex;
  };
  const auto& submaps = stock_.submap_data();
  const auto add_submap = [&](const SubmapId& id) {
    if (vertex_of_submap.count(id) != 0 || !submaps.Contains(id)) return;
    vertex_of_submap[id] =
        add_vertex(id.trajectory_id, ToPose2(submaps.at(id).global_pose));
  };
  // The stock problem holds the very first submap.
  if (!submaps.empty()) add_submap((*submaps.begin()).id);
  for (const auto& node : stock_.node_data()) {
    vertex_of_node.emplace_hint(
        vertex_of_node.end(), node.id,
        add_vertex(node.id.trajectory_id, ToPose2(node.data.global_pose_2d)));
    const auto of_node = submaps_of_node.find(node.id);
    if (of_node == submaps_of_node.end()) continue;
    for (const SubmapId& submap : of_node->second) add_submap(submap);
  }
  for (const auto& submap : submaps) add_submap(submap.id);

  const double scale = WeightScale(constraints, extension_.loop_sigma());
  graph.edges.reserve(constraints.size() + graph.poses.size());
  problem.constraint_of_edge.reserve(constraints.size() + graph.poses.size());
  // Constraints of a node mostly follow each other.
  auto node = vertex_of_node.end();
  for (size_t i = 0; i != constraints.size(); ++i) {
    const Constraint& constraint = constraints[i];
    const auto submap = vertex_of_submap.find(constraint.submap_id);
    if (node == vertex_of_node.end() || !(node->first == constraint.node_id)) {
      node = vertex_of_node.find(constraint.node_id);
    }
    if (submap == vertex_of_submap.end() || node == vertex_of_node.end() ||
        !(constraint.pose.translation_weight > 0.) ||
        !(constraint.pose.rotation_weight > 0.)) {
      continue;
    }
    PoseGraphEdge edge;
    edge.from = submap->second;
    edge.to = node->second;
    edge.measurement = ToPose2(transform::Project2D(constraint.pose.zbar_ij));
    edge.information =
        InformationOfWeights(scale * constraint.pose.translation_weight,
                             scale * constraint.pose.rotation_weight);
    edge.is_loop = constraint.tag == Constraint::INTER_SUBMAP;
    graph.edges.push_back(edge);
    problem.constraint_of_edge.push_back(i);
  }
  const auto& nodes = stock_.node_data();
  const bool use_local_slam =
      local_slam_translation_weight_ > 0. && local_slam_rotation_weight_ > 0.;
  for (const int trajectory_id : nodes.trajectory_ids()) {
    if (!use_local_slam) break;
    const auto of_trajectory = nodes.trajectory(trajectory_id);
    auto previous = of_trajectory.begin();
    // Both are in the order of the ids.
    auto vertex = vertex_of_node.find((*previous).id);
    for (auto next = std::next(previous); next != of_trajectory.end();
         previous = next, ++next, ++vertex) {
      const auto first = *previous;
      const auto second = *next;
      if (second.id.node_index != first.id.node_index + 1) continue;
      PoseGraphEdge edge;
      edge.from = vertex->second;
      edge.to = std::next(vertex)->second;
      edge.measurement = ToPose2(first.data.local_pose_2d.inverse() *
                                 second.data.local_pose_2d);
      edge.information =
          InformationOfWeights(scale * local_slam_translation_weight_,
                               scale * local_slam_rotation_weight_);
      problem.neighbours.push_back(graph.edges.size());
      graph.edges.push_back(edge);
      problem.constraint_of_edge.push_back(-1);
    }
  }
  for (const int vertex : frozen) {
    PoseGraphEdge edge;
    edge.from = 0;
    edge.to = vertex;
    edge.measurement = Between(graph.poses[0], graph.poses[vertex]);
    edge.information =
        InformationOfWeights(1. / kFrozenSigma, 1. / kFrozenSigma);
    graph.edges.push_back(edge);
    problem.constraint_of_edge.push_back(-1);
  }
  return problem;
}

void RobustOptimizationProblem2D::Solve(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes) {
  const double start = ThreadCpuSeconds();
  std::vector<SwitchedLoop> off;
  const std::vector<Constraint> kept =
      Select(constraints, trajectories_state, &off);
  int64_t loops = off.size();
  for (const Constraint& constraint : kept) {
    loops += constraint.tag == Constraint::INTER_SUBMAP;
  }
  LOG_IF(INFO, !off.empty())
      << off.size() << " of " << loops << " loop constraints are switched off";
  const double selected = ThreadCpuSeconds();
  stock_.Solve(kept, trajectories_state, landmark_nodes);
  PublishSwitchedLoops(loops, std::move(off), selected - start,
                       ThreadCpuSeconds() - selected);
}

std::vector<RobustOptimizationProblem2D::Constraint>
RobustOptimizationProblem2D::Select(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    std::vector<SwitchedLoop>* const off) {
  int num_loops = 0;
  for (const Constraint& constraint : constraints) {
    num_loops += constraint.tag == Constraint::INTER_SUBMAP;
  }
  if (num_loops == 0 ||
      (!extension_.robust_loops() && !extension_.odometry_check())) {
    return constraints;
  }
  const Problem problem = MakeProblem(constraints, trajectories_state);
  LoopSelectionOptions options;
  options.robust_loops = extension_.robust_loops();
  options.gate = extension_.gate();
  options.odometry_check = extension_.odometry_check();
  options.odometry_gate = extension_.odometry_gate();
  options.max_rollbacks = extension_.max_rollbacks();
  // Now and then, so that all of these together cost twice the last.
  const int num_nodes = stock_.node_data().size();
  options.thorough = num_nodes >= kThoroughGrowth * nodes_when_thorough_;
  if (options.thorough) nodes_when_thorough_ = num_nodes;
  options.left_out_before.assign(problem.graph.edges.size(), false);
  for (size_t i = 0; i != problem.graph.edges.size(); ++i) {
    const int index = problem.constraint_of_edge[i];
    options.left_out_before[i] =
        index >= 0 && problem.graph.edges[i].is_loop &&
        left_out_.count(KeyOf(constraints[index])) != 0;
  }
  const LoopSelection selection =
      SelectLoops(problem.graph, problem.neighbours, options);
  left_out_.clear();
  std::vector<bool> keep(constraints.size(), true);
  for (size_t i = 0; i != problem.graph.edges.size(); ++i) {
    const int index = problem.constraint_of_edge[i];
    if (index < 0 || selection.accepted[i]) continue;
    keep[index] = false;
    left_out_.insert(KeyOf(constraints[index]));
    SwitchedLoop loop;
    loop.submap_trajectory = constraints[index].submap_id.trajectory_id;
    loop.submap_index = constraints[index].submap_id.submap_index;
    loop.node_trajectory = constraints[index].node_id.trajectory_id;
    loop.node_index = constraints[index].node_id.node_index;
    loop.chi2 = selection.chi2[i];
    loop.by_odometry_check =
        std::find(selection.blamed.begin(), selection.blamed.end(),
                  static_cast<int>(i)) != selection.blamed.end();
    off->push_back(loop);
  }
  std::vector<Constraint> kept;
  for (size_t i = 0; i != constraints.size(); ++i) {
    if (keep[i]) kept.push_back(constraints[i]);
  }
  return kept;
}

}  // namespace optimization
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
