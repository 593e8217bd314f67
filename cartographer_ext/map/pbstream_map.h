// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The map of a stored state, in plain types.
#ifndef CARTOGRAPHER_EXT_MAP_PBSTREAM_MAP_H_
#define CARTOGRAPHER_EXT_MAP_PBSTREAM_MAP_H_

#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

std::vector<GraphConstraint> MakeConstraints(
    const cartographer::mapping::proto::PoseGraph& pose_graph);

// Nodes and submaps without a global pose are skipped.
MapGraph MakeMapGraph(const io::Pbstream& pbstream);

// Paints all submaps with a global pose; resolution in metres per cell.
absl::StatusOr<io::OccupancyMap> PaintPbstreamMap(const io::Pbstream& pbstream,
                                                  double resolution);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_PBSTREAM_MAP_H_
