// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// ConstraintBuilder2D for options with our block: the same calls on the same
// threads, another way to constraints.
//
//   offered    Nodes are remembered, pairs wait for the end of their node.
//   planned    At the end of a node SearchPlanner chooses which of its pairs
//              are searched and how widely; the others get their record.
//   searched   Each in a task of its own: correlative search, refinement,
//              information of the match.
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

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/types/optional.h"
#include "cartographer/common/fixed_ratio_sampler.h"
#include "cartographer/common/task.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/loop_verifier.h"
#include "cartographer_ext/loop_closure/search_planner.h"
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
  static constexpr int kUnknownNode = std::numeric_limits<int>::max();

  // What is kept of each submap between nodes.
  struct SubmapEntry {
    explicit SubmapEntry(const double sampling_ratio)
        : sampler(sampling_ratio) {}
    cartographer::common::FixedRatioSampler sampler;
    const Submap2D* submap = nullptr;
    Pose2 local_pose;  // (local <- submap)
    // The newest node of its trajectory when it was first offered, -1 without
    // one, and its time.
    int newest_node_at_first = -1;
    int64_t time_at_first = 0;
    int64_t first_group = 0;
    // No node of the submap is newer.
    int newest_node_bound = kUnknownNode;
    std::unique_ptr<const SubmapMatcher> matcher;  // null until the task ran
    std::weak_ptr<cartographer::common::Task> matcher_task;
    bool has_matcher = false;
    std::unique_ptr<const OccupancyView> view;
    bool has_view = false;
  };

  // A pair that was offered.
  struct Pair {
    SubmapId submap_id;
    NodeId node_id;
    const NodeData* node;
    bool is_global;
    Pose2 predicted;   // (submap <- node), gravity-aligned
    Pose2 from_robot;  // (gravity-aligned <- tracking frame), a rotation
    absl::optional<NodeKey> anchor;
  };

  // A pair with its plan, and what its task finds.
  struct Candidate {
    Candidate(const Pair& pair_in, const SearchPlan& plan_in,
              SubmapEntry* const entry_in)
        : pair(pair_in), plan(plan_in), entry(entry_in) {}
    Pair pair;
    SearchPlan plan;
    SubmapEntry* entry;
    bool found = false;
    double score = 0.;
    Pose2 matched;  // (submap <- node), gravity-aligned
    Pose2 refined;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  };

  SubmapEntry* Offer(const SubmapId& submap_id, const Submap2D* submap,
                     const NodeId& node_id, const NodeData& node)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void RememberNode(const NodeId& node_id, const NodeData& node)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::optional<NodeKey> Anchor(const SubmapId& submap_id,
                                 const SubmapEntry& entry,
                                 int trajectory_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::vector<SearchPlan> PlanPairs() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  SearchPlan PlanLikeStock(const Pair& pair)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Schedule(Candidate* candidate) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleMatcher(SubmapEntry* entry)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleViews(const SubmapId& submap_id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Run in the candidate's task; touches nothing but the candidate.
  void Search(Candidate* candidate) const;
  LoopCandidate MakeLoopCandidate(const Candidate& candidate) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Result Verify() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CallBack() ABSL_LOCKS_EXCLUDED(mutex_);

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const proto::LoopClosureOptions extension_;
  cartographer::common::ThreadPoolInterface* const thread_pool_;
  const cartographer::mapping::scan_matching::CeresScanMatcher2D
      ceres_scan_matcher_;
  int64_t pending_id_ = 0;

  absl::Mutex mutex_;
  LoopVerifier verifier_ ABSL_GUARDED_BY(mutex_);
  SearchPlanner planner_ ABSL_GUARDED_BY(mutex_);
  std::map<SubmapId, SubmapEntry> submaps_ ABSL_GUARDED_BY(mutex_);
  std::map<int, int> newest_nodes_ ABSL_GUARDED_BY(mutex_);
  std::map<int, int64_t> newest_times_ ABSL_GUARDED_BY(mutex_);
  // Of the node that is not complete yet.
  std::vector<Pair> pairs_ ABSL_GUARDED_BY(mutex_);
  // Of all complete nodes since the last callback; they stay where they are.
  std::deque<Candidate> candidates_ ABSL_GUARDED_BY(mutex_);
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
