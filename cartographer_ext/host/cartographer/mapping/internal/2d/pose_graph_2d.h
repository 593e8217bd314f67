// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Global SLAM: loop closure search and optimisation, in the background.
//
// Everything that changes the graph is an item of one work queue. Items run one
// after the other; an optimisation is a barrier between two of them. Whatever
// an item reads was therefore written by the items before it, so that the
// resulting map depends on the order of the calls alone, and not on when, or by
// how many threads, the work is done. Until its item has run, a new node has a
// provisional pose.
//
// Locks: items change what getters read under mutex_. The optimisation problem
// (save for its sensor data) and the constraint builder are used by items only;
// items read their own data without the lock where it is not theirs to change
// at the same time.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_H_

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/fixed_ratio_sampler.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/internal/pose_graph_data.h"
#include "cartographer/mapping/internal/trajectory_connectivity_state.h"
#include "cartographer/mapping/internal/work_queue.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/pose_graph_trimmer.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

class PoseGraph2D : public PoseGraph {
 public:
  PoseGraph2D(
      const proto::PoseGraphOptions& options,
      std::unique_ptr<optimization::OptimizationProblem2D> optimization_problem,
      common::ThreadPool* thread_pool);
  // Finishes all work.
  ~PoseGraph2D() override;
  PoseGraph2D(const PoseGraph2D&) = delete;
  PoseGraph2D& operator=(const PoseGraph2D&) = delete;

  // Adds a node that local SLAM has just inserted into the (one or two)
  // `insertion_submaps`, older first. A first one that is finished has been
  // finished by this node.
  NodeId AddNode(
      std::shared_ptr<const TrajectoryNode::Data> constant_data,
      int trajectory_id,
      const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps)
      ABSL_LOCKS_EXCLUDED(mutex_);

  void AddImuData(int trajectory_id, const sensor::ImuData& imu_data) override;
  void AddOdometryData(int trajectory_id,
                       const sensor::OdometryData& odometry_data) override;
  void AddFixedFramePoseData(
      int trajectory_id,
      const sensor::FixedFramePoseData& fixed_frame_pose_data) override;
  void AddLandmarkData(int trajectory_id,
                       const sensor::LandmarkData& landmark_data) override;

  void DeleteTrajectory(int trajectory_id) override;
  void FinishTrajectory(int trajectory_id) override;
  bool IsTrajectoryFinished(int trajectory_id) const override;
  void FreezeTrajectory(int trajectory_id) override;
  bool IsTrajectoryFrozen(int trajectory_id) const override;
  void AddSubmapFromProto(const transform::Rigid3d& global_submap_pose,
                          const proto::Submap& submap) override;
  void AddNodeFromProto(const transform::Rigid3d& global_pose,
                        const proto::Node& node) override;
  void SetTrajectoryDataFromProto(const proto::TrajectoryData& data) override;
  void AddNodeToSubmap(const NodeId& node_id,
                       const SubmapId& submap_id) override;
  void AddSerializedConstraints(
      const std::vector<Constraint>& constraints) override;
  void AddTrimmer(std::unique_ptr<PoseGraphTrimmer> trimmer) override;
  void SetInitialTrajectoryPose(int from_trajectory_id, int to_trajectory_id,
                                const transform::Rigid3d& pose,
                                const common::Time time) override;
  void SetLandmarkPose(const std::string& landmark_id,
                       const transform::Rigid3d& global_pose,
                       const bool frozen = false) override;
  void SetGlobalSlamOptimizationCallback(
      PoseGraphInterface::GlobalSlamOptimizationCallback callback) override;

  void RunFinalOptimization() override;
  // Blocks until everything added so far is in the graph, without a further
  // optimisation. Returns at once when called by the optimisation callback.
  void WaitForAllComputations() ABSL_LOCKS_EXCLUDED(mutex_);

  std::vector<std::vector<int>> GetConnectedTrajectories() const override;
  PoseGraphInterface::SubmapData GetSubmapData(
      const SubmapId& submap_id) const override;
  MapById<SubmapId, PoseGraphInterface::SubmapData> GetAllSubmapData()
      const override;
  MapById<SubmapId, SubmapPose> GetAllSubmapPoses() const override;
  transform::Rigid3d GetLocalToGlobalTransform(
      int trajectory_id) const override;
  MapById<NodeId, TrajectoryNode> GetTrajectoryNodes() const override;
  MapById<NodeId, TrajectoryNodePose> GetTrajectoryNodePoses() const override;
  std::map<int, TrajectoryState> GetTrajectoryStates() const override;
  std::map<std::string, transform::Rigid3d> GetLandmarkPoses() const override;
  sensor::MapByTime<sensor::ImuData> GetImuData() const override;
  sensor::MapByTime<sensor::OdometryData> GetOdometryData() const override;
  sensor::MapByTime<sensor::FixedFramePoseData> GetFixedFramePoseData()
      const override;
  std::map<std::string /* landmark ID */, PoseGraph::LandmarkNode>
  GetLandmarkNodes() const override;
  std::map<int, TrajectoryData> GetTrajectoryData() const override;
  std::vector<Constraint> constraints() const override;
  // The first or last pose where `time` is outside of the trajectory, which
  // must have nodes.
  transform::Rigid3d GetInterpolatedGlobalTrajectoryPose(
      int trajectory_id, const common::Time time) const;

  static void RegisterMetrics(metrics::FamilyFactory* family_factory);

 private:
  class TrimmingHandle;

  void AddWorkItem(const std::function<WorkItem::Result()>& work_item);
  // An item that changes the graph under the lock.
  void AddChange(
      const std::function<void()>& change,
      WorkItem::Result result = WorkItem::Result::kDoNotRunOptimization)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // The same for what belongs to a trajectory; dropped where that is complete.
  void AddChangeOf(int trajectory_id, const std::function<void()>& change)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Calls while nodes and submaps are added.
  void AddTrajectoryIfNeeded(int trajectory_id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // The ids of the insertion submaps.
  std::vector<SubmapId> AppendInsertionSubmaps(
      int trajectory_id,
      const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  // The item of a new node, in its steps.
  WorkItem::Result ProcessNode(
      const NodeId& node_id,
      const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps,
      const std::vector<SubmapId>& submap_ids, bool newly_finished_submap)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void PlaceNewSubmaps(
      common::Time time,
      const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps,
      const std::vector<SubmapId>& submap_ids)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void PlaceNode(const NodeId& node_id, const SubmapId& matched_submap_id,
                 const Submap2D& matched_submap)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void AddIntraSubmapConstraint(const NodeId& node_id,
                                const SubmapId& submap_id,
                                const Submap2D& submap)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Offers a pair to the constraint builder: for a search around the present
  // relative pose where that can be trusted, else, for a sample of the pairs,
  // for a search of the whole submap.
  void SearchConstraint(const NodeId& node_id, const SubmapId& submap_id)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Relative poses are good within a trajectory, and for a while after two
  // trajectories were last connected.
  bool CanTrustRelativePose(const NodeId& node_id,
                            const SubmapId& submap_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool IsSampledForGlobalSearch(int trajectory_id);

  // Parts of the items that take in a stored state.
  void AddSerializedConstraint(Constraint constraint)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CountNewSubmap(int trajectory_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CopyTrajectoryDataOfNew(int trajectory_id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  // Barriers of the work queue.
  void HandleConstraints(WorkItem::Result reason,
                         const constraints::ConstraintBuilder2D::Result& result)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // The lock is not held while solving, see there.
  void RunOptimization()
      ABSL_LOCKS_EXCLUDED(mutex_) ABSL_NO_THREAD_SAFETY_ANALYSIS;
  void PublishOptimizedPoses() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CallBackAfterOptimization() ABSL_LOCKS_EXCLUDED(mutex_);
  // Deletes what is due and runs the trimmers.
  void Trim() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CountConstraints() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  common::Time GetLatestNodeTime(const NodeId& node_id,
                                 const SubmapId& submap_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void UpdateTrajectoryConnectivity(const Constraint& constraint)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool IsInState(int trajectory_id, TrajectoryState state) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  Eigen::Quaterniond GravityAlignment(const NodeId& node_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::vector<SubmapId> SubmapIds(int trajectory_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // By the last optimisation, or what a trajectory begins with.
  transform::Rigid3d LocalToGlobal(int trajectory_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // (global <- local) of a trajectory without submaps, by the items so far.
  transform::Rigid3d InitialLocalToGlobal(int trajectory_id) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  PoseGraphInterface::SubmapData SubmapDataUnderLock(
      const SubmapId& submap_id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const proto::PoseGraphOptions options_;
  const std::unique_ptr<optimization::OptimizationProblem2D>
      optimization_problem_;
  constraints::ConstraintBuilder2D constraint_builder_;
  ValueConversionTables conversion_tables_;

  mutable absl::Mutex mutex_;
  PoseGraphData data_ ABSL_GUARDED_BY(mutex_);
  GlobalSlamOptimizationCallback optimization_callback_ ABSL_GUARDED_BY(mutex_);

  // Items only.
  std::vector<std::unique_ptr<PoseGraphTrimmer>> trimmers_;
  std::map<int, common::FixedRatioSampler> global_localization_samplers_;
  int num_nodes_since_last_optimization_ = 0;

  WorkQueue work_queue_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_H_
