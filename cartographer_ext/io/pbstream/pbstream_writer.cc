// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_writer.h"

#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace io {
namespace {

using Data = cartographer::mapping::proto::SerializedData;

// The envelope, a union with one member, around the bytes of that member.
template <typename Proto>
void AppendEnveloped(const int field_number, const Proto& proto,
                     std::string* const content) {
  const std::string message = proto.SerializeAsString();
  std::string record(1, static_cast<char>(field_number << 3 | 2));
  uint64_t size = message.size();
  for (; size >= 0x80; size >>= 7) {
    record.push_back(static_cast<char>(size | 0x80));
  }
  record.push_back(static_cast<char>(size));
  AppendPbstreamRecord(record + message, content);
}

template <typename Protos>
void AppendAll(const int field_number, const Protos& protos,
               std::string* const content) {
  for (const auto& proto : protos) {
    AppendEnveloped(field_number, proto, content);
  }
}

}  // namespace

std::string SerializePbstream(const Pbstream& pbstream) {
  std::string content(PbstreamMagic());
  AppendPbstreamRecord(pbstream.header.SerializeAsString(), &content);
  AppendEnveloped(Data::kPoseGraphFieldNumber, pbstream.pose_graph, &content);
  AppendEnveloped(Data::kAllTrajectoryBuilderOptionsFieldNumber,
                  pbstream.options, &content);
  AppendAll(Data::kSubmapFieldNumber, pbstream.submaps, &content);
  AppendAll(Data::kNodeFieldNumber, pbstream.nodes, &content);
  AppendAll(Data::kTrajectoryDataFieldNumber, pbstream.trajectory_data,
            &content);
  AppendAll(Data::kImuDataFieldNumber, pbstream.imu_data, &content);
  AppendAll(Data::kOdometryDataFieldNumber, pbstream.odometry_data, &content);
  AppendAll(Data::kFixedFramePoseDataFieldNumber,
            pbstream.fixed_frame_pose_data, &content);
  AppendAll(Data::kLandmarkDataFieldNumber, pbstream.landmark_data, &content);
  return content;
}

absl::Status WritePbstream(const Pbstream& pbstream,
                           const std::string& filename) {
  return WriteFileAtomically(filename, SerializePbstream(pbstream));
}

}  // namespace io
}  // namespace cartographer_ext
