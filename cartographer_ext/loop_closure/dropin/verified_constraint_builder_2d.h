// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// ConstraintBuilder2D for options with our block: the same calls on the same
// threads, another way to constraints.
//
//   offered    Nodes are remembered, pairs wait for the end of their node.
//   planned    At the end of a node PairPlanner chooses which of its pairs
//              are searched and how widely; the others get their record.
//   searched   Each in a task of its own: correlative search, refinement,
//              information of the match. All submaps of another run, where the
//              place in it is not known (MapLocalization), in one task.
//   verified   In the task behind WhenDone, pair by pair in the order they were
//              offered: LoopVerifier. What it accepts, now or of earlier
//              rounds, is reported; what lacks evidence waits for the next
//              round. What still waits when the builder is destroyed goes to
//              the decision log.
//
// Only planning and verification have memory, and both see the same sequence
// for any number of threads.
//
// A node of the host stands for the gravity-aligned frame, which does not turn
// with the robot. Searching and constraints keep to that; what knows about
// motion (paths, signatures, verification, records) has the tracking frame.
//
// The pose graph deletes nodes together with the submaps they belong to, and
// tells about the submaps only. A constraint with a node that is gone would be
// fatal there, so with a submap all undecided loops of nodes are given up that
// may have been part of it: those up to the newest one known when the submap
// had been complete for a while.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_2D_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_2D_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/types/optional.h"
#include "cartographer/common/task.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/full_information.h"
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"
#include "cartographer_ext/loop_closure/dropin/place_search.h"
#include "cartographer_ext/loop_closure/loop_verifier.h"
#include "cartographer_ext/loop_closure_options.pb.h"

namespace cartographer_ext {
namespace loop_closure {

class VerifiedConstraintBuilder2D {
 public:
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;
  using Result = std::vector<Constraint>;
  using SubmapId = cartographer::mapping::SubmapId;
  using NodeId = cartographer::mapping::NodeId;
  using Submap2D = cartographer::mapping::Submap2D;
  using NodeData = cartographer::mapping::TrajectoryNode::Data;

  VerifiedConstraintBuilder2D(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const proto::LoopClosureOptions& extension,
      cartographer::common::ThreadPoolInterface* thread_pool);
  ~VerifiedConstraintBuilder2D();
  VerifiedConstraintBuilder2D(const VerifiedConstraintBuilder2D&) = delete;
  VerifiedConstraintBuilder2D& operator=(const VerifiedConstraintBuilder2D&) =
      delete;

  // As those of ConstraintBuilder2D.
  void MaybeAddConstraint(
      const SubmapId& submap_id, const Submap2D* submap, const NodeId& node_id,
      const NodeData* node,
      const cartographer::transform::Rigid2d& initial_relative_pose)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void MaybeAddGlobalConstraint(const SubmapId& submap_id,
                                const Submap2D* submap, const NodeId& node_id,
                                const NodeData* node)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void NotifyEndOfNode() ABSL_LOCKS_EXCLUDED(mutex_);
  void WhenDone(const std::function<void(const Result&)>& callback)
      ABSL_LOCKS_EXCLUDED(mutex_);
  int GetNumFinishedNodes() ABSL_LOCKS_EXCLUDED(mutex_);
  void DeleteScanMatcher(const SubmapId& submap_id) ABSL_LOCKS_EXCLUDED(mutex_);

  static void RegisterMetrics(
      cartographer::metrics::FamilyFactory* family_factory);

 private:
  SubmapEntry* Offer(const SubmapId& submap_id, const Submap2D* submap,
                     const NodeId& node_id, const NodeData& node)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void RememberNode(const NodeId& node_id, const NodeData& node)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // How a node fits a submap of its run that ended right before it.
  void MeasureFit(const OfferedPair& pair, const SubmapEntry& entry)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::optional<uncertainty::VertexId> Anchor(const SubmapId& submap_id,
                                               const SubmapEntry& entry,
                                               int trajectory_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Schedule(PairCandidate* candidate) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleQuery(const std::vector<PairCandidate*>& candidates)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // What a search in the submap of the candidate needs, before `task`.
  void AwaitSubmap(const PairCandidate& candidate,
                   cartographer::common::Task* task)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleMatcher(const std::shared_ptr<SubmapEntry>& entry)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleViews(const SubmapId& submap_id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  LoopCandidate MakeLoopCandidate(const PairCandidate& candidate) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // What is the same for all candidates of a submap.
  LoopCandidate StartCandidate(const SubmapId& submap_id,
                               const SubmapEntry& entry, bool with_maps) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void VerifyQuery(const PlaceQuery& query)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // A run has found its place again: what told its place before it was lost is
  // given no information, so that the optimisation goes without it.
  void TakeBackLoops(int trajectory_id, int map_id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // (anchor <- node)
  absl::optional<uncertainty::LoopEdge> MakeLoopEdge(
      const LoopOutcome& outcome) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Result Verify() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CallBack() ABSL_LOCKS_EXCLUDED(mutex_);

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const proto::LoopClosureOptions extension_;
  cartographer::common::ThreadPoolInterface* const thread_pool_;
  const PairSearcher searcher_;
  int64_t pending_id_ = 0;

  absl::Mutex mutex_;
  LoopVerifier verifier_ ABSL_GUARDED_BY(mutex_);
  PairPlanner planner_ ABSL_GUARDED_BY(mutex_);
  TypicalFit typical_fit_ ABSL_GUARDED_BY(mutex_);
  std::map<SubmapId, std::shared_ptr<SubmapEntry>> submaps_
      ABSL_GUARDED_BY(mutex_);
  std::map<int, int> newest_nodes_ ABSL_GUARDED_BY(mutex_);
  std::map<int, int64_t> newest_times_ ABSL_GUARDED_BY(mutex_);
  // Of the node that is not complete yet.
  std::vector<OfferedPair> pairs_ ABSL_GUARDED_BY(mutex_);
  // Of all complete nodes since the last callback; they stay where they are.
  // The first so many belong to the callback that is due.
  size_t num_candidates_due_ ABSL_GUARDED_BY(mutex_) = 0;
  size_t num_queries_due_ ABSL_GUARDED_BY(mutex_) = 0;
  std::deque<PairCandidate> candidates_ ABSL_GUARDED_BY(mutex_);
  std::deque<PlaceQuery> queries_ ABSL_GUARDED_BY(mutex_);
  // By run and map, with the task of the last query of each.
  std::map<std::pair<int, int>, std::unique_ptr<PlaceSearch>> places_
      ABSL_GUARDED_BY(mutex_);
  std::map<std::pair<int, int>, std::weak_ptr<cartographer::common::Task>>
      place_tasks_ ABSL_GUARDED_BY(mutex_);
  // Accepted loops of each run in each map, node index and constraint.
  std::map<std::pair<int, int>, std::deque<std::pair<int, ConstraintBits>>>
      foreign_loops_ ABSL_GUARDED_BY(mutex_);
  // Up to these nodes places are to be forgotten.
  std::map<std::pair<int, int>, int> forgotten_nodes_ ABSL_GUARDED_BY(mutex_);
  int64_t num_groups_ ABSL_GUARDED_BY(mutex_) = 0;
  std::function<void(const Result&)> callback_ ABSL_GUARDED_BY(mutex_);
  std::unique_ptr<cartographer::common::Task> end_of_node_task_
      ABSL_GUARDED_BY(mutex_);
  std::unique_ptr<cartographer::common::Task> callback_task_
      ABSL_GUARDED_BY(mutex_);
  int num_started_nodes_ ABSL_GUARDED_BY(mutex_) = 0;
  int num_finished_nodes_ ABSL_GUARDED_BY(mutex_) = 0;
  int num_matchers_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_2D_H_
