// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Verification of a candidate that the search has matched (paper C, optimised
// Cartographer 2025, sections 1.2 and 1.3). Three steps, each of which can be
// disabled:
//
//   temporal score   S_t: do the last N nodes before the candidate's fit the
//                    submap along the path that the robot took (eq. 4 gives N;
//                    temporal_verification.h)?
//   threshold        S_t >= tau, where tau follows the variance of the last
//                    scores (eq. 1 to 3; dynamic_threshold.h).
//   fusion           S_final from S_g and S_t, by the paper's weight lambda
//                    (eq. 5 to 7; score_fusion.h) or as the probability of a
//                    true loop (loop_mixture.h).
//
// A candidate without S_t (too few nodes, a path outside the maps) is not
// rejected for it, but its final score is neutral at best, so that it needs
// confirmation by others.
//
// The steps use the scores of previous candidates, so the result depends on the
// order of the calls. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_VERIFIER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_VERIFIER_H_

#include <cstdint>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"
#include "cartographer_ext/loop_closure/verification/loop_mixture.h"
#include "cartographer_ext/loop_closure/verification/node_history.h"
#include "cartographer_ext/loop_closure/verification/score_fusion.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"

namespace cartographer_ext {
namespace loop_closure {

// Verifies matched candidates, see above.
class ScoreVerifier {
 public:
  explicit ScoreVerifier(const LoopOptions& options);

  // The options by which `history` describes scans (DescribeScan).
  const TemporalVerificationOptions& temporal_options() const {
    return options_.temporal.comparison;
  }

  // Computes S_t and N of eq. 4 into `temporal`.
  void ComputeTemporalScore(const NodeHistory& history,
                            LoopCandidate* candidate) const;
  // Writes tau of eq. 1 to 3 into `temporal`; rejects S_t < tau.
  void TestTemporalScore(LoopCandidate* candidate);
  // Computes S_final of eq. 5 to 7 into `fusion`; rejects if it is too low. To
  // be called for rejected candidates as well, because their scores are used
  // for the fit.
  void FuseScores(LoopCandidate* candidate);
  // S_final of a candidate with its temporal score, without consequences: 0
  // where S_t < tau, empty where there is no S_t.
  absl::optional<double> FinalScore(const LoopCandidate& candidate) const;
  // Adds the scores of a loop that others have confirmed.
  void Learn(const LoopCandidate& accepted);

 private:
  // tau of C eq. 1 to 3.
  double Threshold() const;
  // Whether the path to the node is so short that the match is certainly right.
  bool IsCertain(const LoopCandidate& candidate) const;
  void FuseByLikelihoodRatio(const LoopCandidate& candidate,
                             ScoreFusionResult* result);
  void FuseByLambda(const LoopCandidate& candidate, ScoreFusionResult* result);

  const LoopOptions options_;
  DynamicThreshold threshold_;
  ScoreFusion fusion_;
  LoopMixture mixture_;
  int64_t num_mixture_candidates_ = 0;
};

// The probability that a candidate is true, from its scores, what was searched,
// and how far the match lies from where the search, and the path to the node by
// `innovation`, predicted it. For people and records: the consensus weighs the
// prediction itself. To be called again with another `innovation`.
void EstimateProbability(const SearchPlannerOptions& options,
                         LoopCandidate* candidate);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_VERIFIER_H_
