// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// ConstraintBuilder2D for options with our block: the same calls on the same
// threads, thread-safe. It adapts LoopClosure2D, which does the work, to the
// host's tasks and callbacks:
//
//   MaybeAdd(Global)Constraint   queue pairs of one node
//   NotifyEndOfNode              plans the queued pairs and schedules searches
//   searches (pool)              each on its own, without any lock
//   WhenDone -> callback (pool)  verifies in the order of the pairs, calls back
//
// Two mutexes. `mutex_` guards queue, counters and tasks; it is held only
// briefly, never during planning, searches or verification. `work_mutex_` is
// held while LoopClosure2D plans or verifies, in the same sequence for any
// number of threads. Calls that wait for it are documented.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_2D_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_2D_H_

#include <cstdint>
#include <functional>
#include <memory>
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
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/loop_closure/dropin/loop_closure_2d.h"
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {

// Constraint builder with verification, see above. Thread-safe.
class VerifiedConstraintBuilder2D {
 public:
  using ConstraintBuilderOptions =
      cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;
  using Result = std::vector<Constraint>;
  using SubmapId = cartographer::mapping::SubmapId;
  using NodeId = cartographer::mapping::NodeId;
  using Submap2D = cartographer::mapping::Submap2D;
  using NodeData = cartographer::mapping::TrajectoryNode::Data;
  using Rigid2d = cartographer::transform::Rigid2d;

  // `extension` is our block of `options`. The pool must outlive this object.
  VerifiedConstraintBuilder2D(
      const ConstraintBuilderOptions& options, const LoopOptions& extension,
      cartographer::common::ThreadPoolInterface* thread_pool);
  // WhenDone must have been called, and have called back, since the last node.
  // Undecided candidates are rejected and recorded.
  ~VerifiedConstraintBuilder2D();
  VerifiedConstraintBuilder2D(const VerifiedConstraintBuilder2D&) = delete;
  VerifiedConstraintBuilder2D& operator=(const VerifiedConstraintBuilder2D&) =
      delete;

  // Proposes a pair around (submap <- node) = `initial_relative_pose`, which
  // may or may not be searched. The submap must be finished. Submap and node
  // data must live until WhenDone has called back. Never waits.
  void MaybeAddConstraint(const SubmapId& submap_id, const Submap2D* submap,
                          const NodeId& node_id, const NodeData* node,
                          const Rigid2d& initial_relative_pose)
      ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_) {
    Propose({submap_id, submap, node_id, node, initial_relative_pose});
  }

  // The same without a prediction, in the whole submap.
  void MaybeAddGlobalConstraint(const SubmapId& submap_id,
                                const Submap2D* submap, const NodeId& node_id,
                                const NodeData* node)
      ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_) {
    Propose({submap_id, submap, node_id, node, absl::nullopt});
  }

  // The pairs since the last call were proposed when one node was added. Plans
  // them together and schedules their searches. Waits for a running
  // verification.
  void NotifyEndOfNode() ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_);

  // Calls back once, on the pool and without a lock, when the searches of all
  // nodes so far are done and verified. The result contains the constraints
  // accepted since the last callback, in the order of the pairs, including
  // buffered pairs of earlier rounds. The callback may use the builder. Only
  // one callback may be pending.
  void WhenDone(const std::function<void(const Result&)>& callback)
      ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_);

  // Number of nodes whose searches are done, over the lifetime of the builder.
  // Never waits.
  int GetNumFinishedNodes() ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_);

  // Removes a submap, and rejects its undecided pairs and those of nodes that
  // the pose graph may delete with it. None of its pairs may be pending. Waits
  // for a running verification.
  void DeleteScanMatcher(const SubmapId& submap_id)
      ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_);

 private:
  void Propose(const LoopClosure2D::Proposal& proposal)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void CallBack() ABSL_LOCKS_EXCLUDED(mutex_, work_mutex_);

  cartographer::common::ThreadPoolInterface* const thread_pool_;
  absl::Mutex work_mutex_ ABSL_ACQUIRED_BEFORE(mutex_);
  LoopClosure2D loop_closure_ ABSL_GUARDED_BY(work_mutex_);
  DecisionRecorder* const recorder_;  // lives as long as loop_closure_
  int64_t pending_id_ = 0;            // at recorder_

  absl::Mutex mutex_;
  // Pairs of the current node.
  std::vector<LoopClosure2D::Proposal> proposals_ ABSL_GUARDED_BY(mutex_);
  std::function<void(const Result&)> callback_ ABSL_GUARDED_BY(mutex_);
  // Collects dependencies until it is scheduled.
  std::unique_ptr<cartographer::common::Task> callback_task_
      ABSL_GUARDED_BY(mutex_);
  int num_started_nodes_ ABSL_GUARDED_BY(mutex_) = 0;
  int num_finished_nodes_ ABSL_GUARDED_BY(mutex_) = 0;
  // Started when WhenDone was called last.
  int num_nodes_at_last_call_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_2D_H_
