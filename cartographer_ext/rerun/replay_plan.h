// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// In which order, and into which submaps, the nodes of a stored map were
// inserted. A map does not say so itself, but its constraints do: those that
// are no loops name the submaps of every node, and the stamps the order.
//
// The pose graph wants, with every node, one submap (while there is only one)
// or two, the older first, and a new one only next to one it knows. Stored maps
// often lack the newest submaps, because unfinished ones were not stored. A
// placeholder takes the place of such a submap: it is never finished, so that
// nothing is ever searched in it.
#ifndef CARTOGRAPHER_EXT_RERUN_REPLAY_PLAN_H_
#define CARTOGRAPHER_EXT_RERUN_REPLAY_PLAN_H_

#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// A submap as the pose graph will number it.
struct ReplaySubmap {
  int trajectory_id = 0;
  // Of the stored map; -1 for a placeholder.
  int stored_index = -1;
  // Position in ReplayPlan::steps of the first and of the last node.
  size_t first_step = 0;
  size_t last_step = 0;
  // The stored submap is finished, and the pose graph is informed with the
  // last node.
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
  // Of each trajectory in the order of their indices in the pose graph.
  std::vector<ReplaySubmap> submaps;
  int64_t num_placeholders = 0;
  // Nodes that count as inserted in one submap more, or one less, than they
  // were, to bridge what was trimmed.
  int64_t num_guessed = 0;
};

// Trajectories whose spans of time overlap are interleaved by the stamps of
// their nodes, others follow each other in the order of their numbers. An error
// where a node was inserted in more than two submaps, in one of another
// trajectory, or in an older one than the node before it.
absl::StatusOr<ReplayPlan> MakeReplayPlan(const MapGraph& graph);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_REPLAY_PLAN_H_
