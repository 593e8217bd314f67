// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A map's pose graph in g2o's format. Submaps and nodes are vertices; their ids
// must not overlap, so those of trajectory t are
//
//   submap  t * 2000000 + submap_index
//   node    t * 2000000 + 1000000 + node_index
//
// Every constraint is an edge from submap to node, in the order of the map,
// with the information diag(w_t^2, w_t^2, w_r^2) of its weights. The first
// submap is fixed.
#ifndef CARTOGRAPHER_EXT_MAP_POSE_GRAPH_EXPORT_H_
#define CARTOGRAPHER_EXT_MAP_POSE_GRAPH_EXPORT_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

int64_t SubmapVertexId(const GraphId& id);
int64_t NodeVertexId(const GraphId& id);

// Constraints of missing submaps or nodes, or of weight zero, are skipped. An
// error when an index does not fit the scheme above.
absl::StatusOr<io::G2oGraph> ToG2o(const MapGraph& graph);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_POSE_GRAPH_EXPORT_H_
