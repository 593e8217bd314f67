// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The order in which the nodes of a stored map were inserted, and their
// submaps. A map does not store this explicitly, but the intra-submap
// constraints give the submaps of every node, and the stamps the order.
//
// The pose graph requires, for every node, one submap (while there is only one)
// or two, the older first, and a new one only together with a known one. Stored
// maps often lack the newest submaps, because unfinished ones were not stored.
// Such a submap is represented by a placeholder that is never finished, so that
// nothing is searched in it.
#ifndef CARTOGRAPHER_EXT_RERUN_REPLAY_PLAN_H_
#define CARTOGRAPHER_EXT_RERUN_REPLAY_PLAN_H_

#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// A submap by its number in the pose graph.
struct ReplaySubmap {
  int trajectory_id = 0;
  // Index in the stored map; -1 for a placeholder.
  int stored_index = -1;
  // Position in ReplayPlan::steps of the first and of the last node.
  size_t first_step = 0;
  size_t last_step = 0;
  // The stored submap is finished; the pose graph is notified with the last
  // node.
  bool finished = false;

  bool is_placeholder() const { return stored_index < 0; }
};

struct ReplayStep {
  GraphId node_id;  // of the stored map
  // Positions in ReplayPlan::submaps, the older first; one or two.
  std::vector<int> submaps;
};

struct ReplayPlan {
  std::vector<ReplayStep> steps;
  // Submaps of each trajectory in the order of their indices in the pose graph.
  std::vector<ReplaySubmap> submaps;
  int64_t num_placeholders = 0;
  // Number of nodes that count as inserted into one submap more or fewer than
  // they were, to bridge trimmed submaps.
  int64_t num_guessed = 0;
};

// Trajectories whose spans of time overlap are interleaved by the stamps of
// their nodes, others are ordered by their numbers. An error if a node was
// inserted into more than two submaps, into one of another trajectory, or into
// an older one than the previous node.
absl::StatusOr<ReplayPlan> MakeReplayPlan(const MapGraph& graph);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_REPLAY_PLAN_H_
