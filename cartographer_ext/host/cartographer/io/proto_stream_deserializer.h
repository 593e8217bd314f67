// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_IO_PROTO_STREAM_DESERIALIZER_H_
#define CARTOGRAPHER_IO_PROTO_STREAM_DESERIALIZER_H_

#include <string>

#include "cartographer/io/proto_stream_interface.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer {
namespace io {

// Fatal when the file is not a state of a known version.
mapping::proto::PoseGraph DeserializePoseGraphFromFile(
    const std::string& file_name);

// Reads a serialized state. The constructor reads header, pose graph and
// trajectory options, which every state starts with; anything else, an unknown
// version, or not as many options as trajectories is fatal.
class ProtoStreamDeserializer {
 public:
  explicit ProtoStreamDeserializer(ProtoStreamReaderInterface* reader);
  ProtoStreamDeserializer(const ProtoStreamDeserializer&) = delete;
  ProtoStreamDeserializer& operator=(const ProtoStreamDeserializer&) = delete;

  mapping::proto::SerializationHeader& header() { return header_; }
  mapping::proto::PoseGraph& pose_graph() {
    return *pose_graph_.mutable_pose_graph();
  }
  const mapping::proto::PoseGraph& pose_graph() const {
    return pose_graph_.pose_graph();
  }
  const mapping::proto::AllTrajectoryBuilderOptions&
  all_trajectory_builder_options() {
    return options_.all_trajectory_builder_options();
  }

  // The next record; false at the end.
  bool ReadNextSerializedData(mapping::proto::SerializedData* data);

 private:
  ProtoStreamReaderInterface* reader_;
  mapping::proto::SerializationHeader header_;
  mapping::proto::SerializedData pose_graph_;
  mapping::proto::SerializedData options_;
};

}  // namespace io
}  // namespace cartographer

#endif  // CARTOGRAPHER_IO_PROTO_STREAM_DESERIALIZER_H_
