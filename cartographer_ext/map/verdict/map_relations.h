// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Relations from a finished map that is believed: what other runs over the same
// recording are held against where nobody has ground truth. They follow
// Kuemmerle et al., "On Measuring the Accuracy of SLAM Algorithms" (2009),
// section 4: relative poses of neighbours on the path, and of places that were
// visited again. They are as good as the map: they tell a run that folds from
// one that does not, and not which of two good ones is better by a centimetre.
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
  // Path in metres between the nodes that relations start at.
  double spacing = 1.;
  // Loops whose node and submap are less apart in time say little.
  io::TimeNs min_loop_time = io::FromSeconds(60.);
};

// In the order of their second node. Two kinds:
// * from each node to the first that is `spacing` farther along the path;
// * for each loop in force within the trajectory, from the node of the submap
//   that is nearest to the loop's node to that node, a loop each `spacing` of
//   path at most.
std::vector<io::StampedRelation> MakeMapRelations(
    const MapGraph& graph, const MapRelationsOptions& options);

// The same for the map called `name` with this verdict; FailedPrecondition,
// which names it, unless it is "sound" and there are any.
absl::StatusOr<std::vector<io::StampedRelation>> MakeRelationsIfSound(
    const MapGraph& graph, const std::string& name, const std::string& verdict,
    const MapRelationsOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_MAP_RELATIONS_H_
