// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/starting_state.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer/common/time.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"

namespace cartographer_ext {
namespace evaluation {

using cartographer::mapping::MapBuilderInterface;
using cartographer::mapping::PoseGraphInterface;
using cartographer::transform::Rigid3d;

absl::StatusOr<Pose2> ParsePose(const std::string& text) {
  const std::vector<std::string> words = absl::StrSplit(text, ',');
  double values[3] = {};
  bool valid = words.size() == 3;
  for (size_t i = 0; valid && i < 3; ++i) {
    valid = absl::SimpleAtod(words[i], &values[i]) && std::isfinite(values[i]);
  }
  if (!valid) {
    return absl::InvalidArgumentError(
        absl::StrCat("\"", text, "\" is not X,Y,DEGREES"));
  }
  return Pose2(values[0], values[1], NormalizeAngle(DegToRad(values[2])));
}

absl::StatusOr<std::map<int, int>> LoadStartingState(
    const StartingState& state, MapBuilderInterface* const map_builder) {
  {
    const auto pbstream = io::ReadPbstream(state.filename);
    if (!pbstream.ok()) return pbstream.status();
    if (pbstream->nodes.empty() || pbstream->submaps.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat(state.filename, ": the map is empty"));
    }
    for (const auto& submap : pbstream->submaps) {
      if (submap.submap_2d().has_grid()) continue;
      return absl::InvalidArgumentError(absl::StrCat(
          state.filename, ": submap (", submap.submap_id().trajectory_id(),
          ", ", submap.submap_id().submap_index(),
          ") has no grid, so nothing can be matched with it"));
    }
  }
  return map_builder->LoadStateFromFile(state.filename, state.frozen);
}

absl::Status SetInitialPose(
    const Pose2& initial_pose, const int to_trajectory_id,
    const PoseGraphInterface& pose_graph,
    cartographer::mapping::proto::TrajectoryBuilderOptions* const options) {
  const auto nodes = pose_graph.GetTrajectoryNodePoses();
  if (nodes.SizeOfTrajectoryOrZero(to_trajectory_id) == 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        "trajectory ", to_trajectory_id, " of the map has no nodes"));
  }
  const auto first = *nodes.BeginOfTrajectory(to_trajectory_id);
  if (!first.data.constant_pose_data.has_value()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the first node of trajectory ", to_trajectory_id, " has no stamp"));
  }
  const Rigid3d map_from_robot(
      Eigen::Vector3d(initial_pose.x, initial_pose.y, 0.),
      Eigen::Quaterniond(
          Eigen::AngleAxisd(initial_pose.theta, Eigen::Vector3d::UnitZ())));
  auto* const initial = options->mutable_initial_trajectory_pose();
  initial->set_to_trajectory_id(to_trajectory_id);
  *initial->mutable_relative_pose() = cartographer::transform::ToProto(
      first.data.global_pose.inverse() * map_from_robot);
  initial->set_timestamp(
      cartographer::common::ToUniversal(first.data.constant_pose_data->time));
  return absl::OkStatus();
}

bool IsTiedToOthers(const PoseGraphInterface& pose_graph,
                    const int trajectory_id) {
  auto constraints = pose_graph.constraints();
  RemoveWithdrawnLoops(&constraints);
  return std::any_of(
      constraints.begin(), constraints.end(), [&](const auto& constraint) {
        const int submap_trajectory = constraint.submap_id.trajectory_id;
        const int node_trajectory = constraint.node_id.trajectory_id;
        return constraint.tag == PoseGraphInterface::Constraint::INTER_SUBMAP &&
               submap_trajectory != node_trajectory &&
               (submap_trajectory == trajectory_id ||
                node_trajectory == trajectory_id);
      });
}

}  // namespace evaluation
}  // namespace cartographer_ext
