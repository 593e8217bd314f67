// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Data that loop closure keeps of each submap: its nodes and, in a cache, its
// correlative matcher and its occupancy view for verification.
//
// The pose graph deletes nodes together with the submaps they belong to, but
// announces the submaps only. `newest_node_bound` bounds the nodes of a submap:
// it is the newest node at a time when the submap had been finished for a
// while.
//
// Not thread-safe, except `cache`.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_STORE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_STORE_H_

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/dropin/submap_cache.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Data of one submap.
struct SubmapEntry {
  static constexpr int kUnknownNode = std::numeric_limits<int>::max();

  const cartographer::mapping::Submap2D* submap = nullptr;
  Pose2 local_pose;  // (local <- submap)
  // The newest node of its trajectory when it was first proposed, -1 without
  // one, and its time.
  int newest_node_at_first = -1;
  int64_t time_at_first = 0;
  int64_t first_group = 0;
  // No node of the submap is newer.
  int newest_node_bound = kUnknownNode;
  bool is_searched = false;  // or has been
  bool is_compared = false;  // with scans: it, or a neighbour, was searched
  std::unique_ptr<CachedSubmap> cached;
};

// Data of all submaps, see above.
class SubmapStore {
 public:
  SubmapStore(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const LoopOptions& extension);

  // To be called for every node and, after it, every proposed pair. Pairs of
  // one group were proposed when one node was added.
  void AddNode(const uncertainty::NodeId& node, int64_t time);
  std::shared_ptr<SubmapEntry> AddPair(
      const uncertainty::SubmapId& submap_id,
      const cartographer::mapping::Submap2D* submap, int node_trajectory_id);
  void EndGroup() { ++num_groups_; }

  // Null if the submap is unknown.
  std::shared_ptr<SubmapEntry> Find(const uncertainty::SubmapId& id) const;
  bool HasSubmapsOf(int trajectory_id) const;
  // -1 without a node of the trajectory.
  int NewestNodeIndex(int trajectory_id) const;
  // Returns the newest node that may belong to the submap.
  int Erase(const uncertainty::SubmapId& id);
  void DeleteTrajectory(int trajectory_id) {
    newest_nodes_.erase(trajectory_id);
  }

  // Creates a candidate with the fields that are common to a submap and a
  // trajectory: the submap, its local pose, its nodes, its anchor.
  LoopCandidate MakeCandidate(const uncertainty::SubmapId& id,
                              const SubmapEntry& entry, int node_trajectory_id,
                              const uncertainty::PathUncertainty& paths) const;
  // To be called before the submap is searched, so that it and its neighbours
  // are available for verification.
  void AnnounceSearch(const uncertainty::SubmapId& id);
  // Adds the available occupancy views of the submap and its neighbours to the
  // candidate.
  void AddMaps(LoopCandidate* candidate);

  SubmapCache* cache() { return &cache_; }

 private:
  struct NewestNode {
    int node_index;
    int64_t time;
  };

  // Of those that may have been inserted in the submap.
  int OldestNode(const uncertainty::SubmapId& id) const;
  absl::optional<uncertainty::VertexId> Anchor(
      const uncertainty::SubmapId& id, const SubmapEntry& entry,
      int node_trajectory_id, const uncertainty::PathUncertainty& paths) const;

  // Whether views are needed, and of how many neighbours on either side.
  const bool with_views_;
  const int num_neighbours_;
  SubmapCache cache_;
  std::map<uncertainty::SubmapId, std::shared_ptr<SubmapEntry>> submaps_;
  std::map<int, NewestNode> newest_nodes_;  // by trajectory
  int64_t num_groups_ = 0;
  int64_t num_submaps_ = 0;  // ever
  int num_searched_ = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_STORE_H_
