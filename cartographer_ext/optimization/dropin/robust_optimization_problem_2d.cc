// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Only where the swap is selected; see the overlay.
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include <algorithm>
#include <memory>
#include <utility>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/optimization/dropin/loops_in_force.h"
#include "cartographer_ext/optimization/dropin/recent_solve.h"
#include "cartographer_ext/optimization/dropin/robust_optimization_problem_2d.h"
#include "cartographer_ext/optimization/dropin/running_solve.h"
#include "cartographer_ext/optimization/dropin/stock_solve.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "cartographer_ext/uncertainty/loop_ambiguity.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;
using Constraint = mapping::PoseGraphInterface::Constraint;
using TrajectoryState = mapping::PoseGraphInterface::TrajectoryState;

LoopId LoopIdOf(const Constraint& constraint) {
  return MakeLoopId(constraint.submap_id, constraint.node_id);
}

// A loop that is further from the map is not in force.
constexpr double kOffSigmas = 3.;
// Of the matches of a run, the share of wrong ones up to which its loops are put
// in force. Corridors with a laser of 5.6 m have up to 0.19, equal shelves 0.7.
constexpr double kMostWrong = 0.25;
// Without the loops that contradict it the map moves, away from others maybe.
constexpr int kMostTimesTakenBack = 3;
// Of the number of nodes until the next thorough selection.
constexpr double kThoroughGrowth = 2.;
// Of the number of nodes until the next optimisation of the whole graph: in any
// case, and where one of the newest part has moved a node by more than what
// local SLAM drifts between two optimisations, metres and radians, or
// contradicts more than a share of the loops.
constexpr double kWholeGrowth = 1.1;
constexpr double kLeastWholeGrowth = 1.01;
constexpr double kLargestMove = 0.25;
constexpr double kLargestTurn = 0.05;
constexpr double kContradictedShare = 0.05;

// Loops of another loop closure than ours may be.
bool AreLoopsUnambiguous(PoseGraphContext* const context) {
  if (context == nullptr) return false;
  const auto share_wrong =
      context->Get<uncertainty::LoopAmbiguity>()->share_wrong();
  return share_wrong.has_value() && *share_wrong <= kMostWrong;
}

}  // namespace

RobustOptimizationProblem2D::RobustOptimizationProblem2D(
    const mapping::optimization::proto::OptimizationProblemOptions& options,
    const proto::RobustOptimizationOptions& extension)
    : extension_(extension),
      options_(options),
      stock_(options),
      stock_iterations_(options.ceres_solver_options().max_num_iterations()) {}

SlamPoseGraph RobustOptimizationProblem2D::MakeProblem(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state) const {
  SlamGraph slam;
  for (const auto& node : stock_.node_data()) {
    SlamNode slam_node;
    slam_node.id = {node.id.trajectory_id, node.id.node_index};
    slam_node.local_pose = ToPose2(node.data.local_pose_2d);
    slam_node.global_pose = ToPose2(node.data.global_pose_2d);
    slam.nodes.push_back(slam_node);
  }
  for (const auto& submap : stock_.submap_data()) {
    SlamSubmap slam_submap;
    slam_submap.id = {submap.id.trajectory_id, submap.id.submap_index};
    slam_submap.global_pose = ToPose2(submap.data.global_pose);
    slam.submaps.push_back(slam_submap);
  }
  slam.constraints.reserve(constraints.size());
  for (const Constraint& constraint : constraints) {
    SlamConstraint slam_constraint;
    slam_constraint.id = MakeLoopId(constraint.submap_id, constraint.node_id);
    slam_constraint.relative_pose =
        ToPose2(transform::Project2D(constraint.pose.zbar_ij));
    slam_constraint.translation_weight = constraint.pose.translation_weight;
    slam_constraint.rotation_weight = constraint.pose.rotation_weight;
    slam_constraint.is_loop = constraint.tag == Constraint::INTER_SUBMAP;
    slam.constraints.push_back(slam_constraint);
  }
  for (const auto& state : trajectories_state) {
    if (state.second == TrajectoryState::FROZEN) {
      slam.frozen_trajectories.insert(state.first);
    }
  }
  SlamPoseGraphOptions options;
  options.loop_sigma = extension_.loop_sigma();
  options.local_slam_translation_weight =
      options_.local_slam_pose_translation_weight();
  options.local_slam_rotation_weight =
      options_.local_slam_pose_rotation_weight();
  return MakeSlamPoseGraph(slam, options);
}

void RobustOptimizationProblem2D::Solve(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes) {
  const std::shared_ptr<PoseGraphContext> context = PoseGraphContext::Current();
  if (SolveRecentPart(constraints, trajectories_state, landmark_nodes,
                      context.get())) {
    return;
  }
  SolveWhole(constraints, trajectories_state, landmark_nodes, context.get());
  if (recent_nodes() == 0) return;
  for (const auto& node : stock_.node_data()) {
    nodes_.at(node.id).global_pose_2d = node.data.global_pose_2d;
  }
  for (const auto& submap : stock_.submap_data()) {
    submaps_.at(submap.id).global_pose = submap.data.global_pose;
  }
  nodes_when_whole_ = static_cast<int>(nodes_.size());
  grown_.clear();
}

void RobustOptimizationProblem2D::SolveWhole(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes,
    PoseGraphContext* const context) {
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
  const bool is_solved =
      !is_final_ && extension_.running_tolerance() > 0. &&
      landmark_nodes.empty() && !HasFixedFrames() &&
      SolveRunning(options_, kept, trajectories_state,
                   extension_.running_tolerance(), context, &stock_);
  if (!is_solved) {
    StockSolve(kept, trajectories_state, landmark_nodes, context, nullptr,
               &stock_);
  }
  absl::optional<Relaxation> relaxation;
#ifdef CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION
  if (is_final_ && extension_.loops_in_force() && landmark_nodes.empty() &&
      !HasFixedFrames() && AreLoopsUnambiguous(context)) {
    relaxation = PutInForce(kept, trajectories_state, context);
  }
#endif
  if (context == nullptr) return;
  if (is_final_ && extension_.loops_in_force()) {
    TakeBack(relaxation, trajectories_state, landmark_nodes, context, kept);
  }
  context->Get<SwitchedLoopRecorder>()->Record(
      loops, std::move(off), selected - start, ThreadCpuSeconds() - selected);
}

bool RobustOptimizationProblem2D::HasFixedFrames() const {
  for (const int trajectory_id : stock_.node_data().trajectory_ids()) {
    if (stock_.fixed_frame_pose_data().HasTrajectory(trajectory_id)) {
      return true;
    }
  }
  return false;
}

absl::optional<Relaxation> RobustOptimizationProblem2D::PutInForce(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    PoseGraphContext* const context) {
  absl::optional<Relaxation> last;
  const LoopsPutInForce result = PutLoopsInForce(
      [&](const Relaxation* const relaxation) {
        last = relaxation == nullptr ? absl::nullopt
                                     : absl::make_optional(*relaxation);
        StockSolve(constraints, trajectories_state, {}, context, relaxation,
                   &stock_);
      },
      [&] {
        return CountLoopsOffMap(constraints, stock_.node_data(),
                                stock_.submap_data(),
                                kOffSigmas * extension_.loop_sigma());
      },
      RelaxationsOf(options_, constraints));
  LOG_IF(INFO, result.tried)
      << result.before.off << " of " << result.before.loops
      << " loops were off the map, "
      << (result.relaxed ? "relaxed" : "relaxed in vain") << ": "
      << result.after.off;
  context->Get<SwitchedLoopRecorder>()->Record(result);
  return last;
}

void RobustOptimizationProblem2D::TakeBack(
    const absl::optional<Relaxation>& relaxation,
    const std::map<int, TrajectoryState>& trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes,
    PoseGraphContext* const context, std::vector<Constraint> constraints) {
  std::set<LoopId> taken;
  for (int i = 0; i < kMostTimesTakenBack; ++i) {
    const std::vector<LoopId> off =
        TakeOutFarOff(stock_.node_data(), stock_.submap_data(), &constraints);
    if (off.empty()) break;
    taken.insert(off.begin(), off.end());
    StockSolve(constraints, trajectories_state, landmark_nodes, context,
               relaxation.has_value() ? &*relaxation : nullptr, &stock_);
  }
  for (const LoopId& loop : taken) context->Get<WithdrawnLoops>()->Add(loop);
  LOG_IF(INFO, !taken.empty())
      << taken.size() << " loops are taken back: the map contradicts them";
  context->Get<SwitchedLoopRecorder>()->RecordTakenBack(std::move(taken));
}

bool RobustOptimizationProblem2D::SolveRecentPart(
    const std::vector<Constraint>& constraints,
    const std::map<int, TrajectoryState>& trajectories_state,
    const std::map<std::string, LandmarkNode>& landmark_nodes,
    PoseGraphContext* const context) {
  const int num_nodes = static_cast<int>(nodes_.size());
  if (recent_nodes() == 0 || num_nodes <= recent_nodes() ||
      num_nodes >= kWholeGrowth * nodes_when_whole_ || grown_.size() != 1 ||
      !landmark_nodes.empty()) {
    return false;
  }
  const int trajectory_id = *grown_.begin();
  const auto state = trajectories_state.find(trajectory_id);
  if ((state != trajectories_state.end() &&
       state->second == TrajectoryState::FROZEN) ||
      stock_.fixed_frame_pose_data().HasTrajectory(trajectory_id) ||
      (context != nullptr && context->Get<LoopInformation>()->size() != 0)) {
    return false;
  }
  auto first = nodes_.EndOfTrajectory(trajectory_id);
  for (int i = 0;
       i < recent_nodes() && first != nodes_.BeginOfTrajectory(trajectory_id);
       ++i) {
    --first;
  }
  const RecentResult result = SolveRecent(
      options_, constraints,
      [this](const Constraint& constraint) {
        return constraint.tag != Constraint::INTER_SUBMAP ||
               switched_off_.count(LoopIdOf(constraint)) == 0;
      },
      (*first).id, GraphPoses{&nodes_, &submaps_});
  if (!result.usable) return false;
  // Wrong loops are contradicted for ever, so even then not each time.
  return (result.largest_move <= kLargestMove &&
          result.largest_turn <= kLargestTurn &&
          result.num_contradicted <= kContradictedShare * result.num_loops) ||
         num_nodes < kLeastWholeGrowth * nodes_when_whole_;
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
  const SlamPoseGraph problem = MakeProblem(constraints, trajectories_state);
  LoopSelectionOptions options;
  options.robust_loops = extension_.robust_loops();
  options.odometry_check = extension_.odometry_check();
  // Now and then, so that all of these together cost twice the last.
  const int num_nodes = stock_.node_data().size();
  options.thorough = num_nodes >= kThoroughGrowth * nodes_when_thorough_;
  if (options.thorough) nodes_when_thorough_ = num_nodes;
  options.left_out_before.assign(problem.graph.edges.size(), false);
  for (size_t i = 0; i != problem.graph.edges.size(); ++i) {
    const int index = problem.constraint_of_edge[i];
    options.left_out_before[i] =
        index >= 0 && problem.graph.edges[i].is_loop &&
        switched_off_.count(LoopIdOf(constraints[index])) != 0;
  }
  const LoopSelection selection =
      SelectLoops(problem.graph, problem.local_slam_edges, options);
  switched_off_.clear();
  std::vector<bool> keep(constraints.size(), true);
  for (size_t i = 0; i != problem.graph.edges.size(); ++i) {
    const int index = problem.constraint_of_edge[i];
    if (index < 0 || selection.accepted[i]) continue;
    keep[index] = false;
    SwitchedLoop loop;
    static_cast<LoopId&>(loop) = LoopIdOf(constraints[index]);
    switched_off_.insert(loop);
    loop.chi2 = selection.chi2[i];
    loop.by_odometry_check =
        std::find(selection.suspects.begin(), selection.suspects.end(),
                  static_cast<int>(i)) != selection.suspects.end();
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
