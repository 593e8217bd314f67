// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_graph.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/constraints/constraint_builder.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_options.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

// The trajectories of a PoseGraph message by id, in ascending order.
class TrajectoryProtos {
 public:
  TrajectoryProtos(const std::set<int>& ids, proto::PoseGraph* const graph) {
    for (const int id : ids) {
      graph->add_trajectory()->set_trajectory_id(id);
    }
    int index = 0;
    for (const int id : ids) {
      by_id_[id] = graph->mutable_trajectory(index++);
    }
  }
  proto::Trajectory* at(const int id) const { return by_id_.at(id); }

 private:
  std::map<int, proto::Trajectory*> by_id_;
};

}  // namespace

proto::PoseGraphOptions CreatePoseGraphOptions(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::PoseGraphOptions>(table);
  CHECK_GT(options.max_num_final_iterations(), 0);
  *options.mutable_constraint_builder_options() =
      common::ReadTable(table, "constraint_builder",
                        &constraints::CreateConstraintBuilderOptions);
  *options.mutable_optimization_problem_options() =
      common::ReadTable(table, "optimization_problem",
                        &optimization::CreateOptimizationProblemOptions);
  using Trimmer = proto::PoseGraphOptions::OverlappingSubmapsTrimmerOptions2D;
  common::ReadOptionalTable<Trimmer>(
      table, "overlapping_submaps_trimmer_2d", [&options]() {
        return options.mutable_overlapping_submaps_trimmer_2d();
      });
  return options;
}

std::vector<PoseGraph::Constraint> FromProto(
    const ::google::protobuf::RepeatedPtrField<proto::PoseGraph::Constraint>&
        constraint_protos) {
  std::vector<PoseGraph::Constraint> constraints;
  constraints.reserve(constraint_protos.size());
  for (const proto::PoseGraph::Constraint& constraint : constraint_protos) {
    constraints.push_back(PoseGraph::Constraint{
        SubmapId{constraint.submap_id().trajectory_id(),
                 constraint.submap_id().submap_index()},
        NodeId{constraint.node_id().trajectory_id(),
               constraint.node_id().node_index()},
        PoseGraph::Constraint::Pose{
            transform::ToRigid3(constraint.relative_pose()),
            constraint.translation_weight(), constraint.rotation_weight()},
        constraint.tag() == proto::PoseGraph::Constraint::INTER_SUBMAP
            ? PoseGraph::Constraint::INTER_SUBMAP
            : PoseGraph::Constraint::INTRA_SUBMAP});
  }
  return constraints;
}

proto::PoseGraph::Constraint ToProto(const PoseGraph::Constraint& constraint) {
  proto::PoseGraph::Constraint result;
  constraint.submap_id.ToProto(result.mutable_submap_id());
  constraint.node_id.ToProto(result.mutable_node_id());
  *result.mutable_relative_pose() = transform::ToProto(constraint.pose.zbar_ij);
  result.set_translation_weight(constraint.pose.translation_weight);
  result.set_rotation_weight(constraint.pose.rotation_weight);
  result.set_tag(constraint.tag == PoseGraph::Constraint::INTER_SUBMAP
                     ? proto::PoseGraph::Constraint::INTER_SUBMAP
                     : proto::PoseGraph::Constraint::INTRA_SUBMAP);
  return result;
}

proto::PoseGraph PoseGraph::ToProto(
    const bool include_unfinished_submaps) const {
  const auto submaps = GetAllSubmapData();
  const auto nodes = GetTrajectoryNodes();

  // Every living trajectory gets an entry, even one without data: the builder
  // options that follow in a stored state are paired with them by position.
  std::set<int> trajectory_ids;
  for (const auto& id_state : GetTrajectoryStates()) {
    if (id_state.second != TrajectoryState::DELETED) {
      trajectory_ids.insert(id_state.first);
    }
  }
  for (const int id : submaps.trajectory_ids()) trajectory_ids.insert(id);
  for (const int id : nodes.trajectory_ids()) trajectory_ids.insert(id);

  proto::PoseGraph result;
  const TrajectoryProtos trajectories(trajectory_ids, &result);
  std::set<SubmapId> left_out;
  for (const auto& submap : submaps) {
    if (!include_unfinished_submaps &&
        !submap.data.submap->insertion_finished()) {
      left_out.insert(submap.id);
      continue;
    }
    auto* const submap_proto =
        trajectories.at(submap.id.trajectory_id)->add_submap();
    submap_proto->set_submap_index(submap.id.submap_index);
    *submap_proto->mutable_pose() = transform::ToProto(submap.data.pose);
  }
  for (const auto& node : nodes) {
    auto* const node_proto = trajectories.at(node.id.trajectory_id)->add_node();
    node_proto->set_node_index(node.id.node_index);
    node_proto->set_timestamp(common::ToUniversal(node.data.time()));
    *node_proto->mutable_pose() = transform::ToProto(node.data.global_pose);
  }
  for (const Constraint& constraint : constraints()) {
    if (left_out.count(constraint.submap_id) == 0) {
      *result.add_constraint() = mapping::ToProto(constraint);
    }
  }
  for (const auto& id_pose : GetLandmarkPoses()) {
    auto* const landmark = result.add_landmark_poses();
    landmark->set_landmark_id(id_pose.first);
    *landmark->mutable_global_pose() = transform::ToProto(id_pose.second);
  }
  return result;
}

}  // namespace mapping
}  // namespace cartographer
