// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/mapping/internal/2d/node_spec.h"
#include "cartographer/mapping/internal/2d/overlapping_submaps_trimmer_2d.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d_metrics.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d_trimming_handle.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

// The graph whose optimisation callback runs on this thread.
thread_local const PoseGraph2D* calling_back_for = nullptr;

std::unique_ptr<PoseGraphTrimmer> MakeTrimmer(
    const proto::PoseGraphOptions::OverlappingSubmapsTrimmerOptions2D&
        options) {
  return absl::make_unique<OverlappingSubmapsTrimmer2D>(
      options.fresh_submaps_count(), options.min_covered_area(),
      options.min_added_submaps_count());
}

}  // namespace

PoseGraph2D::PoseGraph2D(
    const proto::PoseGraphOptions& options,
    std::unique_ptr<optimization::OptimizationProblem2D> optimization_problem,
    common::ThreadPool* const thread_pool)
    : options_(options),
      optimization_problem_(std::move(optimization_problem)),
      constraint_builder_(options_.constraint_builder_options(), thread_pool),
      work_queue_(
          thread_pool,
          [this](const WorkItem::Result barrier) {
            using Constraints = constraints::ConstraintBuilder2D::Result;
            constraint_builder_.WhenDone(
                [this, barrier](const Constraints& found) {
                  HandleConstraints(barrier, found);
                });
          },
          [](const size_t size) {
            GetPoseGraph2DMetrics().work_queue_size->Set(
                static_cast<double>(size));
          }) {
  if (options_.has_overlapping_submaps_trimmer_2d()) {
    AddTrimmer(MakeTrimmer(options_.overlapping_submaps_trimmer_2d()));
  }
}

PoseGraph2D::~PoseGraph2D() { WaitForAllComputations(); }

NodeId PoseGraph2D::AddNode(
    std::shared_ptr<const TrajectoryNode::Data> constant_data,
    const int trajectory_id,
    const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps) {
  CHECK(!insertion_submaps.empty());
  NodeId node_id(trajectory_id, 0);
  std::vector<SubmapId> submap_ids;
  {
    absl::MutexLock lock(&mutex_);
    AddTrajectoryIfNeeded(trajectory_id);
    const transform::Rigid3d provisional_pose =
        LocalToGlobal(trajectory_id) * constant_data->local_pose;
    node_id = data_.trajectory_nodes.Append(
        trajectory_id, TrajectoryNode{constant_data, provisional_pose});
    ++data_.num_trajectory_nodes;
    submap_ids = AppendInsertionSubmaps(trajectory_id, insertion_submaps);
  }
  // Read now, while local SLAM waits for this call.
  const bool newly_finished_submap =
      insertion_submaps.front()->insertion_finished();
  AddWorkItem([=]() {
    return ProcessNode(node_id, insertion_submaps, submap_ids,
                       newly_finished_submap);
  });
  return node_id;
}

void PoseGraph2D::AddWorkItem(
    const std::function<WorkItem::Result()>& work_item) {
  work_queue_.Add(work_item);
  GetPoseGraph2DMetrics().work_queue_delay->Set(work_queue_.DelaySeconds());
}

void PoseGraph2D::AddChange(const std::function<void()>& change,
                            const WorkItem::Result result) {
  AddWorkItem([this, change, result]() {
    absl::MutexLock lock(&mutex_);
    change();
    return result;
  });
}

void PoseGraph2D::AddTrajectoryIfNeeded(const int trajectory_id) {
  CHECK(data_.trajectory_states.AcceptsData(trajectory_id))
      << "trajectory " << trajectory_id << " is complete";
  data_.trajectory_states.Add(trajectory_id);
  data_.trajectory_connectivity_state.Add(trajectory_id);
}

std::vector<SubmapId> PoseGraph2D::AppendInsertionSubmaps(
    const int trajectory_id,
    const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps) {
  auto& submaps = data_.submap_data;
  // All submaps but the newest were added before, unless the trajectory is new.
  size_t num_known = 0;
  if (submaps.SizeOfTrajectoryOrZero(trajectory_id) > 0) {
    const auto last = *std::prev(submaps.EndOfTrajectory(trajectory_id));
    const auto it = std::find(insertion_submaps.begin(),
                              insertion_submaps.end(), last.data.submap);
    CHECK(it != insertion_submaps.end()) << "insertion submaps do not overlap";
    num_known = std::distance(insertion_submaps.begin(), it) + 1;
  }
  for (size_t i = num_known; i < insertion_submaps.size(); ++i) {
    InternalSubmapData submap;
    submap.submap = insertion_submaps[i];
    submaps.Append(trajectory_id, submap);
    GetPoseGraph2DMetrics().active_submaps->Increment();
  }
  const int last_index =
      (*std::prev(submaps.EndOfTrajectory(trajectory_id))).id.submap_index;
  const int first_index =
      last_index + 1 - static_cast<int>(insertion_submaps.size());
  std::vector<SubmapId> ids;
  for (int index = first_index; index <= last_index; ++index) {
    ids.emplace_back(trajectory_id, index);
    CHECK(submaps.at(ids.back()).submap ==
          insertion_submaps[index - first_index]);
  }
  return ids;
}

WorkItem::Result PoseGraph2D::ProcessNode(
    const NodeId& node_id,
    const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps,
    const std::vector<SubmapId>& submap_ids, const bool newly_finished_submap) {
  std::vector<SubmapId> older_submap_ids;
  std::set<NodeId> nodes_in_new_submap;
  {
    absl::MutexLock lock(&mutex_);
    PlaceNewSubmaps(data_.trajectory_nodes.at(node_id).time(),
                    insertion_submaps, submap_ids);
    PlaceNode(node_id, submap_ids.front(), *insertion_submaps.front());
    for (size_t i = 0; i < submap_ids.size(); ++i) {
      AddIntraSubmapConstraint(node_id, submap_ids[i], *insertion_submaps[i]);
    }
    for (const auto& submap : data_.submap_data) {
      if (submap.data.state == SubmapState::kFinished) {
        older_submap_ids.push_back(submap.id);
      }
    }
    if (newly_finished_submap) {
      InternalSubmapData& finished = data_.submap_data.at(submap_ids.front());
      finished.state = SubmapState::kFinished;
      nodes_in_new_submap = finished.node_ids;
    }
  }
  // Matches the new node against all old submaps, and a new submap against all
  // old nodes.
  for (const SubmapId& submap_id : older_submap_ids) {
    SearchConstraint(node_id, submap_id);
  }
  if (newly_finished_submap) {
    for (const auto& node : optimization_problem_->node_data()) {
      if (nodes_in_new_submap.count(node.id) == 0) {
        SearchConstraint(node.id, submap_ids.front());
      }
    }
  }
  constraint_builder_.NotifyEndOfNode();
  ++num_nodes_since_last_optimization_;
  return options_.optimize_every_n_nodes() > 0 &&
                 num_nodes_since_last_optimization_ >
                     options_.optimize_every_n_nodes()
             ? WorkItem::Result::kRunOptimization
             : WorkItem::Result::kDoNotRunOptimization;
}

void PoseGraph2D::PlaceNewSubmaps(
    const common::Time time,
    const std::vector<std::shared_ptr<const Submap2D>>& insertion_submaps,
    const std::vector<SubmapId>& submap_ids) {
  const auto& placed = optimization_problem_->submap_data();
  for (size_t i = 0; i < submap_ids.size(); ++i) {
    if (placed.Contains(submap_ids[i])) {
      continue;
    }
    const int trajectory_id = submap_ids[i].trajectory_id;
    if (i > 0) {
      // Keeps the relative pose of the two submaps in local SLAM.
      optimization_problem_->AddSubmap(
          trajectory_id,
          placed.at(submap_ids[i - 1]).global_pose *
              constraints::ComputeSubmapPose(*insertion_submaps[i - 1])
                  .inverse() *
              constraints::ComputeSubmapPose(*insertion_submaps[i]));
      continue;
    }
    const auto initial = data_.initial_trajectory_poses.find(trajectory_id);
    if (initial != data_.initial_trajectory_poses.end()) {
      data_.trajectory_connectivity_state.Connect(
          trajectory_id, initial->second.to_trajectory_id, time);
    }
    optimization_problem_->AddSubmap(
        trajectory_id,
        transform::Project2D(InitialLocalToGlobal(trajectory_id) *
                             insertion_submaps[i]->local_pose()));
  }
}

void PoseGraph2D::PlaceNode(const NodeId& node_id,
                            const SubmapId& matched_submap_id,
                            const Submap2D& matched_submap) {
  TrajectoryNode& node = data_.trajectory_nodes.at(node_id);
  const transform::Rigid2d global_from_local =
      optimization_problem_->submap_data().at(matched_submap_id).global_pose *
      constraints::ComputeSubmapPose(matched_submap).inverse();
  const transform::Rigid2d global_pose =
      global_from_local * LocalPose2D(*node.constant_data);
  optimization_problem_->AddTrajectoryNode(
      node_id.trajectory_id, MakeNodeSpec(*node.constant_data, global_pose));
  node.global_pose =
      transform::Embed3D(global_pose) *
      transform::Rigid3d::Rotation(node.constant_data->gravity_alignment);
  CopyTrajectoryDataOfNew(node_id.trajectory_id);
}

void PoseGraph2D::AddIntraSubmapConstraint(const NodeId& node_id,
                                           const SubmapId& submap_id,
                                           const Submap2D& submap) {
  InternalSubmapData& submap_data = data_.submap_data.at(submap_id);
  CHECK(submap_data.state == SubmapState::kNoConstraintSearch);
  submap_data.node_ids.insert(node_id);
  const transform::Rigid2d submap_from_node =
      constraints::ComputeSubmapPose(submap).inverse() *
      LocalPose2D(*data_.trajectory_nodes.at(node_id).constant_data);
  data_.constraints.push_back(
      Constraint{submap_id, node_id,
                 Constraint::Pose{transform::Embed3D(submap_from_node),
                                  options_.matcher_translation_weight(),
                                  options_.matcher_rotation_weight()},
                 Constraint::INTRA_SUBMAP});
}

void PoseGraph2D::SearchConstraint(const NodeId& node_id,
                                   const SubmapId& submap_id) {
  std::shared_ptr<const Submap> submap;
  std::shared_ptr<const TrajectoryNode::Data> node;
  bool is_local = false;
  {
    absl::MutexLock lock(&mutex_);
    submap = data_.submap_data.at(submap_id).submap;
    node = data_.trajectory_nodes.at(node_id).constant_data;
    is_local = CanTrustRelativePose(node_id, submap_id);
  }
  // A trajectory may end before its newest submaps are complete.
  if (!submap->insertion_finished()) {
    return;
  }
  const auto* const submap_2d = static_cast<const Submap2D*>(submap.get());
  if (is_local) {
    const transform::Rigid2d global_from_submap =
        optimization_problem_->submap_data().at(submap_id).global_pose;
    const transform::Rigid2d global_from_node =
        optimization_problem_->node_data().at(node_id).global_pose_2d;
    constraint_builder_.MaybeAddConstraint(
        submap_id, submap_2d, node_id, node.get(),
        global_from_submap.inverse() * global_from_node);
  } else if (IsSampledForGlobalSearch(node_id.trajectory_id)) {
    constraint_builder_.MaybeAddGlobalConstraint(submap_id, submap_2d, node_id,
                                                 node.get());
  }
}

bool PoseGraph2D::CanTrustRelativePose(const NodeId& node_id,
                                       const SubmapId& submap_id) const {
  if (node_id.trajectory_id == submap_id.trajectory_id) {
    return true;
  }
  const common::Time connected =
      data_.trajectory_connectivity_state.LastConnectionTime(
          node_id.trajectory_id, submap_id.trajectory_id);
  return GetLatestNodeTime(node_id, submap_id) <
         connected + common::FromSeconds(
                         options_.global_constraint_search_after_n_seconds());
}

bool PoseGraph2D::IsSampledForGlobalSearch(const int trajectory_id) {
  auto sampler = global_localization_samplers_.find(trajectory_id);
  if (sampler == global_localization_samplers_.end()) {
    sampler = global_localization_samplers_
                  .emplace(trajectory_id, options_.global_sampling_ratio())
                  .first;
  }
  return sampler->second.Pulse();
}

void PoseGraph2D::HandleConstraints(
    const WorkItem::Result reason,
    const constraints::ConstraintBuilder2D::Result& result) {
  {
    absl::MutexLock lock(&mutex_);
    for (const Constraint& constraint : result) {
      data_.constraints.push_back(constraint);
      UpdateTrajectoryConnectivity(constraint);
    }
  }
  if (reason == WorkItem::Result::kRunOptimization) {
    RunOptimization();
    CallBackAfterOptimization();
    absl::MutexLock lock(&mutex_);
    Trim();
    num_nodes_since_last_optimization_ = 0;
    CountConstraints();
  }
  work_queue_.Resume();
}

void PoseGraph2D::RunOptimization() {
  if (optimization_problem_->submap_data().empty()) {
    return;
  }
  // Constraints and landmarks change in items only, so that they may be read
  // here without the lock.
  optimization_problem_->Solve(data_.constraints, GetTrajectoryStates(),
                               data_.landmark_nodes);
  absl::MutexLock lock(&mutex_);
  PublishOptimizedPoses();
}

void PoseGraph2D::PublishOptimizedPoses() {
  const auto& nodes = optimization_problem_->node_data();
  data_.global_submap_poses_2d = optimization_problem_->submap_data();
  data_.trajectory_data = optimization_problem_->trajectory_data();
  for (const auto& landmark : optimization_problem_->landmark_data()) {
    data_.landmark_nodes[landmark.first].global_landmark_pose = landmark.second;
  }
  for (const auto& node : nodes) {
    data_.trajectory_nodes.at(node.id).global_pose =
        transform::Embed3D(node.data.global_pose_2d) *
        transform::Rigid3d::Rotation(node.data.gravity_alignment);
  }
  // Nodes still waiting in the queue follow the newest submap.
  for (const int trajectory_id : nodes.trajectory_ids()) {
    const transform::Rigid3d local_to_global = LocalToGlobal(trajectory_id);
    const NodeId last = (*std::prev(nodes.EndOfTrajectory(trajectory_id))).id;
    const auto end = data_.trajectory_nodes.EndOfTrajectory(trajectory_id);
    for (auto it = std::next(data_.trajectory_nodes.find(last)); it != end;
         ++it) {
      TrajectoryNode& node = data_.trajectory_nodes.at((*it).id);
      node.global_pose = local_to_global * node.constant_data->local_pose;
    }
  }
}

void PoseGraph2D::CallBackAfterOptimization() {
  GlobalSlamOptimizationCallback callback;
  {
    absl::MutexLock lock(&mutex_);
    callback = optimization_callback_;
  }
  if (!callback) {
    return;
  }
  const auto& submaps = optimization_problem_->submap_data();
  const auto& nodes = optimization_problem_->node_data();
  std::map<int, SubmapId> last_submap_ids;
  std::map<int, NodeId> last_node_ids;
  for (const int id : nodes.trajectory_ids()) {
    if (submaps.SizeOfTrajectoryOrZero(id) > 0) {
      last_submap_ids.emplace(id, (*std::prev(submaps.EndOfTrajectory(id))).id);
      last_node_ids.emplace(id, (*std::prev(nodes.EndOfTrajectory(id))).id);
    }
  }
  calling_back_for = this;
  callback(last_submap_ids, last_node_ids);
  calling_back_for = nullptr;
}

void PoseGraph2D::Trim() {
  TrimmingHandle handle(this);
  for (const int trajectory_id : data_.trajectory_states.ConfirmedDeletions()) {
    const std::vector<SubmapId> submap_ids = handle.GetSubmapIds(trajectory_id);
    std::for_each(submap_ids.begin(), submap_ids.end(),
                  [&handle](const SubmapId& id) { handle.TrimSubmap(id); });
    data_.trajectory_states.Set(trajectory_id, TrajectoryState::DELETED);
  }
  for (std::unique_ptr<PoseGraphTrimmer>& trimmer : trimmers_) {
    trimmer->Trim(&handle);
    if (trimmer->IsFinished()) {
      trimmer.reset();
    }
  }
  const auto end_of_unfinished =
      std::remove(trimmers_.begin(), trimmers_.end(), nullptr);
  trimmers_.erase(end_of_unfinished, trimmers_.end());
}

void PoseGraph2D::RunFinalOptimization() {
  const int usual_num_iterations = options_.optimization_problem_options()
                                       .ceres_solver_options()
                                       .max_num_iterations();
  AddWorkItem([this]() {
    optimization_problem_->SetMaxNumIterations(
        options_.max_num_final_iterations());
    return WorkItem::Result::kRunOptimization;
  });
  AddWorkItem([this, usual_num_iterations]() {
    optimization_problem_->SetMaxNumIterations(usual_num_iterations);
    return WorkItem::Result::kDoNotRunOptimization;
  });
  WaitForAllComputations();
}

void PoseGraph2D::WaitForAllComputations() {
  if (calling_back_for == this) {
    return;
  }
  int num_added_nodes;
  {
    absl::MutexLock lock(&mutex_);
    num_added_nodes = data_.num_trajectory_nodes;
  }
  AddWorkItem([]() { return WorkItem::Result::kCollectConstraints; });
  work_queue_.WaitUntilIdle();
  CHECK_GE(constraint_builder_.GetNumFinishedNodes(), num_added_nodes);
}

}  // namespace mapping
}  // namespace cartographer
