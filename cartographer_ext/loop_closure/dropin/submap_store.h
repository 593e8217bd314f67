// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What loop closure keeps of each submap: its correlative matcher, its
// occupancy view for verification, and what is known about its nodes. Matchers
// and views are built in tasks of their own, when they are needed for the first
// time.
//
// The pose graph deletes nodes together with the submaps they belong to, but
// announces the submaps only. `newest_node_bound` bounds the nodes of a submap:
// it is the newest node known when the submap had been complete for a while.
//
// Not thread-safe, except that the tasks may finish at any time.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_STORE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_STORE_H_

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/types/optional.h"
#include "cartographer/common/task.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

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
  // Null until its task has run; tasks that depend on that one may read it.
  std::unique_ptr<const SubmapMatcher> matcher;
  std::weak_ptr<cartographer::common::Task> matcher_task;
  bool has_matcher = false;  // or soon will have
  bool has_view = false;     // or soon will have
  // Null until its task has run.
  absl::Mutex view_mutex;
  std::shared_ptr<const OccupancyView> view ABSL_GUARDED_BY(view_mutex);
};

class SubmapStore {
 public:
  SubmapStore(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const LoopOptions& extension,
      cartographer::common::ThreadPoolInterface* thread_pool);

  // For every node and, after it, every pair proposed. Pairs of one group have
  // been proposed when one node was added.
  void AddNode(const uncertainty::NodeId& node, int64_t time);
  std::shared_ptr<SubmapEntry> AddPair(
      const uncertainty::SubmapId& submap_id,
      const cartographer::mapping::Submap2D* submap, int node_trajectory_id);
  void EndGroup() { ++num_groups_; }

  // Null where the submap is not known.
  std::shared_ptr<SubmapEntry> Find(const uncertainty::SubmapId& id) const;
  bool HasSubmapsOf(int trajectory_id) const;
  // -1 without a node of the trajectory.
  int NewestNodeIndex(int trajectory_id) const;
  // Returns the newest node that may belong to the submap.
  int Erase(const uncertainty::SubmapId& id);
  void DeleteTrajectory(int trajectory_id) {
    newest_nodes_.erase(trajectory_id);
  }

  // What is the same for all candidates of a submap and a trajectory: the
  // submap, its local pose, its nodes, its anchor.
  LoopCandidate MakeCandidate(const uncertainty::SubmapId& id,
                              const SubmapEntry& entry, int node_trajectory_id,
                              const uncertainty::PathUncertainty& paths) const;
  // The occupancy views of the submap and its neighbours, into the candidate.
  void AddMaps(LoopCandidate* candidate) const;

  // Schedules what a search in the submap and its verification need, where that
  // has not been done yet: the matcher before `search`, the views before
  // `end_of_node`.
  void AwaitSubmap(const uncertainty::SubmapId& id,
                   cartographer::common::Task* search,
                   cartographer::common::Task* end_of_node);

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
  void ScheduleMatcher(const std::shared_ptr<SubmapEntry>& entry);
  void ScheduleView(const std::shared_ptr<SubmapEntry>& entry,
                    cartographer::common::Task* end_of_node);

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const TemporalVerificationOptions temporal_options_;
  // Whether views are needed, and of how many neighbours on either side.
  const bool with_views_;
  const int num_neighbours_;
  cartographer::common::ThreadPoolInterface* const thread_pool_;
  std::map<uncertainty::SubmapId, std::shared_ptr<SubmapEntry>> submaps_;
  std::map<int, NewestNode> newest_nodes_;  // by trajectory
  int64_t num_groups_ = 0;
  int num_matchers_ = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_SUBMAP_STORE_H_
