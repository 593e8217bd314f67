// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From a pair of a submap and a node to a loop constraint, or to the reason for
// its rejection. A candidate passes through these stages, each of which can be
// disabled and adds its result to the candidate (loop_candidate.h):
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
// Planning and the stages after the search depend on previous candidates, so
// they process them one by one, in the order of the proposals; only the
// searches run in parallel (dropin/loop_closure_2d.h).
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_PIPELINE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_PIPELINE_H_

#include <cstdint>
#include <deque>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/consensus/closed_prediction.h"
#include "cartographer_ext/loop_closure/consensus/drift_learner.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/consensus/loop_consensus.h"
#include "cartographer_ext/loop_closure/consensus/neighbour_odds.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/information/typical_step.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/verification/node_history.h"
#include "cartographer_ext/loop_closure/verification/score_verifier.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// The stages of loop closure. Not thread-safe.
class LoopPipeline {
 public:
  // `stock_weights`: of a constraint with the reference score.
  LoopPipeline(const LoopOptions& options,
               const ConstraintWeights& stock_weights);

  LoopPipeline(const LoopPipeline&) = delete;
  LoopPipeline& operator=(const LoopPipeline&) = delete;

  // To be called for every proposed node, before any sampler. Returns whether
  // it is new. `error`: see PathUncertainty::Add.
  bool AddNode(int trajectory_id, HistoryNode node,
               const uncertainty::StepError& error = uncertainty::StepError());
  // For every submap proposed; the order of the calls does not matter.
  void AddSubmap(const uncertainty::SubmapId& submap, const Pose2& local_pose);
  bool HasNode(const uncertainty::NodeId& node) const;
  // The options for describing the scans passed to `AddNode` (DescribeScan).
  const TemporalVerificationOptions& temporal_options() const {
    return scores_.temporal_options();
  }
  const uncertainty::PathUncertainty& paths() const { return paths_; }
  const NodeHistory& history() const { return history_; }

  // Processes the next candidate after the search, including skipped and
  // unmatched ones. It is numbered and will be in one result of `Decide` or
  // `Flush`, now or later, and again if it is withdrawn after that.
  void Process(LoopCandidate candidate);

  // Candidates that were accepted or rejected since the last call, in the order
  // of their numbers, and accepted ones of earlier calls that are withdrawn: these
  // are undecided again. `Flush` leaves nothing undecided.
  std::vector<LoopCandidate> Decide(bool at_end = false);
  std::vector<LoopCandidate> Flush();

  // Predicts the undecided candidates again, over the loops accepted since they
  // were searched. Returns whether some of them may be decided now.
  bool PredictAgain(const PathBetween& path_between);

  // As LoopConsensus::Refute. The next `Decide` returns what is withdrawn.
  void Refute(const PathsWithout& paths_without);

  // The final score of a candidate after its search, which has no consequences:
  // 0 if it was not found or fails verification, empty if that is not possible.
  absl::optional<double> Score(LoopCandidate* candidate) const;
  // Adds what following an undecided candidate, known by its number, has shown.
  void SetFollowed(int64_t number, const FollowedMatch& followed);
  int num_wrong_followed() const { return share_alike_.num_wrong(); }
  // Of the verified matches so far, as of the last decision; 0 to 1.
  double share_wrong() const { return share_wrong_; }

  // The undecided candidates with their reasons, in the order of their numbers:
  // they wait for other loops, or for evidence of a larger drift of local SLAM.
  std::vector<LoopCandidate> Undecided() const;
  int num_undecided() const {
    return consensus_.num_undecided() + static_cast<int>(vetoed_.size());
  }
  const DriftLearner& drift() const { return drift_; }

  // Drops the loops between nodes of a trajectory up to an index and submaps of
  // another one, because the trajectory was lost in between. Undecided ones
  // with a prediction are rejected.
  void ForgetLoops(int trajectory_id, int submap_trajectory_id,
                   int last_node_index);
  // Rejects what is undecided or not yet returned for a submap that the pose
  // graph deletes, or for nodes of a trajectory up to an index.
  void DeleteSubmap(const uncertainty::SubmapId& submap);
  void DeleteNodes(int trajectory_id, int last_node_index);
  // Frees the data of a trajectory that the pose graph has deleted.
  void DeleteTrajectory(int trajectory_id);

 private:
  // Rejects undecided candidates, and accepted ones not yet returned.
  void RejectIf(const LoopConsensus::Condition& condition,
                LoopCandidate::Reason reason);
  void Settle(std::vector<LoopCandidate> candidates);
  // Tests the innovation of a verified candidate, with its consequences.
  void Veto(LoopCandidate candidate);
  // Whether a vetoed candidate shows that places look alike.
  bool LooksAlike(const LoopCandidate& candidate) const;
  // Counts what of the verified matches is wrong.
  void UpdateShareWrong();
  // Takes back what the drift estimate does not allow any more.
  void VetoAgain();
  // Updates the drift estimate and everything that depends on it.
  void UpdateDrift();
  std::vector<LoopCandidate> TakeSettled();

  const LoopOptions options_;
  const ConstraintWeights stock_weights_;
  double share_wrong_ = 0.;
  TypicalStep typical_step_;
  NodeHistory history_;
  // Paths between nodes and between submaps.
  uncertainty::PathUncertainty paths_;
  DriftLearner drift_;
  ScoreVerifier scores_;
  LoopConsensus consensus_;
  int64_t num_candidates_ = 0;
  // Candidates that require more drift than estimated, in the order of their
  // numbers.
  std::deque<LoopCandidate> vetoed_;
  std::vector<LoopCandidate> settled_;
  ShareAlike share_alike_;  // of the vetoed candidates that were followed
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_PIPELINE_H_
