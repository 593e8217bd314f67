// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/information/loop_information.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// The vertex at which the path to the node begins, empty where none is known.
absl::optional<uncertainty::VertexId> BeginOfPath(
    const uncertainty::PathUncertainty& paths, const LoopCandidate& candidate) {
  if (candidate.is_inter_trajectory()) return absl::nullopt;
  if (candidate.anchor.has_value() && candidate.last_submap_node >= 0) {
    const Pose2 matched =
        candidate.submap_local_pose * candidate.RefinedInTrackingFrame();
    const absl::optional<uncertainty::NodeId> nearest =
        paths.Nearest(candidate.submap.trajectory_id, matched.translation(),
                      candidate.first_submap_node, candidate.last_submap_node);
    if (nearest.has_value()) return uncertainty::VertexId(*nearest);
  }
  return candidate.anchor;
}

}  // namespace

uncertainty::LoopEdge CandidateEdge(const LoopOptions& options,
                                    const uncertainty::PathUncertainty& paths,
                                    const LoopCandidate& candidate) {
  uncertainty::LoopEdge edge;
  edge.a = candidate.submap;
  edge.b = candidate.node;
  edge.pose.pose = candidate.RefinedInTrackingFrame();
  // Within a trajectory the path runs along the nodes, which know about jumps.
  const absl::optional<uncertainty::VertexId> begin =
      BeginOfPath(paths, candidate);
  if (begin.has_value() && begin->IsNodeOf(candidate.node.trajectory_id)) {
    const absl::optional<Pose2> begin_pose = paths.LocalPose(*begin);
    if (begin_pose.has_value()) {
      edge.a = *begin;
      edge.pose.pose = candidate.RefinedFromAnchor(*begin_pose);
    }
  }
  edge.pose.covariance = MatchCovariance(options, candidate);
  return edge;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
