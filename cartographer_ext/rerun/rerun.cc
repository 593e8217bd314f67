// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/rerun.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/sensor/fixed_frame_pose_data.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/landmark_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/rerun/recorded_track.h"
#include "cartographer_ext/rerun/replay_ids.h"
#include "cartographer_ext/rerun/replay_plan.h"
#include "cartographer_ext/slam/metrics_collector.h"
#include "cartographer_ext/slam/resource_usage.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::PoseGraph2D;
using cartographer::mapping::Submap2D;
using cartographer::mapping::TrajectoryNode;
namespace mapping_proto = cartographer::mapping::proto;

// Longest wait for a queue that does not move.
constexpr std::chrono::seconds kPatience(2);
// Decision records kept, about 400 bytes each.
constexpr size_t kMaxDecisions = 500000;
// Side of the unused grid of a placeholder.
constexpr int kPlaceholderCells = 10;

// Hands sensor readings to the pose graph up to given times.
class SensorFeeder {
 public:
  SensorFeeder(const io::Pbstream& pbstream, PoseGraph2D* const pose_graph)
      : pbstream_(pbstream), pose_graph_(pose_graph) {}

  void FeedUntil(const int trajectory_id, const int64_t timestamp) {
    const auto due = [timestamp](const auto& data) {
      return data.timestamp() <= timestamp;
    };
    Feed(trajectory_id, pbstream_.odometry_data, &odometry_,
         [&](const auto& record) {
           if (!due(record.odometry_data())) return false;
           pose_graph_->AddOdometryData(
               trajectory_id,
               cartographer::sensor::FromProto(record.odometry_data()));
           return true;
         });
    Feed(trajectory_id, pbstream_.imu_data, &imu_, [&](const auto& record) {
      if (!due(record.imu_data())) return false;
      pose_graph_->AddImuData(
          trajectory_id, cartographer::sensor::FromProto(record.imu_data()));
      return true;
    });
    Feed(trajectory_id, pbstream_.fixed_frame_pose_data, &fixed_frame_,
         [&](const auto& record) {
           if (!due(record.fixed_frame_pose_data())) return false;
           pose_graph_->AddFixedFramePoseData(
               trajectory_id,
               cartographer::sensor::FromProto(record.fixed_frame_pose_data()));
           return true;
         });
    Feed(trajectory_id, pbstream_.landmark_data, &landmarks_,
         [&](const auto& record) {
           if (!due(record.landmark_data())) return false;
           pose_graph_->AddLandmarkData(
               trajectory_id,
               cartographer::sensor::FromProto(record.landmark_data()));
           return true;
         });
  }

 private:
  // Where each trajectory is in the records of one kind.
  using Positions = std::map<int, size_t>;

  template <typename Record, typename Add>
  static void Feed(const int trajectory_id, const std::vector<Record>& records,
                   Positions* const positions, const Add& add) {
    size_t& position = (*positions)[trajectory_id];
    for (; position < records.size(); ++position) {
      if (records[position].trajectory_id() != trajectory_id) continue;
      if (!add(records[position])) return;
    }
  }

  const io::Pbstream& pbstream_;
  PoseGraph2D* const pose_graph_;
  Positions odometry_, imu_, fixed_frame_, landmarks_;
};

// Creates submaps when they are due.
class SubmapMaker {
 public:
  SubmapMaker(const io::Pbstream& pbstream, const ReplayPlan& plan)
      : plan_(plan), submaps_(plan.submaps.size()) {
    for (const auto& record : pbstream.submaps) {
      records_[{record.submap_id().trajectory_id(),
                record.submap_id().submap_index()}] = &record.submap_2d();
    }
  }

  std::shared_ptr<Submap2D> Get(const int position,
                                const mapping_proto::TrajectoryNodeData& node) {
    std::shared_ptr<Submap2D>& submap = submaps_[position];
    if (submap != nullptr) return submap;
    const ReplaySubmap& replay = plan_.submaps[position];
    mapping_proto::Submap2D proto =
        replay.is_placeholder()
            ? Placeholder(node)
            : *records_.at({replay.trajectory_id, replay.stored_index});
    proto.set_finished(false);
    submap = std::make_shared<Submap2D>(proto, &conversion_tables_);
    return submap;
  }

 private:
  // Its pose is where local SLAM would have begun it, at the robot.
  static mapping_proto::Submap2D Placeholder(
      const mapping_proto::TrajectoryNodeData& node) {
    mapping_proto::Submap2D proto;
    *proto.mutable_local_pose()->mutable_translation() =
        node.local_pose().translation();
    proto.mutable_local_pose()->mutable_rotation()->set_w(1.);
    auto* const grid = proto.mutable_grid();
    grid->mutable_limits()->set_resolution(0.05);
    grid->mutable_limits()->mutable_cell_limits()->set_num_x_cells(
        kPlaceholderCells);
    grid->mutable_limits()->mutable_cell_limits()->set_num_y_cells(
        kPlaceholderCells);
    for (int i = 0; i < kPlaceholderCells * kPlaceholderCells; ++i) {
      grid->add_cells(0);
    }
    grid->mutable_probability_grid_2d();
    grid->set_min_correspondence_cost(0.1f);
    grid->set_max_correspondence_cost(0.9f);
    return proto;
  }

  const ReplayPlan& plan_;
  std::map<GraphId, const mapping_proto::Submap2D*> records_;
  cartographer::mapping::ValueConversionTables conversion_tables_;
  std::vector<std::shared_ptr<Submap2D>> submaps_;
};

void SetInitialPoses(const io::Pbstream& pbstream,
                     PoseGraph2D* const pose_graph) {
  for (int i = 0; i < pbstream.options.options_with_sensor_ids_size() &&
                  i < pbstream.pose_graph.trajectory_size();
       ++i) {
    const auto& options = pbstream.options.options_with_sensor_ids(i)
                              .trajectory_builder_options();
    const int id = pbstream.pose_graph.trajectory(i).trajectory_id();
    if (!options.has_initial_trajectory_pose()) continue;
    const auto& initial = options.initial_trajectory_pose();
    if (initial.to_trajectory_id() == id) continue;
    pose_graph->SetInitialTrajectoryPose(
        id, initial.to_trajectory_id(),
        cartographer::transform::ToRigid3(initial.relative_pose()),
        cartographer::common::FromUniversal(initial.timestamp()));
  }
}

MapGraph Translate(const MapGraph& graph, const ReplayIds& ids) {
  MapGraph result;
  for (const auto& node : graph.nodes) {
    result.nodes[ids.StoredNode(node.first)] = node.second;
  }
  for (const auto& submap : graph.submaps) {
    const GraphId id = ids.StoredSubmap(submap.first);
    if (id.index >= 0) result.submaps[id] = submap.second;
  }
  for (GraphConstraint constraint : graph.constraints) {
    constraint.submap_id = ids.StoredSubmap(constraint.submap_id);
    constraint.node_id = ids.StoredNode(constraint.node_id);
    if (constraint.submap_id.index >= 0) {
      result.constraints.push_back(constraint);
    }
  }
  return result;
}

// Maps ids of the pose graph to those of the stored map.
void TranslateDecisions(const ReplayIds& ids,
                        std::vector<proto::LoopDecision>* const decisions) {
  for (proto::LoopDecision& decision : *decisions) {
    const GraphId submap = ids.StoredSubmap(
        {decision.submap_trajectory_id(), decision.submap_index()});
    const GraphId node =
        ids.StoredNode({decision.node_trajectory_id(), decision.node_index()});
    decision.set_submap_index(submap.index);
    decision.set_node_index(node.index);
  }
}

// Feeds all nodes and waits for the final optimisation.
void Drive(const io::Pbstream& pbstream, const ReplayPlan& plan,
           const MetricsCollector& metrics, const RerunOptions& options,
           SubmapMaker* const submaps, PoseGraph2D* const pose_graph) {
  std::map<GraphId, const mapping_proto::TrajectoryNodeData*> nodes;
  for (const auto& record : pbstream.nodes) {
    nodes[{record.node_id().trajectory_id(), record.node_id().node_index()}] =
        &record.node_data();
  }
  SensorFeeder sensors(pbstream, pose_graph);
  SetInitialPoses(pbstream, pose_graph);
  for (size_t i = 0; i < plan.steps.size(); ++i) {
    const ReplayStep& step = plan.steps[i];
    const mapping_proto::TrajectoryNodeData& data = *nodes.at(step.node_id);
    sensors.FeedUntil(step.node_id.trajectory_id, data.timestamp());
    std::vector<std::shared_ptr<const Submap2D>> insertion_submaps;
    for (const int position : step.submaps) {
      const std::shared_ptr<Submap2D> submap = submaps->Get(position, data);
      const ReplaySubmap& replay = plan.submaps[position];
      if (replay.finished && replay.last_step == i) submap->Finish();
      insertion_submaps.push_back(submap);
    }
    pose_graph->AddNode(std::make_shared<const TrajectoryNode::Data>(
                            cartographer::mapping::FromProto(data)),
                        step.node_id.trajectory_id, insertion_submaps);
    WaitForBackEnd(metrics, options.max_queue_length, kPatience);
    if (options.on_progress) {
      options.on_progress(static_cast<int64_t>(i) + 1,
                          static_cast<int64_t>(plan.steps.size()));
    }
  }
  for (const auto& trajectory : pbstream.pose_graph.trajectory()) {
    sensors.FeedUntil(trajectory.trajectory_id(),
                      std::numeric_limits<int64_t>::max());
  }
  // As a run ends, so that what is decided at its end is.
  std::set<int> trajectories;
  for (const ReplayStep& step : plan.steps) {
    trajectories.insert(step.node_id.trajectory_id);
  }
  for (const int trajectory_id : trajectories) {
    pose_graph->FinishTrajectory(trajectory_id);
  }
  pose_graph->RunFinalOptimization();
}

}  // namespace

absl::StatusOr<Rerun> RerunPoseGraph(
    const io::Pbstream& pbstream,
    const mapping_proto::PoseGraphOptions& pose_graph_options,
    const RerunOptions& options) {
  const absl::StatusOr<ReplayPlan> plan =
      MakeReplayPlan(MakeMapGraph(pbstream));
  if (!plan.ok()) return plan.status();
  MetricsCollector* const metrics = MetricsCollector::Global();
  const auto before = metrics->Values();
  const LoopCpu loop_cpu_before = MeasureLoopCpu(*metrics);
  const double searched = CountPairs(*metrics, "searched");
  const double found = CountPairs(*metrics, "found");
  const auto context = std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope(context);
  auto* const recorder = context->Get<loop_closure::DecisionRecorder>();
  recorder->Start(kMaxDecisions);
  const int64_t memory_before = ResetPeakMemory();
  const double cpu_before = ProcessCpuSeconds();
  const auto wall_before = std::chrono::steady_clock::now();

  Rerun result;
  // Outlives the pose graph, which shares its submaps.
  SubmapMaker submaps(pbstream, *plan);
  cartographer::common::ThreadPool thread_pool(options.num_background_threads);
  RecordedTrackOptions track_options;
  track_options.follow = options.follow_recording;
  RecordedTrack track(pbstream, *plan, pose_graph_options, track_options);
  PoseGraph2D pose_graph(pose_graph_options, track.MakeOptimizationProblem(),
                         &thread_pool);
  Drive(pbstream, *plan, *metrics, options, &submaps, &pose_graph);
  const ReplayIds ids(*plan);
  result.graph = Translate(MakeMapGraph(pose_graph), ids);
  result.outcomes = track.outcomes();
  result.followed_loops = track.num_followed();

  result.nodes = static_cast<int64_t>(plan->steps.size());
  result.placeholders = plan->num_placeholders;
  result.guessed_insertions = plan->num_guessed;
  result.wall_seconds = std::chrono::duration<double>(
                            std::chrono::steady_clock::now() - wall_before)
                            .count();
  result.cpu_seconds = ProcessCpuSeconds() - cpu_before;
  result.peak_memory_bytes =
      std::max<int64_t>(0, PeakMemorySinceReset() - memory_before);
  result.decisions = recorder->All();
  recorder->Stop();
  TranslateDecisions(ids, &result.decisions);
  result.searches =
      static_cast<int64_t>(CountPairs(*metrics, "searched") - searched);
  result.matches = static_cast<int64_t>(CountPairs(*metrics, "found") - found);
  result.loop_cpu = MeasureLoopCpu(*metrics) - loop_cpu_before;
  result.metrics = metrics->Values();
  for (const auto& entry : before) result.metrics[entry.first] -= entry.second;
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
