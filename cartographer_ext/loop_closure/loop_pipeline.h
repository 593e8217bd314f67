// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From a pair of a submap and a node to a loop constraint, or to the reason why
// it is none. A candidate passes these stages, each of which can be off and
// adds its result to the candidate (loop_candidate.h):
//
//   stage              question                                      papers
//   candidate_search/  Is the pair worth a search, and how wide?     -
//                      Where does the scan fit the submap: S_g
//   verification/      Do the scans before it fit along the path     C eq. 4
//                      that the robot took: S_t
//                      Is S_t above the threshold tau                C eq. 1-3
//                      How likely is the loop after both: S_final    C eq. 5-7
//   consensus/         Could odometry have drifted so far: chi^2     G sec. 3.4
//   information/       How certain is the constraint: Omega          C eq. 8-11
//   consensus/         Do enough other loops agree with it           G eq. 20,
//   21
//
// C is the paper on optimised Cartographer (2025), G that on improved graph
// optimisation (2024); third_party_notes/ lists where we deviate from them.
// LoopPipeline::Process is the table as code.
//
// Planning and the stages after the search remember the candidates before, so
// they see them one by one, in the order of the proposals; only the searches
// run in parallel (dropin/loop_closure_2d.h).
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_PIPELINE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_PIPELINE_H_

#include <cstdint>
#include <deque>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/consensus/drift_learner.h"
#include "cartographer_ext/loop_closure/consensus/loop_consensus.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/verification/node_history.h"
#include "cartographer_ext/loop_closure/verification/score_verifier.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Not thread-safe.
class LoopPipeline {
 public:
  // `stock_weights`: of a constraint with the reference score.
  LoopPipeline(const LoopOptions& options,
               const ConstraintWeights& stock_weights);

  LoopPipeline(const LoopPipeline&) = delete;
  LoopPipeline& operator=(const LoopPipeline&) = delete;

  // For every node proposed, before any sampler. True when it was new.
  bool AddNode(int trajectory_id, HistoryNode node);
  // For every submap proposed; the order of the calls does not matter.
  void AddSubmap(const uncertainty::SubmapId& submap, const Pose2& local_pose);
  bool HasNode(const uncertainty::NodeId& node) const;
  // How `AddNode` wants scans described (DescribeScan).
  const TemporalVerificationOptions& temporal_options() const {
    return scores_.temporal_options();
  }
  const uncertainty::PathUncertainty& paths() const { return paths_; }

  // The next candidate after the search, also one that was skipped or not
  // matched. It is numbered and ends, now or later, in exactly one result of
  // `Decide` or `Flush`.
  void Process(LoopCandidate candidate);

  // Candidates that were accepted or rejected since the last call, in the order
  // of their numbers. `Flush` leaves nothing undecided.
  std::vector<LoopCandidate> Decide();
  std::vector<LoopCandidate> Flush();

  // What waits and why, in the order of the numbers: for other loops, or for
  // evidence that local SLAM drifts more than is known.
  std::vector<LoopCandidate> Undecided() const;
  int num_undecided() const {
    return consensus_.num_undecided() + static_cast<int>(vetoed_.size());
  }
  const DriftLearner& drift() const { return drift_; }

  // Loops of nodes of a trajectory up to an index with submaps of another one
  // no longer count: the trajectory was lost in between. Undecided ones with a
  // prediction are rejected.
  void ForgetLoops(int trajectory_id, int submap_trajectory_id,
                   int last_node_index);
  // Rejects what is undecided or not yet returned for a submap that the pose
  // graph deletes, or for nodes of a trajectory up to an index.
  void DeleteSubmap(const uncertainty::SubmapId& submap);
  void DeleteNodes(int trajectory_id, int last_node_index);
  // Frees what is remembered of a trajectory that the pose graph has deleted.
  void DeleteTrajectory(int trajectory_id);

 private:
  // Rejects undecided candidates, and accepted ones not yet returned.
  void RejectIf(const LoopConsensus::Condition& condition,
                LoopCandidate::Reason reason);
  void Settle(std::vector<LoopCandidate> candidates);
  // The innovation of a candidate that was verified, and what follows.
  void Veto(LoopCandidate candidate);
  // What was learnt of the drift, with all that depends on it.
  void UpdateDrift();
  std::vector<LoopCandidate> TakeSettled();

  const LoopOptions options_;
  const ConstraintWeights stock_weights_;
  NodeHistory history_;
  // Between nodes and between submaps.
  uncertainty::PathUncertainty paths_;
  DriftLearner drift_;
  ScoreVerifier scores_;
  LoopConsensus consensus_;
  int64_t num_candidates_ = 0;
  // Demand more drift than is known, in the order of their numbers.
  std::deque<LoopCandidate> vetoed_;
  std::vector<LoopCandidate> settled_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_PIPELINE_H_
