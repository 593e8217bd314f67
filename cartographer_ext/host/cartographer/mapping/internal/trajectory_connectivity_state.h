// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Connections between trajectories together with the time of the last one. A
// connection that joins two components counts for every pair across them.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_CONNECTIVITY_STATE_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_CONNECTIVITY_STATE_H_

#include <map>
#include <utility>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/mapping/internal/connected_components.h"

namespace cartographer {
namespace mapping {

// Not thread-safe.
class TrajectoryConnectivityState {
 public:
  TrajectoryConnectivityState() {}
  TrajectoryConnectivityState(const TrajectoryConnectivityState&) = delete;
  TrajectoryConnectivityState& operator=(const TrajectoryConnectivityState&) =
      delete;

  void Add(int trajectory_id);
  void Connect(int trajectory_id_a, int trajectory_id_b, common::Time time);
  bool TransitivelyConnected(int trajectory_id_a, int trajectory_id_b) const;
  std::vector<std::vector<int>> Components() const;

  // The beginning of universal time for trajectories that never were connected.
  common::Time LastConnectionTime(int trajectory_id_a,
                                  int trajectory_id_b) const;

 private:
  ConnectedComponents components_;
  std::map<std::pair<int, int>, common::Time> last_connection_times_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_TRAJECTORY_CONNECTIVITY_STATE_H_
