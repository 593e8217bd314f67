// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops proposed by a user. A proposal is only a hint: the scan is searched in
// the submap as the constraint builder does [Olson 2009; Hess et al. 2016,
// section V], refined, and verified by the scans on the path before and after
// it (temporal_verification.h).
#ifndef CARTOGRAPHER_EXT_REPAIR_LOOPS_BY_HAND_H_
#define CARTOGRAPHER_EXT_REPAIR_LOOPS_BY_HAND_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace repair {

struct LoopByHand {
  evaluation::GraphId submap_id, node_id;
  // (submap <- node) as given by the user, metres and radians.
  absl::optional<Pose2> pose;
};

// "submap_trajectory:submap:node_trajectory:node"
std::string ToString(const LoopByHand& loop);

// "submap_trajectory:submap:node_trajectory:node[:x:y:theta]", comma separated.
// An error for malformed names, for ids that are not in the map, for a node
// that was inserted into the submap, for a loop that the map already has, and
// for duplicates.
absl::StatusOr<std::vector<LoopByHand>> ParseLoopsByHand(
    const evaluation::MapGraph& graph, const std::string& names);

struct HandMatchOptions {
  // Thresholds and weights are those of other loops.
  cartographer::mapping::constraints::proto::ConstraintBuilderOptions builder;
  // Half widths of the search around a given pose. Without a pose, the whole
  // submap is searched.
  double linear_window = 1.;              // metres
  double angular_window = DegToRad(20.);  // radians
  // The threshold of loop closure for scores with low variance, in [0, 1].
  double min_temporal_score = loop_closure::DynamicThresholdOptions().low;
  int nodes_to_verify = 10;  // up to the node, and on from it
  double spacing = 0.5;      // metres between them
};

struct HandMatch {
  Pose2 pose;            // (submap <- node), refined
  double score = 0.;     // of the search, mean probability under the points
  double temporal = 0.;  // S_t of the better side
  int num_verified = 0;  // nodes compared there
};

// An error that names the loop if the map lacks the cloud or the grid, if no
// pose reaches the score, or if the scans around the node do not match.
absl::StatusOr<HandMatch> MatchByHand(const LoopByHand& loop,
                                      const evaluation::MapGraph& graph,
                                      const io::Pbstream& pbstream,
                                      const HandMatchOptions& options);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_LOOPS_BY_HAND_H_
