// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The accepted loops of runs with the maps of other trajectories, for the day
// that a run turns out to have been lost: the loops from before locate it
// wrongly and are withdrawn.
//
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_INTER_TRAJECTORY_LOOPS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_INTER_TRAJECTORY_LOOPS_H_

#include <deque>
#include <map>
#include <utility>

#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_ext/common/full_information.h"

namespace cartographer_ext {
namespace loop_closure {

class InterTrajectoryLoops {
 public:
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;

  // An accepted loop. Those within one trajectory are ignored.
  void Add(const Constraint& loop);
  // The loops of nodes of a run up to an index in a map get no information, so
  // that the optimization goes without them.
  void Withdraw(int trajectory_id, int map_trajectory_id, int last_node);
  void DeleteTrajectory(int trajectory_id);

 private:
  // Node index and constraint.
  using Loops = std::deque<std::pair<int, ConstraintBits>>;

  std::map<std::pair<int, int>, Loops> loops_;  // by run and map
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_INTER_TRAJECTORY_LOOPS_H_
