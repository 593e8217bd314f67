// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/loop_withdrawer.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/swaps.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// `loops`: which loop constraints, in words.
void Report(const std::string& loops) {
#ifndef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
  LOG(WARNING) << "Loop constraints are withdrawn, but still act: " << loops
               << ". Cartographer is built without the swap "
                  "optimization_problem, which skips them. Build it, or remove "
                  "them from the saved state with cartographer_ext_optimize.";
#else
  LOG(INFO) << "Loop constraints are withdrawn: " << loops;
#endif
}

}  // namespace

void LoopWithdrawer::Add(const Constraint& loop,
                         PoseGraphContext* const context,
                         std::vector<Constraint>* const constraints) {
  // Its node was not trimmed, or the loop would not have been accepted again.
  if (context->Get<WithdrawnLoops>()->Erase(
          MakeLoopId(loop.submap_id, loop.node_id))) {
    constraints->push_back(WithdrawalMark(loop));
  }
  const int trajectory_id = loop.node_id.trajectory_id;
  const int map_trajectory_id = loop.submap_id.trajectory_id;
  if (trajectory_id == map_trajectory_id) return;
  loops_[std::make_pair(trajectory_id, map_trajectory_id)].push_back(loop);
}

void LoopWithdrawer::Withdraw(const int trajectory_id,
                              const int map_trajectory_id, const int last_node,
                              PoseGraphContext* const context,
                              std::vector<Constraint>* const constraints) {
  auto& loops = loops_[std::make_pair(trajectory_id, map_trajectory_id)];
  const auto withdrawn = std::stable_partition(
      loops.begin(), loops.end(), [last_node](const Constraint& loop) {
        return loop.node_id.node_index > last_node;
      });
  const auto num_withdrawn = loops.end() - withdrawn;
  for (auto loop = withdrawn; loop != loops.end(); ++loop) {
    MarkOrNote(*loop, context, constraints);
  }
  loops.erase(withdrawn, loops.end());
  if (num_withdrawn == 0) return;
  Report(absl::StrCat(num_withdrawn, " of trajectory ", trajectory_id,
                      " with the map of trajectory ", map_trajectory_id));
}

void LoopWithdrawer::Withdraw(const Constraint& loop,
                              PoseGraphContext* const context,
                              std::vector<Constraint>* const constraints) {
  MarkOrNote(loop, context, constraints);
  const int trajectory_id = loop.node_id.trajectory_id;
  if (!reported_.insert(trajectory_id).second) return;
  Report(absl::StrCat("some within trajectory ", trajectory_id,
                      " (reported once)"));
}

void LoopWithdrawer::MarkOrNote(
    const Constraint& loop, PoseGraphContext* const context,
    std::vector<Constraint>* const constraints) const {
  const auto trimmed = trimmed_nodes_.find(loop.node_id.trajectory_id);
  if (trimmed != trimmed_nodes_.end() &&
      loop.node_id.node_index <= trimmed->second.possibly) {
    // A constraint of a trimmed node would be fatal in the pose graph.
    context->Get<WithdrawnLoops>()->Add(
        MakeLoopId(loop.submap_id, loop.node_id));
    return;
  }
  constraints->push_back(WithdrawalMark(loop));
}

void LoopWithdrawer::DeleteSubmap(
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

void LoopWithdrawer::DeleteTrajectory(const int trajectory_id) {
  trimmed_nodes_.erase(trajectory_id);
  reported_.erase(trajectory_id);
  for (auto it = loops_.begin(); it != loops_.end();) {
    const bool is_of_it =
        it->first.first == trajectory_id || it->first.second == trajectory_id;
    it = is_of_it ? loops_.erase(it) : std::next(it);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
