// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which trajectories are connected by constraints, directly or through others,
// and since when. A connection that joins two groups counts for every pair
// across them.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_CONNECTIVITY_STATE_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_CONNECTIVITY_STATE_H_

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "cartographer/common/time.h"

namespace cartographer {
namespace mapping {

// Not thread-safe.
class TrajectoryConnectivityState {
 public:
  TrajectoryConnectivityState() {}
  TrajectoryConnectivityState(const TrajectoryConnectivityState&) = delete;
  TrajectoryConnectivityState& operator=(const TrajectoryConnectivityState&) =
      delete;

  // A trajectory connected to itself only; nothing happens if it is known.
  void Add(int trajectory_id);

  // Both become known if they are not. The time of a connection does not go
  // back.
  void Connect(int trajectory_id_a, int trajectory_id_b, common::Time time);

  // True for a trajectory and itself, even if it is not known.
  bool TransitivelyConnected(int trajectory_id_a, int trajectory_id_b) const;

  // The groups of connected trajectories, sorted by their smallest member, each
  // sorted itself.
  std::vector<std::vector<int>> Components() const;

  // The beginning of universal time for trajectories that never were connected.
  common::Time LastConnectionTime(int trajectory_id_a,
                                  int trajectory_id_b) const;

 private:
  // Trajectories of one group share one set of its members.
  using Group = std::shared_ptr<std::set<int>>;

  const Group& GroupOf(int trajectory_id);

  std::map<int, Group> groups_;
  // By (smaller, larger) trajectory id.
  std::map<std::pair<int, int>, common::Time> last_connection_times_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_CONNECTIVITY_STATE_H_
