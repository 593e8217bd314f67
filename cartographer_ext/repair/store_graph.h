// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Stores the result of a re-run in the map.
#ifndef CARTOGRAPHER_EXT_REPAIR_STORE_GRAPH_H_
#define CARTOGRAPHER_EXT_REPAIR_STORE_GRAPH_H_

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace repair {

// Optimised poses of nodes and submaps, and the loops, become those of `graph`,
// which has the ids of the map. Height, roll, pitch and insertions are kept.
// Landmarks move with the node that last observed them.
void StoreGraph(const evaluation::MapGraph& graph, io::Pbstream* pbstream);

// Transforms the whole map: (new map frame <- old map frame).
void MoveMap(const Pose2& new_from_old, io::Pbstream* pbstream);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_STORE_GRAPH_H_
