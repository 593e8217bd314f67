// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/stored_state.h"

#include <set>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer/io/internal/mapping_state_serialization.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {
namespace {

using proto::SerializedData;

SubmapId ToId(const proto::SubmapId& id) {
  return SubmapId{id.trajectory_id(), id.submap_index()};
}
NodeId ToId(const proto::NodeId& id) {
  return NodeId{id.trajectory_id(), id.node_index()};
}

template <typename IdType>
std::string Name(const char* const kind, const IdType& id) {
  return absl::StrCat(kind, " ", internal::IndexOf(id), " of trajectory ",
                      id.trajectory_id);
}

absl::Status Error(const std::string& message) {
  return absl::InvalidArgumentError("stored state: " + message);
}

// Calls `visit` with the message that holds the trajectory id of a record.
template <typename Visitor>
void VisitTrajectoryId(SerializedData* const record, const Visitor& visit) {
  switch (record->data_case()) {
    case SerializedData::kSubmap:
      visit(record->mutable_submap()->mutable_submap_id());
      break;
    case SerializedData::kNode:
      visit(record->mutable_node()->mutable_node_id());
      break;
    case SerializedData::kTrajectoryData:
      visit(record->mutable_trajectory_data());
      break;
    case SerializedData::kImuData:
      visit(record->mutable_imu_data());
      break;
    case SerializedData::kOdometryData:
      visit(record->mutable_odometry_data());
      break;
    case SerializedData::kFixedFramePoseData:
      visit(record->mutable_fixed_frame_pose_data());
      break;
    case SerializedData::kLandmarkData:
      visit(record->mutable_landmark_data());
      break;
    default:
      break;
  }
}

bool IsPose(const transform::proto::Rigid3d& pose) {
  return transform::ToRigid3(pose).IsValid();
}

// Goes through a state and notes what it has seen.
class Checker {
 public:
  absl::Status CheckGraph(const StoredState& state) {
    if (state.pose_graph.trajectory_size() !=
        state.builder_options.options_with_sensor_ids_size()) {
      return Error("not as many builder options as trajectories");
    }
    for (const auto& trajectory : state.pose_graph.trajectory()) {
      const int id = trajectory.trajectory_id();
      if (id < 0 || !trajectory_ids_.insert(id).second) {
        return Error(absl::StrCat("trajectory id ", id, " is not usable"));
      }
      for (const auto& submap : trajectory.submap()) {
        const SubmapId submap_id{id, submap.submap_index()};
        if (submap_id.submap_index < 0 || !IsPose(submap.pose()) ||
            !submaps_with_pose_.insert(submap_id).second) {
          return Error(Name("submap", submap_id) + " has no usable pose");
        }
      }
      for (const auto& node : trajectory.node()) {
        const NodeId node_id{id, node.node_index()};
        if (node_id.node_index < 0 || !IsPose(node.pose()) ||
            !nodes_with_pose_.insert(node_id).second) {
          return Error(Name("node", node_id) + " has no usable pose");
        }
      }
    }
    for (const auto& landmark : state.pose_graph.landmark_poses()) {
      if (!IsPose(landmark.global_pose())) {
        return Error("landmark '" + landmark.landmark_id() +
                     "' has no usable pose");
      }
    }
    return absl::OkStatus();
  }

  absl::Status CheckRecord(SerializedData* const record) {
    bool known = true;
    VisitTrajectoryId(record, [this, &known](const auto* const message) {
      known = trajectory_ids_.count(message->trajectory_id()) != 0;
    });
    if (!known) {
      return Error("a record is of a trajectory that the pose graph lacks");
    }
    switch (record->data_case()) {
      case SerializedData::kPoseGraph:
      case SerializedData::kAllTrajectoryBuilderOptions:
        return Error("a record that may occur only once occurs again");
      case SerializedData::kSubmap:
        return CheckSubmap(record->submap());
      case SerializedData::kNode:
        return CheckNode(record->node());
      case SerializedData::kOdometryData:
        return IsPose(record->odometry_data().odometry_data().pose())
                   ? absl::OkStatus()
                   : Error("an odometry reading has no usable pose");
      default:
        return absl::OkStatus();
    }
  }

  // Needs all records.
  absl::Status CheckConstraints(const proto::PoseGraph& pose_graph) {
    for (const auto& constraint : pose_graph.constraint()) {
      if (submaps_.count(ToId(constraint.submap_id())) == 0 ||
          nodes_.count(ToId(constraint.node_id())) == 0) {
        return Error(absl::StrCat("a constraint is between ",
                                  Name("submap", ToId(constraint.submap_id())),
                                  " and ",
                                  Name("node", ToId(constraint.node_id())),
                                  ", which are not both there"));
      }
      if (!IsPose(constraint.relative_pose())) {
        return Error("a constraint has no usable pose");
      }
    }
    return absl::OkStatus();
  }

 private:
  absl::Status CheckSubmap(const proto::Submap& submap) {
    const SubmapId id = ToId(submap.submap_id());
    if (submap.has_submap_3d()) {
      return Error(Name("submap", id) + " is 3D, only 2D is supported");
    }
    if (!submap.has_submap_2d() || submaps_with_pose_.count(id) == 0 ||
        !IsPose(submap.submap_2d().local_pose()) ||
        !submaps_.insert(id).second) {
      return Error(Name("submap", id) +
                   " is empty, occurs twice or has no pose");
    }
    return absl::OkStatus();
  }

  absl::Status CheckNode(const proto::Node& node) {
    const NodeId id = ToId(node.node_id());
    const auto gravity_alignment = transform::Rigid3d::Rotation(
        transform::ToEigen(node.node_data().gravity_alignment()));
    if (nodes_with_pose_.count(id) == 0 ||
        !IsPose(node.node_data().local_pose()) ||
        !gravity_alignment.IsValid() || !nodes_.insert(id).second) {
      return Error(Name("node", id) + " occurs twice or has no pose");
    }
    return absl::OkStatus();
  }

  std::set<int> trajectory_ids_;
  std::set<SubmapId> submaps_with_pose_;
  std::set<NodeId> nodes_with_pose_;
  std::set<SubmapId> submaps_;
  std::set<NodeId> nodes_;
};

}  // namespace

absl::StatusOr<StoredState> ReadStoredState(
    io::ProtoStreamReaderInterface* const reader) {
  proto::SerializationHeader header;
  if (!reader->ReadProto(&header)) {
    return Error("there is no header");
  }
  if (header.format_version() != io::kMappingStateSerializationFormatVersion &&
      header.format_version() != io::kFormatVersionWithoutSubmapHistograms) {
    return Error(absl::StrCat("format version ", header.format_version(),
                              " is not 1 or 2"));
  }
  StoredState state;
  SerializedData record;
  if (!reader->ReadProto(&record) || !record.has_pose_graph()) {
    return Error("the pose graph does not follow the header");
  }
  state.pose_graph = std::move(*record.mutable_pose_graph());
  if (!reader->ReadProto(&record) ||
      !record.has_all_trajectory_builder_options()) {
    return Error("the builder options do not follow the pose graph");
  }
  state.builder_options =
      std::move(*record.mutable_all_trajectory_builder_options());

  Checker checker;
  absl::Status status = checker.CheckGraph(state);
  while (status.ok() && reader->ReadProto(&record)) {
    status = checker.CheckRecord(&record);
    state.records.push_back(std::move(record));
    record = SerializedData();
  }
  if (status.ok() && !reader->eof()) {
    status = Error("the stream is damaged or cut off");
  }
  if (status.ok()) {
    status = checker.CheckConstraints(state.pose_graph);
  }
  if (!status.ok()) {
    return status;
  }
  return state;
}

void StoredState::Renumber(const std::map<int, int>& new_trajectory_ids) {
  const auto renumber = [&new_trajectory_ids](auto* const message) {
    message->set_trajectory_id(new_trajectory_ids.at(message->trajectory_id()));
  };
  for (auto& trajectory : *pose_graph.mutable_trajectory()) {
    renumber(&trajectory);
  }
  for (auto& constraint : *pose_graph.mutable_constraint()) {
    renumber(constraint.mutable_submap_id());
    renumber(constraint.mutable_node_id());
  }
  for (SerializedData& record : records) {
    VisitTrajectoryId(&record, renumber);
  }
}

MapById<SubmapId, transform::Rigid3d> StoredState::SubmapPoses() const {
  MapById<SubmapId, transform::Rigid3d> poses;
  for (const auto& trajectory : pose_graph.trajectory()) {
    for (const auto& submap : trajectory.submap()) {
      poses.Insert(SubmapId{trajectory.trajectory_id(), submap.submap_index()},
                   transform::ToRigid3(submap.pose()));
    }
  }
  return poses;
}

MapById<NodeId, transform::Rigid3d> StoredState::NodePoses() const {
  MapById<NodeId, transform::Rigid3d> poses;
  for (const auto& trajectory : pose_graph.trajectory()) {
    for (const auto& node : trajectory.node()) {
      poses.Insert(NodeId{trajectory.trajectory_id(), node.node_index()},
                   transform::ToRigid3(node.pose()));
    }
  }
  return poses;
}

}  // namespace mapping
}  // namespace cartographer
