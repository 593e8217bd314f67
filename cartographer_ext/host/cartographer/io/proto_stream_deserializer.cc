// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/io/proto_stream_deserializer.h"

#include <utility>

#include "cartographer/common/port.h"
#include "cartographer/io/proto_stream.h"
#include "glog/logging.h"

namespace cartographer {
namespace io {

namespace {

// Version 1 differs in 3D submaps only.
constexpr uint32 kOldestVersion = 1;
constexpr uint32 kNewestVersion = 2;

}  // namespace

mapping::proto::PoseGraph DeserializePoseGraphFromFile(
    const std::string& file_name) {
  ProtoStreamReader reader(file_name);
  ProtoStreamDeserializer deserializer(&reader);
  return std::move(deserializer.pose_graph());
}

ProtoStreamDeserializer::ProtoStreamDeserializer(
    ProtoStreamReaderInterface* const reader)
    : reader_(reader) {
  CHECK(reader_->ReadProto(&header_)) << "Cannot read the stream's header.";
  const uint32 version = header_.format_version();
  CHECK(version >= kOldestVersion && version <= kNewestVersion)
      << "Unsupported serialization format version " << version << ".";
  CHECK(ReadNextSerializedData(&pose_graph_) && pose_graph_.has_pose_graph())
      << "The stream does not start with a pose graph.";
  CHECK(ReadNextSerializedData(&options_) &&
        options_.has_all_trajectory_builder_options())
      << "The pose graph is not followed by trajectory builder options.";
  CHECK_EQ(pose_graph().trajectory_size(),
           all_trajectory_builder_options().options_with_sensor_ids_size())
      << "As many trajectories as options are expected.";
}

bool ProtoStreamDeserializer::ReadNextSerializedData(
    mapping::proto::SerializedData* const data) {
  return reader_->ReadProto(data);
}

}  // namespace io
}  // namespace cartographer
