// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A stored SLAM state in memory, checked, before anything of it enters a pose
// graph: broken input is refused as a whole.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_STORED_STATE_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_STORED_STATE_H_

#include <map>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/io/proto_stream_interface.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

struct StoredState {
  proto::PoseGraph pose_graph;
  // One per trajectory of the pose graph, in the same order.
  proto::AllTrajectoryBuilderOptions builder_options;
  // In the order of the stream. Every submap and node has a pose in
  // `pose_graph`, every trajectory id occurs there.
  std::vector<proto::SerializedData> records;

  // Gives every trajectory a new id, everywhere.
  void Renumber(const std::map<int, int>& new_trajectory_ids);

  // (global <- submap) and (global <- tracking).
  MapById<SubmapId, transform::Rigid3d> SubmapPoses() const;
  MapById<NodeId, transform::Rigid3d> NodePoses() const;
};

// Reads to the end of the stream. Errors: no state of a known version, records
// in the wrong order, 3D submaps, names that occur twice or refer to nothing,
// poses that are no poses.
absl::StatusOr<StoredState> ReadStoredState(
    io::ProtoStreamReaderInterface* reader);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_STORED_STATE_H_
