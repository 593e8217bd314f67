// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Relations from a finished, trusted map, as a reference for other runs over
// the same recording without ground truth. They follow Kuemmerle et al., "On
// Measuring the Accuracy of SLAM Algorithms" (2009), section 4: relative poses
// of neighbours on the path, and of places that were visited again. They are as
// accurate as the map: they distinguish a folded run from a good one, but not
// two good ones that differ by a centimetre.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_MAP_RELATIONS_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_MAP_RELATIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

struct MapRelationsOptions {
  int trajectory_id = 0;
  // Path length in metres between the nodes at which relations start.
  double spacing = 1.;
  // Minimum time between node and submap of a loop.
  io::TimeNs min_loop_time = io::FromSeconds(60.);
};

// Relations in the order of their second node, of two kinds:
// * from each node to the first that is `spacing` farther along the path;
// * for each loop in force within the trajectory, from the node of the submap
//   that is nearest to the loop's node to that node, a loop each `spacing` of
//   path at most.
std::vector<io::StampedRelation> MakeMapRelations(
    const MapGraph& graph, const MapRelationsOptions& options);

// The same for the map called `name` with this verdict; FailedPrecondition,
// which names it, unless the verdict is "sound" and there are relations.
absl::StatusOr<std::vector<io::StampedRelation>> MakeRelationsIfSound(
    const MapGraph& graph, const std::string& name, const std::string& verdict,
    const MapRelationsOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_MAP_RELATIONS_H_
