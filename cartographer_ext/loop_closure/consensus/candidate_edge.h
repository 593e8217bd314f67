// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A matched candidate as a loop between two vertices whose path is known.
//
// Within a trajectory the loop begins at the node of the submap that is nearest
// to where the match was found: what the scan fits was mapped from about there,
// so that is where the path from the first visit to the second begins, and the
// path within the submap, which may be long and bent, does not come in. Between
// trajectories it begins at the submap.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_CANDIDATE_EDGE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_CANDIDATE_EDGE_H_

#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/uncertainty/loop_edge.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// (a <- node), with the covariance of the match.
uncertainty::LoopEdge CandidateEdge(const LoopOptions& options,
                                    const uncertainty::PathUncertainty& paths,
                                    const LoopCandidate& candidate);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_CANDIDATE_EDGE_H_
