// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Withdraws accepted loops (common/withdrawn_loops.h): single ones that others
// contradict since, and those of a run with the map of another trajectory from
// before it was lost, once it is located again.
//
// For the latter it keeps the same loops as the pose graph, which deletes them
// with their submaps and nodes. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_LOOP_WITHDRAWER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_LOOP_WITHDRAWER_H_

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_ext/common/pose_graph_context.h"

namespace cartographer_ext {
namespace loop_closure {

// Withdraws accepted loops, see above. What withdraws them is added to
// `constraints`, or to the context if a node may have been trimmed.
class LoopWithdrawer {
 public:
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;

  // To be called for every accepted loop. Adds what it takes for a loop that was
  // withdrawn to count again, before the loop itself.
  void Add(const Constraint& loop, PoseGraphContext* context,
           std::vector<Constraint>* constraints);
  // Withdraws the loops of a run with the map of another trajectory, of nodes up
  // to an index.
  void Withdraw(int trajectory_id, int map_trajectory_id, int last_node,
                PoseGraphContext* context,
                std::vector<Constraint>* constraints);
  // Withdraws one loop within a trajectory.
  void Withdraw(const Constraint& loop, PoseGraphContext* context,
                std::vector<Constraint>* constraints);
  // The pose graph deletes the loops of a submap, and nodes of its trajectory
  // up to `newest_node`, with the submap.
  void DeleteSubmap(const cartographer::mapping::SubmapId& submap_id,
                    int newest_node, PoseGraphContext* context);
  void DeleteTrajectory(int trajectory_id);

 private:
  // Withdraws a loop by a mark, or in the context.
  void MarkOrNote(const Constraint& loop, PoseGraphContext* context,
                  std::vector<Constraint>* constraints) const;

  // Nodes up to these may have been trimmed after the last deletion of a
  // submap, the one before, and before that. A node belongs to two submaps, so
  // the last are gone.
  struct TrimmedNodes {
    int possibly = -1;
    int probably = -1;
    int certainly = -1;
  };

  // Inter-trajectory loops by run and map.
  std::map<std::pair<int, int>, std::vector<Constraint>> loops_;
  std::map<int, TrimmedNodes> trimmed_nodes_;
  std::set<int> reported_;  // trajectories of single loops
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_LOOP_WITHDRAWER_H_
