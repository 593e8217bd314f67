// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/inter_trajectory_loops.h"

#include <algorithm>
#include <iterator>

#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/swaps.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

void Report(const int64_t num_withdrawn, const int trajectory_id,
            const int map_trajectory_id) {
#ifndef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
  LOG_IF(WARNING, num_withdrawn > 0)
      << num_withdrawn << " withdrawn loop constraints of trajectory "
      << trajectory_id << " with the map of trajectory " << map_trajectory_id
      << " still act: Cartographer is built without the swap "
         "optimization_problem, which skips them. Build it, or remove them "
         "from the saved state with cartographer_ext_optimize.";
#else
  LOG_IF(INFO, num_withdrawn > 0)
      << num_withdrawn << " loop constraints of trajectory " << trajectory_id
      << " with the map of trajectory " << map_trajectory_id
      << " are withdrawn";
#endif
}

}  // namespace

void InterTrajectoryLoops::Add(const Constraint& loop) {
  const int trajectory_id = loop.node_id.trajectory_id;
  const int map_trajectory_id = loop.submap_id.trajectory_id;
  if (trajectory_id == map_trajectory_id) return;
  loops_[std::make_pair(trajectory_id, map_trajectory_id)].push_back(loop);
}

void InterTrajectoryLoops::Withdraw(
    const int trajectory_id, const int map_trajectory_id, const int last_node,
    PoseGraphContext* const context,
    std::vector<Constraint>* const constraints) {
  auto& loops = loops_[std::make_pair(trajectory_id, map_trajectory_id)];
  const auto withdrawn = std::stable_partition(
      loops.begin(), loops.end(), [last_node](const Constraint& loop) {
        return loop.node_id.node_index > last_node;
      });
  const auto num_withdrawn = loops.end() - withdrawn;
  for (auto loop = withdrawn; loop != loops.end(); ++loop) {
    Mark(*loop, context, constraints);
  }
  loops.erase(withdrawn, loops.end());
  Report(num_withdrawn, trajectory_id, map_trajectory_id);
}

void InterTrajectoryLoops::Withdraw(
    Constraint loop, PoseGraphContext* const context,
    std::vector<Constraint>* const constraints) {
  Mark(loop, context, constraints);
  if (!has_withdrawn_) {
    Report(1, loop.node_id.trajectory_id, loop.submap_id.trajectory_id);
  }
  has_withdrawn_ = true;
}

void InterTrajectoryLoops::Mark(Constraint loop,
                                PoseGraphContext* const context,
                                std::vector<Constraint>* const constraints) {
  const auto trimmed = trimmed_nodes_.find(loop.node_id.trajectory_id);
  if (trimmed != trimmed_nodes_.end() &&
      loop.node_id.node_index <= trimmed->second.possibly) {
    // A constraint of a trimmed node would be fatal in the pose graph.
    context->Get<WithdrawnLoops>()->Add(
        MakeLoopId(loop.submap_id, loop.node_id));
    return;
  }
  loop.pose.translation_weight = 0.;
  loop.pose.rotation_weight = 0.;
  constraints->push_back(loop);
}

void InterTrajectoryLoops::DeleteSubmap(
    const cartographer::mapping::SubmapId& submap_id, const int newest_node,
    PoseGraphContext* const context) {
  context->Get<WithdrawnLoops>()->EraseSubmap(submap_id.trajectory_id,
                                              submap_id.submap_index);
  TrimmedNodes& trimmed = trimmed_nodes_[submap_id.trajectory_id];
  const int gone = trimmed.certainly;
  trimmed.certainly = trimmed.probably;
  trimmed.probably = trimmed.possibly;
  trimmed.possibly = std::max(trimmed.possibly, newest_node);
  for (auto& of_map : loops_) {
    auto& loops = of_map.second;
    loops.erase(std::remove_if(loops.begin(), loops.end(),
                               [&](const Constraint& loop) {
                                 return loop.submap_id == submap_id ||
                                        (loop.node_id.trajectory_id ==
                                             submap_id.trajectory_id &&
                                         loop.node_id.node_index <= gone);
                               }),
                loops.end());
  }
}

void InterTrajectoryLoops::DeleteTrajectory(const int trajectory_id) {
  trimmed_nodes_.erase(trajectory_id);
  for (auto it = loops_.begin(); it != loops_.end();) {
    const bool is_of_it =
        it->first.first == trajectory_id || it->first.second == trajectory_id;
    it = is_of_it ? loops_.erase(it) : std::next(it);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
