// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The accepted loops of runs with the maps of other trajectories. Those from
// before a run was lost are withdrawn once it is located again
// (common/withdrawn_loops.h).
//
// Keeps the same loops as the pose graph, which deletes them with their submaps
// and nodes. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_INTER_TRAJECTORY_LOOPS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_INTER_TRAJECTORY_LOOPS_H_

#include <map>
#include <utility>
#include <vector>

#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_ext/common/pose_graph_context.h"

namespace cartographer_ext {
namespace loop_closure {

// Accepted inter-trajectory loops, see above.
class InterTrajectoryLoops {
 public:
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;

  // Adds an accepted loop. Those within one trajectory are ignored.
  void Add(const Constraint& loop);
  // Withdraws the loops of a run with a map, of nodes up to an index: their
  // marks are added to `constraints`, or to the context if a node may have been
  // trimmed.
  void Withdraw(int trajectory_id, int map_trajectory_id, int last_node,
                PoseGraphContext* context,
                std::vector<Constraint>* constraints);
  // Withdraws one loop.
  void Withdraw(Constraint loop, PoseGraphContext* context,
                std::vector<Constraint>* constraints);
  // The pose graph deletes the loops of a submap, and nodes of its trajectory
  // up to `newest_node`, with the submap.
  void DeleteSubmap(const cartographer::mapping::SubmapId& submap_id,
                    int newest_node, PoseGraphContext* context);
  void DeleteTrajectory(int trajectory_id);

 private:
  // Withdraws a loop by a mark, or in the context.
  void Mark(Constraint loop, PoseGraphContext* context,
            std::vector<Constraint>* constraints);

  // Nodes up to these may have been trimmed after the last deletion of a
  // submap, the one before, and before that. A node belongs to two submaps, so
  // the last are gone.
  struct TrimmedNodes {
    int possibly = -1;
    int probably = -1;
    int certainly = -1;
  };

  // By run and map.
  std::map<std::pair<int, int>, std::vector<Constraint>> loops_;
  std::map<int, TrimmedNodes> trimmed_nodes_;
  bool has_withdrawn_ = false;  // a single one
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_INTER_TRAJECTORY_LOOPS_H_
