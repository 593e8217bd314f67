// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A pose graph as a stream of records: header, pose graph, builder options,
// then submaps, nodes and sensor data.
#ifndef CARTOGRAPHER_IO_INTERNAL_MAPPING_STATE_SERIALIZATION_H_
#define CARTOGRAPHER_IO_INTERNAL_MAPPING_STATE_SERIALIZATION_H_

#include <vector>

#include "cartographer/io/proto_stream_interface.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer {
namespace io {

// The version that is written.
static constexpr int kMappingStateSerializationFormatVersion = 2;
// Differs in 3D only, and is read, too.
static constexpr int kFormatVersionWithoutSubmapHistograms = 1;

// `builder_options` is indexed by trajectory id. Unfinished submaps, and
// their constraints, are written on request only.
void WritePbStream(
    const mapping::PoseGraph& pose_graph,
    const std::vector<mapping::proto::TrajectoryBuilderOptionsWithSensorIds>&
        builder_options,
    ProtoStreamWriterInterface* const writer, bool include_unfinished_submaps);

}  // namespace io
}  // namespace cartographer

#endif  // CARTOGRAPHER_IO_INTERNAL_MAPPING_STATE_SERIALIZATION_H_
