// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the frame of a map in a repair, so that poses in it (docks, waypoints)
// stay valid wherever the map was right.
#ifndef CARTOGRAPHER_EXT_REPAIR_KEPT_FRAME_H_
#define CARTOGRAPHER_EXT_REPAIR_KEPT_FRAME_H_

#include <string>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace repair {

// (old map <- new map): a robust rigid fit of the nodes, so that those with
// unchanged relative poses keep their coordinates. The identity without common
// nodes.
Pose2 OldFromNewByNodes(const evaluation::MapGraph& before,
                        const evaluation::MapGraph& after);

// (old map <- new map): the first node is fixed.
Pose2 OldFromNewByStart(const evaluation::MapGraph& before,
                        const evaluation::MapGraph& after);

// CSV with a header line: each node's pose in the old and in the new map,
// metres and radians.
std::string PoseTable(const evaluation::MapGraph& before,
                      const evaluation::MapGraph& after);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_KEPT_FRAME_H_
