// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A part of the path that a map has lost is solved anew with the rest held: the
// poses of the part are replayed (incremental_smoother.h), and what leads out of it
// leads to places that are known. A wrong group that came before any right loop
// when the whole was replayed now stands against all right ones, and no iteration
// is spent on turning the rest of the map about the place that it had bent.
//
// With the held poses in the frame of one of them, h, an edge z from a held pose q to
// a pose of the part is (h <- q) z with the same information, and an edge z to a held
// pose is z (q <- h), whose error e is Ad(h <- q) e.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_PARTS_PART_REPLAY_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_PARTS_PART_REPLAY_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/parts/lost_part.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Poses from which a part may be replayed: those next to it.
enum class PartSide {
  kBegin,  // forwards, from the pose before it
  kEnd,    // backwards, from the pose after it
};

// The graph of the part alone. Pose 0 is the held one beside it, the poses of the part
// follow in the order of the replay. The part must not reach the end of the path on
// that side.
PoseGraph GraphOfPart(const PoseGraph& graph, const std::vector<Pose2>& poses,
                      const PartOfPath& part, PartSide side);

// Replaces the poses of the part by a replay, and moves the whole so that the first
// pose stays where it is. False, without effect, where the part cannot be replayed
// from that side.
bool ReplayPart(const PoseGraph& graph, const PartOfPath& part, PartSide side,
                const SmootherOptions& options, std::vector<Pose2>* poses);

// Parts that `poses` have lost are replayed and the whole is polished, as long as that
// lowers the truncated cost by more than the gate. `solver` is that of the graph's
// edges. Whether anything was changed.
bool ReplayLostParts(const PoseGraph& graph, const SmootherOptions& options,
                     RobustSolver* solver, std::vector<Pose2>* poses);
// The same for the map of a replay with these options. Its decisions follow.
bool ReplayLostParts(const PoseGraph& graph, const SmootherOptions& options,
                     RobustSolver* solver, ReplayResult* replay);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_PARTS_PART_REPLAY_H_
