// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A pair of a submap and a node that might be a loop, from the proposal to the
// verdict. Each stage of loop closure adds its result; results of stages that
// were not reached are empty. Independent of the host.
//
// Poses are (submap <- node) of the host's node frame, which is aligned with
// gravity and does not rotate with the robot. `InTrackingFrame` converts them
// for everything that concerns motion: paths, scans of several nodes, records.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_CANDIDATE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_CANDIDATE_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/candidate_search/search_result.h"
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/consensus/neighbour_odds.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/verification/beam_agreement.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"
#include "cartographer_ext/loop_closure/verification/score_result.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/uncertainty/ids.h"

namespace cartographer_ext {
namespace loop_closure {

// Result of the consensus stage.
struct ConsensusResult {
  SubsetDecision decision;
  int num_tests = 0;   // tests by the subset while the candidate was buffered
  bool exact = false;  // the subset is proven to be the largest
};

// CPU seconds of each stage, with the option log.times only.
struct StageTimes {
  double search = 0.;
  double refinement = 0.;  // with the information of the match
  double temporal = 0.;
  double fusion = 0.;
  double consensus = 0.;
};

// A loop candidate, see above.
struct LoopCandidate {
  using Reason = proto::LoopDecision::Reason;
  using Verdict = proto::LoopDecision::Verdict;

  // --- Proposed by the pose graph, or by relocalisation. ---
  int64_t number = -1;  // in the order of verification
  uncertainty::SubmapId submap;
  uncertainty::NodeId node;
  int64_t node_time = 0;    // host ticks
  Pose2 submap_local_pose;  // (local frame of its trajectory <- submap)
  double submap_age = 0.;   // seconds or nodes, by the option age_unit
  // A node of the submap, or the submap itself, from which paths lead to the
  // node.
  absl::optional<uncertainty::VertexId> anchor;
  // The nodes of its trajectory that may have been inserted into the submap;
  // empty if unknown.
  int first_submap_node = 0;
  int last_submap_node = -1;
  // (submap <- node); none if the whole submap is to be searched.
  absl::optional<Pose2> predicted;
  // (gravity-aligned <- tracking frame) of the node, a rotation.
  Pose2 aligned_from_tracking;
  // Found by relocalisation: without a prediction, or with one that is not
  // trusted.
  bool relocalized = false;
  // The path to nodes of the trajectory before this one is not trusted.
  int first_node_index = 0;

  // --- Candidate search. ---
  SearchPlan plan;
  SearchMatch match;
  // The submap first, then its neighbours, with ownership; needed during
  // verification only.
  std::vector<ReferenceMap> maps;
  std::vector<std::shared_ptr<const OccupancyView>> views;

  // --- Verification. ---
  absl::optional<TemporalScore> temporal;
  absl::optional<ScoreFusionResult> fusion;

  // --- Information of the constraint, where verification was passed. ---
  absl::optional<ConstraintWeights> weights;
  // The same as a full matrix, frame of the submap; zero unless requested and
  // known.
  Eigen::Matrix3d full_information = Eigen::Matrix3d::Zero();

  // --- Consensus. ---
  absl::optional<InnovationResult> innovation;
  // Metres, standard deviation of the prediction over loops that were accepted
  // after the search; where it is set, `innovation` is from this prediction.
  absl::optional<double> closed_sigma;
  absl::optional<FollowedMatch> followed;
  absl::optional<ConsensusResult> consensus;

  // --- The verdict, with the reason for it. ---
  Verdict verdict = proto::LoopDecision::UNDECIDED;
  Reason reason = proto::LoopDecision::NONE;
  StageTimes times;

  bool is_accepted() const { return verdict == proto::LoopDecision::ACCEPTED; }
  bool is_rejected() const { return verdict == proto::LoopDecision::REJECTED; }
  bool is_inter_trajectory() const {
    return submap.trajectory_id != node.trajectory_id;
  }

  void Accept(const Reason why) {
    verdict = proto::LoopDecision::ACCEPTED;
    reason = why;
  }
  void Reject(const Reason why) {
    verdict = proto::LoopDecision::REJECTED;
    reason = why;
  }

  // Centre of search windows, (submap <- node): the prediction; without one
  // (the host predicts a node in some submaps of a map only) the origin of the
  // submap.
  Pose2 SearchCenter() const {
    return predicted.has_value() ? *predicted : Pose2();
  }
  // (submap <- tracking frame of the node) from (submap <- node).
  Pose2 InTrackingFrame(const Pose2& pose) const {
    return pose * aligned_from_tracking;
  }
  Pose2 RefinedInTrackingFrame() const {
    return InTrackingFrame(match.refined);
  }
  // (anchor <- tracking frame of the node) of the refined match, from
  // (local <- anchor).
  Pose2 RefinedFromAnchor(const Pose2& anchor_local_pose) const {
    return Between(anchor_local_pose, submap_local_pose) *
           RefinedInTrackingFrame();
  }
  // S_final if scores were fused, otherwise S_g.
  double FinalScore() const {
    return fusion.has_value() ? fusion->final_score : match.score;
  }
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_LOOP_CANDIDATE_H_
