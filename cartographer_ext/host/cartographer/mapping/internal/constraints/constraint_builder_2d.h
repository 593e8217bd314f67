// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loop closure search: pairs of a finished submap and a node that was not used
// to build it are matched in the background, and what matches well becomes a
// constraint.
//
// Every pair gets a slot in the order of the calls, and results are reported in
// that order. Tasks depend on each other like this:
//
//   matcher of submap A ──► pair (A, n) ──┐
//   matcher of submap B ──► pair (B, n) ──┴► end of node n ──► callback
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_CONSTRAINTS_CONSTRAINT_BUILDER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_CONSTRAINTS_CONSTRAINT_BUILDER_2D_H_

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/types/optional.h"
#include "cartographer/common/fixed_ratio_sampler.h"
#include "cartographer/common/histogram.h"
#include "cartographer/common/math.h"
#include "cartographer/common/task.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {
namespace constraints {

// (local <- submap)
transform::Rigid2d ComputeSubmapPose(const Submap2D& submap);

// Thread-safe. No method waits for work, and none runs it on the caller.
class ConstraintBuilder2D {
 public:
  using Constraint = PoseGraphInterface::Constraint;
  using Result = std::vector<Constraint>;

  ConstraintBuilder2D(const proto::ConstraintBuilderOptions& options,
                      common::ThreadPoolInterface* thread_pool);
  // WhenDone must have been called, and have called back, since the last pair.
  ~ConstraintBuilder2D();
  ConstraintBuilder2D(const ConstraintBuilder2D&) = delete;
  ConstraintBuilder2D& operator=(const ConstraintBuilder2D&) = delete;

  // Searches around (submap <- node) = `initial_relative_pose`, unless that is
  // farther than max_constraint_distance or sampling skips this pair. Submap
  // and node data must live until WhenDone has called back.
  void MaybeAddConstraint(const SubmapId& submap_id, const Submap2D* submap,
                          const NodeId& node_id,
                          const TrajectoryNode::Data* const constant_data,
                          const transform::Rigid2d& initial_relative_pose)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Searches the whole submap, whatever the distance.
  void MaybeAddGlobalConstraint(const SubmapId& submap_id,
                                const Submap2D* submap, const NodeId& node_id,
                                const TrajectoryNode::Data* const constant_data)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // The pairs added since the last call belong to one node, which is complete.
  void NotifyEndOfNode() ABSL_LOCKS_EXCLUDED(mutex_);

  // Calls back once, on the pool, when all nodes completed so far are done,
  // with the constraints found since the last callback. The callback may use
  // the builder. One callback at a time.
  void WhenDone(const std::function<void(const Result&)>& callback)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Over the whole life of the builder.
  int GetNumFinishedNodes() ABSL_LOCKS_EXCLUDED(mutex_);

  // Drops the data of a submap. None of its pairs may be in progress.
  void DeleteScanMatcher(const SubmapId& submap_id) ABSL_LOCKS_EXCLUDED(mutex_);

  static void RegisterMetrics(metrics::FamilyFactory* family_factory);

 private:
  // What is kept of each submap between nodes.
  struct SubmapEntry {
    explicit SubmapEntry(const double sampling_ratio)
        : sampler(sampling_ratio) {}
    common::FixedRatioSampler sampler;
    // Null until the task behind `matcher_task` has run.
    std::unique_ptr<scan_matching::FastCorrelativeScanMatcher2D> matcher;
    std::weak_ptr<common::Task> matcher_task;
    bool has_matcher = false;  // or soon will have
  };

  struct Pair {
    SubmapId submap_id;
    const Submap2D* submap;
    NodeId node_id;
    const TrajectoryNode::Data* node;
    // (submap <- node); none for a search of the whole submap.
    absl::optional<transform::Rigid2d> initial_relative_pose;
  };

  SubmapEntry* FindOrCreateEntry(const SubmapId& submap_id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Schedule(const Pair& pair, SubmapEntry* entry)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleMatcher(const Submap2D* submap, SubmapEntry* entry)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::optional<Constraint> Search(
      const Pair& pair,
      const scan_matching::FastCorrelativeScanMatcher2D& matcher)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void LogMatch(const Pair& pair, float score,
                const transform::Rigid2d& pose_estimate) const;
  void CallBack() ABSL_LOCKS_EXCLUDED(mutex_);

  const proto::ConstraintBuilderOptions options_;
  common::ThreadPoolInterface* const thread_pool_;
  const scan_matching::CeresScanMatcher2D ceres_scan_matcher_;

  absl::Mutex mutex_;
  std::map<SubmapId, SubmapEntry> submaps_ ABSL_GUARDED_BY(mutex_);
  // The tasks write into their own slots, which stay where they are.
  std::deque<absl::optional<Constraint>> slots_ ABSL_GUARDED_BY(mutex_);
  std::function<void(const Result&)> callback_ ABSL_GUARDED_BY(mutex_);
  // Collect dependencies until they are scheduled.
  std::unique_ptr<common::Task> end_of_node_task_ ABSL_GUARDED_BY(mutex_);
  std::unique_ptr<common::Task> callback_task_ ABSL_GUARDED_BY(mutex_);
  int num_started_nodes_ ABSL_GUARDED_BY(mutex_) = 0;
  int num_finished_nodes_ ABSL_GUARDED_BY(mutex_) = 0;
  int num_matchers_ ABSL_GUARDED_BY(mutex_) = 0;
  common::Histogram scores_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_CONSTRAINTS_CONSTRAINT_BUILDER_2D_H_
