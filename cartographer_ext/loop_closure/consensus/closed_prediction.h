// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Predicts a loop over the loops that were accepted after its search: an
// undecided one, which may be accepted then, or an accepted one, which may be
// withdrawn.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_CLOSED_PREDICTION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_CLOSED_PREDICTION_H_

#include <functional>
#include <set>
#include <utility>

#include "absl/types/optional.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace loop_closure {

struct LoopCandidate;
struct LoopOptions;

// The path from the anchor to the node, both of them known.
using PathBetween = std::function<absl::optional<uncertainty::UncertainPose>(
    const uncertainty::VertexId&, const uncertainty::VertexId&)>;
// The paths that do not lead over loops with these ends.
using LoopEnds =
    std::set<std::pair<uncertainty::VertexId, uncertainty::VertexId>>;
using PathsWithout = std::function<PathBetween(const LoopEnds&)>;

// Predicts an undecided candidate within one trajectory again, by a path over
// all loops that are accepted by now. If it predicts the place better than the
// search knew it, and the candidate lies there, returns true and sets
// `closed_sigma` and `innovation`; otherwise the candidate stays as it is.
bool PredictAgain(const LoopOptions& options,
                  const uncertainty::PathUncertainty& paths,
                  const PathBetween& path_between, LoopCandidate* candidate);

// Whether an accepted candidate lies so far from where its search expected it
// that the loops accepted since should be asked.
bool IsFarFromPrediction(const LoopCandidate& candidate);

// Whether a path over other loops contradicts an accepted candidate. If so, its
// `innovation` and `closed_sigma` are those of this path.
bool ContradictsPath(const LoopOptions& options,
                     const uncertainty::PathUncertainty& paths,
                     const PathBetween& path_between, LoopCandidate* candidate);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_CLOSED_PREDICTION_H_
