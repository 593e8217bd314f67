// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A map to start from: to localise in it, or to continue mapping.
#ifndef CARTOGRAPHER_EXT_SLAM_STARTING_STATE_H_
#define CARTOGRAPHER_EXT_SLAM_STARTING_STATE_H_

#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace evaluation {

struct StartingState {
  std::string filename;  // .pbstream; empty: no map
  // The map is frozen, and not searched against itself.
  bool frozen = true;
  // (map <- robot) at the first scan, if known; needs a file.
  absl::optional<Pose2> initial_pose;
};

// "X,Y,DEGREES". The error quotes the text.
absl::StatusOr<Pose2> ParsePose(const std::string& text);

// Loads the file after checking it, because the host would terminate the
// program on a bad one. Returns the new ids of the stored trajectories by their
// ids in the file. Errors: those of io::ReadPbstream, a state without nodes.
absl::StatusOr<std::map<int, int>> LoadStartingState(
    const StartingState& state,
    cartographer::mapping::MapBuilderInterface* map_builder);

// Sets the initial pose of a trajectory in the host's form: relative to the
// first node of trajectory `to_trajectory_id`. An error if that has no nodes.
absl::Status SetInitialPose(
    const Pose2& initial_pose, int to_trajectory_id,
    const cartographer::mapping::PoseGraphInterface& pose_graph,
    cartographer::mapping::proto::TrajectoryBuilderOptions* options);

// Whether a loop in force connects the trajectory with another one.
bool IsTiedToOthers(const cartographer::mapping::PoseGraphInterface& pose_graph,
                    int trajectory_id);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_STARTING_STATE_H_
