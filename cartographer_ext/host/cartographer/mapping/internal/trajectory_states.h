// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The life of the trajectories of a pose graph. A deletion has three steps: it
// is requested by the user, confirmed when the work queue reaches it, and
// carried out after the next optimisation.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_STATES_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_STATES_H_

#include <map>
#include <set>
#include <vector>

#include "cartographer/mapping/pose_graph_interface.h"

namespace cartographer {
namespace mapping {

// Not thread-safe.
class TrajectoryStates {
 public:
  using State = PoseGraphInterface::TrajectoryState;

  // A new trajectory is active; nothing happens to a known one.
  void Add(int trajectory_id) { states_.emplace(trajectory_id, State::ACTIVE); }
  // The trajectory need not be known. A deletion ends with DELETED.
  void Set(int trajectory_id, State state);

  bool Contains(int trajectory_id) const;
  // False for an unknown trajectory.
  bool Is(int trajectory_id, State state) const;
  // Whether data may be added: unknown trajectories begin with it, those that
  // are finished, deleted or about to be deleted take no more.
  bool AcceptsData(int trajectory_id) const;

  // False where the trajectory is neither finished nor frozen.
  bool ConfirmDeletion(int trajectory_id);
  // Trajectories that are still to be deleted.
  std::vector<int> ConfirmedDeletions() const;

  const std::map<int, State>& all() const { return states_; }

 private:
  std::map<int, State> states_;
  std::set<int> confirmed_deletions_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_STATES_H_
