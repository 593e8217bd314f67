// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/recorded_track.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "cartographer/mapping/id.h"
#include "cartographer/transform/transform.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;
namespace mapping_proto = cartographer::mapping::proto;

GraphId ToGraphId(const NodeId& id) {
  return {id.trajectory_id, id.node_index};
}

GraphId ToGraphId(const SubmapId& id) {
  return {id.trajectory_id, id.submap_index};
}

}  // namespace

// Solves as its base does, with the stored poses of loops that were found
// again, and notifies the track when a node has its first pose.
class RecordedTrack::FollowingProblem : public RecordedTrack::Problem {
 public:
  FollowingProblem(const cartographer::mapping::optimization::proto::
                       OptimizationProblemOptions& options,
                   RecordedTrack* const track)
      : Problem(options), track_(track) {}

  void AddTrajectoryNode(
      const int trajectory_id,
      const cartographer::mapping::optimization::NodeSpec2D& node) override {
    Problem::AddTrajectoryNode(trajectory_id, node);
    track_->OnNode(*this);
  }

  void Solve(
      const std::vector<Constraint>& constraints,
      const std::map<
          int, cartographer::mapping::PoseGraphInterface::TrajectoryState>&
          states,
      const std::map<std::string,
                     cartographer::mapping::PoseGraphInterface::LandmarkNode>&
          landmarks) override {
    Problem::Solve(track_->Follow(*this, constraints), states, landmarks);
  }

 private:
  RecordedTrack* const track_;
};

RecordedTrack::RecordedTrack(
    const io::Pbstream& pbstream, const ReplayPlan& plan,
    const mapping_proto::PoseGraphOptions& pose_graph_options,
    const RecordedTrackOptions& options)
    : plan_(plan),
      ids_(plan),
      pose_graph_options_(pose_graph_options),
      options_(options) {
  for (const auto& record : pbstream.pose_graph.constraint()) {
    if (record.tag() != mapping_proto::PoseGraph::Constraint::INTER_SUBMAP) {
      continue;
    }
    const GraphId submap_id{record.submap_id().trajectory_id(),
                            record.submap_id().submap_index()};
    const GraphId node_id{record.node_id().trajectory_id(),
                          record.node_id().node_index()};
    recorded_[{submap_id, node_id}] =
        cartographer::transform::ToRigid3(record.relative_pose());
  }
}

std::unique_ptr<RecordedTrack::Problem>
RecordedTrack::MakeOptimizationProblem() {
  return std::make_unique<FollowingProblem>(
      pose_graph_options_.optimization_problem_options(), this);
}

void RecordedTrack::OnNode(const Problem& problem) {
  if (num_steps_ >= plan_.steps.size()) return;
  const size_t step = num_steps_++;
  // Matches the new node against all submaps finished before, and a submap that
  // this node finishes against all nodes that are not in it.
  const GraphId node_id = ids_.NodeOfStep(step);
  for (const GraphId& submap_id : finished_submaps_) {
    OnCandidate(problem, submap_id, node_id);
  }
  const int front = plan_.steps[step].submaps.front();
  const ReplaySubmap& submap = plan_.submaps[front];
  if (!submap.finished || submap.last_step != step) return;
  const GraphId submap_id = ids_.SubmapAt(front);
  finished_submaps_.insert(submap_id);
  for (size_t i = 0; i <= step; ++i) {
    const std::vector<int>& inserted = plan_.steps[i].submaps;
    if (std::find(inserted.begin(), inserted.end(), front) == inserted.end()) {
      OnCandidate(problem, submap_id, ids_.NodeOfStep(i));
    }
  }
}

void RecordedTrack::OnCandidate(const Problem& problem,
                                const GraphId& submap_id,
                                const GraphId& node_id) {
  if (submap_id.trajectory_id != node_id.trajectory_id) return;
  const auto& builder = pose_graph_options_.constraint_builder_options();
  auto& sampler =
      samplers_
          .emplace(std::piecewise_construct, std::forward_as_tuple(submap_id),
                   std::forward_as_tuple(builder.sampling_ratio()))
          .first->second;
  const Rigid2d submap_from_node =
      problem.submap_data()
          .at(SubmapId(submap_id.trajectory_id, submap_id.index))
          .global_pose.inverse() *
      problem.node_data()
          .at(NodeId(node_id.trajectory_id, node_id.index))
          .global_pose_2d;
  LoopOutcome outcome;
  outcome.distance = submap_from_node.translation().norm();
  if (outcome.distance > builder.max_constraint_distance()) {
    outcome.kind = LoopOutcome::Kind::kTooFar;
  } else if (sampler.Pulse()) {
    outcome.kind = LoopOutcome::Kind::kSearched;
  } else {
    outcome.kind = LoopOutcome::Kind::kNotSampled;
  }
  const LoopPair stored{ids_.StoredSubmap(submap_id), ids_.StoredNode(node_id)};
  if (recorded_.count(stored) > 0) outcomes_[stored] = outcome;
}

std::vector<RecordedTrack::Constraint> RecordedTrack::Follow(
    const Problem& problem, const std::vector<Constraint>& constraints) {
  if (!options_.follow) return constraints;
  std::vector<Constraint> result;
  num_followed_ = 0;
  for (const Constraint& constraint : constraints) {
    if (constraint.tag != Constraint::INTER_SUBMAP) {
      result.push_back(constraint);
      continue;
    }
    const auto recorded =
        recorded_.find({ids_.StoredSubmap(ToGraphId(constraint.submap_id)),
                        ids_.StoredNode(ToGraphId(constraint.node_id))});
    if (recorded == recorded_.end()) continue;
    result.push_back(constraint);
    // Inside the pose graph a node represents the gravity-aligned frame.
    const Rigid3d stored_pose =
        recorded->second * Rigid3d::Rotation(problem.node_data()
                                                 .at(constraint.node_id)
                                                 .gravity_alignment.inverse());
    const Rigid2d difference = cartographer::transform::Project2D(
        constraint.pose.zbar_ij.inverse() * stored_pose);
    if (difference.translation().norm() <= options_.translation_tolerance &&
        std::abs(difference.normalized_angle()) <=
            options_.rotation_tolerance) {
      result.back().pose.zbar_ij = stored_pose;
      ++num_followed_;
    }
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
