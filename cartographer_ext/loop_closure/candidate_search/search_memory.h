// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the search planner remembers about a submap, or about a group of submaps
// that count as one: the nodes for which it was searched, those whose loops with
// it were accepted, and from where on it is too far away.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_MEMORY_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_MEMORY_H_

#include <cstddef>
#include <cstdint>
#include <map>

#include "absl/types/optional.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Nodes with their times (host ticks). The newest 20000 are kept.
class RememberedNodes {
 public:
  void Add(const uncertainty::NodeId& node, int64_t time);
  void Erase(const uncertainty::NodeId& node) { nodes_.erase(node); }
  // Those of a trajectory up to an index.
  void EraseUpTo(int trajectory_id, int last_node_index);
  // Whether one of them is within `distance` metres of path and `duration`
  // seconds of a node. Never with a distance of 0.
  bool HasNear(const uncertainty::PathUncertainty& paths,
               const uncertainty::NodeId& node, int64_t time, double distance,
               double duration) const;
  size_t size() const { return nodes_.size(); }

 private:
  std::map<uncertainty::VertexId, int64_t> nodes_;
};

// A node from which a submap was out of reach.
struct FarNode {
  uncertainty::NodeId node;
  // Metres between submap and node up to which it would have been in reach, and
  // by how much that grows with each metre driven.
  double limit = 0.;
  double growth = 0.;
  int drift_version = 0;  // of the paths
};

// See above.
struct SearchMemory {
  RememberedNodes searched;
  RememberedNodes searched_fully;
  RememberedNodes accepted;
  // Searches since the last accepted loop.
  size_t num_unanswered = 0;
  // Nodes before the submap that were not known to be out of its reach.
  size_t num_older_nodes = 0;
  absl::optional<FarNode> far;

  RememberedNodes* Searched(const bool full_submap) {
    return full_submap ? &searched_fully : &searched;
  }
};

// Whether a submap is still out of reach of a node `distance` metres away.
bool IsStillFar(const absl::optional<FarNode>& far,
                const uncertainty::PathUncertainty& paths,
                const uncertainty::NodeId& node, double distance);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_MEMORY_H_
