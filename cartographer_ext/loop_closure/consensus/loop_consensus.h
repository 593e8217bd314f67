// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The last stage of loop closure: candidates are buffered until enough others
// agree with them (paper G, improved graph optimisation 2024, section 3.4, eq.
// 20 and 21; compatible_subset.h). The subset uses of a candidate
//
//   the loop     (anchor <- node) with the covariance of its match,
//   its score    S_final where scores were fused, otherwise S_g,
//   its prior    how well its place was predicted: the standard deviation of
//                the prediction, or, where that is less, how far from the
//                prediction the match was found. Infinity without a prediction.
//                Loops accepted later may predict the place better.
//
// Not thread-safe; candidates are added in the order of their numbers.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_LOOP_CONSENSUS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_LOOP_CONSENSUS_H_

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/closed_prediction.h"
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Buffers candidates until they are decided, see above.
class LoopConsensus {
 public:
  using Condition = std::function<bool(const LoopCandidate&)>;
  // Predicts a candidate again; returns whether it is known better.
  using Predict = std::function<bool(LoopCandidate*)>;

  // `paths` must outlive this object and contain the submaps and nodes of the
  // candidates.
  LoopConsensus(const LoopOptions& options,
                const uncertainty::PathUncertainty* paths);

  void Add(LoopCandidate candidate);

  // Returns the candidates that can be decided now, accepted or rejected, by
  // other rules at the end of a run (compatible_subset.h);
  // `Flush` rejects all that are still undecided. Accepted candidates that
  // contradict the others since are returned again, first and undecided: they
  // are withdrawn, and wait.
  std::vector<LoopCandidate> Decide(RunState state = RunState::kGoesOn);
  std::vector<LoopCandidate> Flush();

  // Withdraws the accepted candidates far from their prediction that the paths
  // over the other loops contradict; they are not accepted again.
  std::vector<LoopCandidate> Refute(const PathsWithout& paths_without);

  // Withdraws the accepted candidates for which the condition holds.
  std::vector<LoopCandidate> WithdrawIf(const Condition& condition);

  // Predicts all undecided candidates again; returns how many are known better.
  int PredictAgain(const Predict& predict);

  // Adds what following an undecided candidate has shown.
  void SetFollowed(int64_t number, const FollowedMatch& followed);
  // The share of wrong places that look like the right one.
  void SetShareAlike(double share_alike);
  // The share of wrong ones among the verified matches of the run.
  void SetShareWrong(double share_wrong);

  // To be called after a change of the drift of `paths`.
  void DriftChanged() { subset_.RelateAll(); }

  // Removes the undecided candidates for which the condition holds.
  std::vector<LoopCandidate> Remove(const Condition& condition);
  // Drops the accepted candidates for which the condition holds; they can no
  // longer be withdrawn.
  void ForgetAcceptedIf(const Condition& condition);
  // Drops the accepted loops between nodes of a trajectory up to an index and
  // submaps of another one.
  void ForgetAccepted(int trajectory_id, int submap_trajectory_id,
                      int last_node_index);

  // The undecided candidates with their reasons, in the order of their numbers.
  std::vector<LoopCandidate> Undecided() const;
  // Verified candidates, as CompatibleSubset.
  int num_right() const { return subset_.num_right(); }
  int NumWrong() const { return subset_.NumWrong(); }
  int num_undecided() const { return subset_.num_undecided(); }

 private:
  struct Waiting {
    LoopCandidate candidate;
    int num_tests = 0;
  };

  LoopEvidence MakeEvidence(const LoopCandidate& candidate) const;
  ConsensusResult MakeResult(const SubsetDecision& decision,
                             const Waiting& waiting) const;
  std::vector<LoopCandidate> Settle(
      const std::vector<SubsetDecision>& decisions);
  // Makes an accepted candidate undecided again, and returns it.
  LoopCandidate Withdraw(const SubsetDecision& decision);
  // Updates the evidence of the undecided candidates for which the condition
  // holds.
  void UpdateEvidenceIf(const Condition& condition);
  // Frees the accepted candidates that can no longer be withdrawn.
  void PruneAccepted();

  const LoopOptions options_;
  const uncertainty::PathUncertainty* const paths_;
  CompatibleSubset subset_;
  std::map<int64_t, Waiting> waiting_;   // by number
  std::map<int64_t, Waiting> accepted_;  // that may be withdrawn
  double share_alike_;
  double share_wrong_ = 0.;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_LOOP_CONSENSUS_H_
