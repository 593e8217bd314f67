// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From a candidate that the search found to a verdict: the serial part of the
// loop closure, which has all the memory (score windows, mixture, buffered
// candidates) and therefore sees candidates one by one in the order they were
// offered.
//
//   temporal score and threshold -> fusion -> innovation veto
//     -> compatible subset (may wait) -> weights
//
// Each stage can be off. A candidate without a temporal score (short history,
// unknown way) is not rejected for it, but has no more than a neutral score and
// needs the confirmation of others. Each candidate ends as one outcome with its
// record, none is dropped.
//
// The veto asks only the odometry. A loop that contradicts loops accepted
// before is a matter of the subset, where it can still win.
//
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_VERIFIER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_VERIFIER_H_

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"
#include "cartographer_ext/loop_closure/verification/loop_mixture.h"
#include "cartographer_ext/loop_closure/verification/node_history.h"
#include "cartographer_ext/loop_closure/verification/score_fusion.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// What the search found, after the refinement.
struct LoopCandidate {
  uncertainty::SubmapId submap;
  uncertainty::NodeId node;
  int64_t node_time = 0;    // host ticks
  double submap_age = 0.;   // seconds or nodes, as `age_unit` says
  Pose2 submap_local_pose;  // (local frame of its trajectory <- submap)
  // A node of the submap, or the submap itself, for the veto; where absent the
  // node is taken whose local position is nearest to the submap's.
  absl::optional<uncertainty::VertexId> anchor;
  Pose2 refined;  // (submap <- node)
  // The same as the host's constraint wants it, whose frame of a node may be
  // turned against the robot's; only handed through.
  Pose2 constraint_pose;
  double grid_score = 0.;  // S_g
  // Of the refined pose from the scan alone, (submap <- node), metres and
  // radians; zero where it is not known.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  proto::LoopDecision::Search search;  // for the record
  // For the record as well, CPU seconds.
  double search_seconds = 0.;
  double refinement_seconds = 0.;
  // The submap first, then its neighbours; needed during `Process` only.
  std::vector<ReferenceMap> maps;
  // Found without a prediction, or not to be believed for it.
  bool unpredicted = false;
  // The way to older nodes of the run is not to be believed.
  int first_node_index = 0;
};

struct LoopOutcome {
  uncertainty::SubmapId submap;
  uncertainty::NodeId node;
  absl::optional<uncertainty::VertexId> anchor;
  Pose2 submap_local_pose;
  Pose2 pose;                 // (submap <- node)
  Pose2 constraint_pose;      // of the candidate
  ConstraintWeights weights;  // for the constraint when accepted
  // The same as a full matrix, frame of the submap; zero unless it is asked for
  // and known.
  Eigen::Matrix3d full_information = Eigen::Matrix3d::Zero();
  proto::LoopDecision decision;
  bool accepted() const {
    return decision.verdict() == proto::LoopDecision::ACCEPTED;
  }
};

class LoopVerifier {
 public:
  // `stock_weights`: of a loop with the reference score.
  LoopVerifier(const proto::LoopClosureOptions& options,
               const ConstraintWeights& stock_weights);

  LoopVerifier(const LoopVerifier&) = delete;
  LoopVerifier& operator=(const LoopVerifier&) = delete;

  // For every node offered, before any sampler. True when it was new.
  bool AddNode(int trajectory_id, HistoryNode node);
  // For every submap offered; the order of the calls does not matter.
  void AddSubmap(const uncertainty::SubmapId& submap, const Pose2& local_pose);
  bool HasNode(const uncertainty::NodeId& node) const;
  // How `AddNode` wants scans described (DescribeScan).
  const TemporalVerificationOptions& temporal_options() const {
    return temporal_options_;
  }

  // Candidates in the order they were offered: those that the search found, and
  // those that it did not find or that were not searched, with the reason.
  void Process(const LoopCandidate& candidate);
  void Dismiss(const LoopCandidate& candidate,
               proto::LoopDecision::Reason reason);

  // Outcomes that became certain since the last call, in the order of their
  // candidates. `Flush` leaves nothing undecided.
  std::vector<LoopOutcome> Decide();
  std::vector<LoopOutcome> Flush();

  // Loops of nodes of a trajectory up to an index with submaps of another one
  // no longer count; undecided ones with a prediction are rejected.
  void ForgetLoops(int trajectory_id, int submap_trajectory_id,
                   int last_node_index);

  // Rejects what is undecided or not yet handed out for a submap.
  void DeleteSubmap(const uncertainty::SubmapId& submap);
  // The same for nodes of a trajectory up to an index.
  void DeleteNodes(int trajectory_id, int last_node_index);

  int num_undecided() const { return subset_.num_undecided(); }
  // Records of what waits, in candidate order, as UNDECIDED.
  std::vector<proto::LoopDecision> Undecided() const;

  const uncertainty::PathUncertainty& paths() const { return paths_; }

 private:
  LoopOutcome MakeOutcome(const LoopCandidate& candidate);
  // Fills the stages of the record. False: rejected, with the reason.
  bool VerifyScores(const LoopCandidate& candidate, LoopOutcome* outcome);
  bool PassesVeto(const LoopCandidate& candidate, LoopOutcome* outcome) const;
  void Withdraw(const std::function<bool(const LoopOutcome&)>& condition,
                proto::LoopDecision::Reason reason);
  void Settle(const std::vector<SubsetDecision>& decisions);
  std::vector<LoopOutcome> TakeSettled();

  const proto::LoopClosureOptions options_;
  const ConstraintWeights stock_weights_;
  const TemporalVerificationOptions temporal_options_;
  NodeHistory history_;
  // Between nodes and between submaps.
  uncertainty::PathUncertainty paths_;
  DynamicThreshold threshold_;
  ScoreFusion fusion_;
  LoopMixture mixture_;
  CompatibleSubset subset_;
  int64_t next_candidate_ = 0;
  int64_t num_mixture_candidates_ = 0;
  std::map<int64_t, LoopOutcome> waiting_;  // in the subset
  std::map<int64_t, int> tests_waited_;
  std::vector<LoopOutcome> settled_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_VERIFIER_H_
