// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_pipeline.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/consensus/neighbour_odds.h"
#include "cartographer_ext/loop_closure/information/loop_information.h"

namespace cartographer_ext {
namespace loop_closure {

using proto::LoopDecision;

namespace {

// Candidates that wait for the drift to turn out larger, oldest given up first.
constexpr size_t kMaxVetoed = 2000;
// Right matches that are assumed before any were seen.
constexpr double kPriorRight = 20.;

bool IsEarlier(const LoopCandidate& a, const LoopCandidate& b) {
  return a.number < b.number;
}

}  // namespace

LoopPipeline::LoopPipeline(const LoopOptions& options,
                           const ConstraintWeights& stock_weights)
    : options_(options),
      stock_weights_(stock_weights),
      typical_step_(0.5 * options.path_noise.jump_threshold_metres),
      history_(options.temporal.max_history_nodes),
      paths_(options.path_noise, options.temporal.max_history_nodes),
      drift_(options.path_noise, &paths_),
      scores_(options),
      consensus_(options, &paths_) {}

bool LoopPipeline::AddNode(const int trajectory_id, HistoryNode node,
                           const uncertainty::StepError& error) {
  paths_.Add(uncertainty::NodeId{trajectory_id, node.node_index},
             node.local_pose, error);
  typical_step_.Add(trajectory_id, node.node_index, node.local_pose);
  return history_.Add(trajectory_id, std::move(node));
}

void LoopPipeline::AddSubmap(const uncertainty::SubmapId& submap,
                             const Pose2& local_pose) {
  paths_.Add(submap, local_pose);
}

bool LoopPipeline::HasNode(const uncertainty::NodeId& node) const {
  return history_.Contains(node.trajectory_id, node.node_index);
}

void LoopPipeline::Process(LoopCandidate candidate) {
  candidate.number = num_candidates_++;

  // Candidate search, which ran before: the plan and the grid score S_g.
  if (candidate.plan.skipped != LoopDecision::NONE) {
    candidate.Reject(candidate.plan.skipped);
  } else if (!candidate.match.found && !candidate.is_rejected()) {
    candidate.Reject(LoopDecision::LOW_GRID_SCORE);
  }
  if (!candidate.is_rejected() && options_.slide_test &&
      candidate.match.slide_odds < options_.min_slide_odds) {
    candidate.Reject(LoopDecision::AMBIGUOUS);
  }
  if (candidate.is_rejected()) return Settle({std::move(candidate)});
  AddSubmap(candidate.submap, candidate.submap_local_pose);

  // Verification: S_t (C eq. 4), tau (C eq. 1-3), S_final (C eq. 5-7).
  scores_.ComputeTemporalScore(history_, &candidate);
  scores_.TestTemporalScore(&candidate);
  scores_.FuseScores(&candidate);
  if (candidate.is_rejected()) return Settle({std::move(candidate)});

  candidate.maps.clear();
  candidate.views.clear();

  // Information of the constraint: Omega (C eq. 8-11).
  ConstraintWeights weights = stock_weights_;
  if (options_.information.enabled) {
    const double factor =
        typical_step_.WeightFactor(candidate.node.trajectory_id);
    weights.translation *= factor;
    weights.rotation *= factor;
  }
  WeighConstraint(options_, weights, &candidate);

  // How much local SLAM drifts, whether or not this one turns out right.
  if (!candidate.is_inter_trajectory()) {
    drift_.Add(CandidateEdge(options_, paths_, candidate),
               candidate.plan.linear_window);
  }
  Veto(std::move(candidate));
}

void LoopPipeline::Veto(LoopCandidate candidate) {
  // Could odometry have drifted so far: chi^2 (G section 3.4).
  VetoByInnovation(options_, paths_, &candidate);
  EstimateProbability(options_.search, &candidate);
  if (candidate.is_rejected()) {
    candidate.verdict = LoopDecision::UNDECIDED;
    vetoed_.push_back(std::move(candidate));
    if (vetoed_.size() <= kMaxVetoed) return;
    vetoed_.front().Reject(LoopDecision::INNOVATION_TOO_LARGE);
    Settle({std::move(vetoed_.front())});
    vetoed_.pop_front();
    return;
  }
  // Consensus: the largest compatible subset (G eq. 20, 21) decides, maybe
  // later.
  candidate.reason = LoopDecision::NONE;
  if (options_.compatible_subset.enabled) {
    consensus_.Add(std::move(candidate));
  } else {
    candidate.Accept(LoopDecision::ALL_STAGES_PASSED);
    Settle({std::move(candidate)});
  }
}

void LoopPipeline::Settle(std::vector<LoopCandidate> candidates) {
  std::move(candidates.begin(), candidates.end(), std::back_inserter(settled_));
}

std::vector<LoopCandidate> LoopPipeline::TakeSettled() {
  std::vector<LoopCandidate> candidates = std::move(settled_);
  settled_.clear();
  std::stable_sort(candidates.begin(), candidates.end(), IsEarlier);
  return candidates;
}

void LoopPipeline::VetoAgain() {
  if (!options_.innovation_veto.enabled) return;
  const auto is_vetoed = [&](const LoopCandidate& candidate) {
    const absl::optional<InnovationResult> innovation =
        InnovationByPath(options_, paths_, candidate);
    return innovation.has_value() && innovation->vetoed;
  };
  Settle(consensus_.WithdrawIf(is_vetoed));
  std::vector<LoopCandidate> removed = consensus_.Remove(is_vetoed);
  std::move(removed.begin(), removed.end(), std::back_inserter(vetoed_));
  std::sort(vetoed_.begin(), vetoed_.end(), IsEarlier);
}

void LoopPipeline::UpdateDrift() {
  if (!drift_.Update(share_wrong_)) return;
  consensus_.DriftChanged();
  VetoAgain();
  std::deque<LoopCandidate> vetoed;
  vetoed.swap(vetoed_);
  for (LoopCandidate& candidate : vetoed) Veto(std::move(candidate));
}

bool LoopPipeline::LooksAlike(const LoopCandidate& candidate) const {
  // What merely matches, but not where its neighbours should, is no place that
  // looks alike.
  return candidate.FinalScore() >= kConfirmingScore &&
         (!candidate.followed.has_value() ||
          OddsOfNeighbours(*candidate.followed, share_alike_.Mean()) >= 1.);
}

void LoopPipeline::UpdateShareWrong() {
  const auto num_vetoed =
      std::count_if(vetoed_.begin(), vetoed_.end(), [&](const auto& candidate) {
        return !candidate.plan.full_submap && LooksAlike(candidate);
      });
  const double num_wrong =
      static_cast<double>(num_vetoed) + consensus_.NumWrong();
  share_wrong_ = num_wrong / (num_wrong + consensus_.num_right() + kPriorRight);
  consensus_.SetShareWrong(share_wrong_);
}

std::vector<LoopCandidate> LoopPipeline::Decide(const bool at_end) {
  UpdateDrift();
  UpdateShareWrong();
  RunState state = RunState::kGoesOn;
  if (at_end) {
    const bool any_wrong = std::any_of(
        vetoed_.begin(), vetoed_.end(),
        [&](const auto& candidate) { return LooksAlike(candidate); });
    state = any_wrong ? RunState::kEnds : RunState::kEndsUnalike;
  }
  std::vector<LoopCandidate> decided = consensus_.Decide(state);
  for (const LoopCandidate& candidate : decided) {
    if (candidate.is_accepted()) scores_.Learn(candidate);
  }
  Settle(std::move(decided));
  return TakeSettled();
}

std::vector<LoopCandidate> LoopPipeline::Flush() {
  UpdateDrift();
  for (LoopCandidate& candidate : vetoed_) {
    candidate.Reject(LoopDecision::INNOVATION_TOO_LARGE);
    Settle({std::move(candidate)});
  }
  vetoed_.clear();
  Settle(consensus_.Flush());
  return TakeSettled();
}

bool LoopPipeline::PredictAgain(const PathBetween& path_between) {
  if (!options_.search.enabled || !options_.innovation_veto.enabled ||
      !options_.compatible_subset.single_strong_enabled) {
    return false;
  }
  return consensus_.PredictAgain([&](LoopCandidate* const candidate) {
    if (!loop_closure::PredictAgain(options_, paths_, path_between,
                                    candidate)) {
      return false;
    }
    EstimateProbability(options_.search, candidate);
    return true;
  }) > 0;
}

void LoopPipeline::Refute(const PathsWithout& paths_without) {
  if (!options_.innovation_veto.enabled ||
      !options_.compatible_subset.single_strong_enabled) {
    return;
  }
  Settle(consensus_.Refute(paths_without));
}

absl::optional<double> LoopPipeline::Score(
    LoopCandidate* const candidate) const {
  if (!candidate->match.found) return 0.;
  scores_.ComputeTemporalScore(history_, candidate);
  return scores_.FinalScore(*candidate);
}

void LoopPipeline::SetFollowed(const int64_t number,
                               const FollowedMatch& followed) {
  consensus_.SetFollowed(number, followed);
  for (LoopCandidate& candidate : vetoed_) {
    if (candidate.number != number) continue;
    candidate.followed = followed;
    // Local SLAM does not drift so far: a wrong match.
    share_alike_.AddWrong(followed);
    consensus_.SetShareAlike(share_alike_.Mean());
  }
}

std::vector<LoopCandidate> LoopPipeline::Undecided() const {
  std::vector<LoopCandidate> candidates = consensus_.Undecided();
  candidates.insert(candidates.end(), vetoed_.begin(), vetoed_.end());
  std::sort(candidates.begin(), candidates.end(), IsEarlier);
  return candidates;
}

void LoopPipeline::RejectIf(const LoopConsensus::Condition& condition,
                            const LoopCandidate::Reason reason) {
  // The consensus may have decided some already, to stay within its bounds.
  Settle(consensus_.Decide());
  for (LoopCandidate& candidate : settled_) {
    if (candidate.is_accepted() && condition(candidate)) {
      candidate.Reject(reason);
    }
  }
  consensus_.ForgetAcceptedIf(condition);
  std::vector<LoopCandidate> removed = consensus_.Remove(condition);
  const auto kept = std::stable_partition(
      vetoed_.begin(), vetoed_.end(),
      [&](const LoopCandidate& candidate) { return !condition(candidate); });
  std::move(kept, vetoed_.end(), std::back_inserter(removed));
  vetoed_.erase(kept, vetoed_.end());
  for (LoopCandidate& candidate : removed) candidate.Reject(reason);
  Settle(std::move(removed));
}

void LoopPipeline::ForgetLoops(const int trajectory_id,
                               const int submap_trajectory_id,
                               const int last_node_index) {
  RejectIf(
      [&](const LoopCandidate& candidate) {
        return candidate.node.trajectory_id == trajectory_id &&
               candidate.submap.trajectory_id == submap_trajectory_id &&
               candidate.node.node_index <= last_node_index &&
               !candidate.plan.full_submap;
      },
      LoopDecision::STALE);
  consensus_.ForgetAccepted(trajectory_id, submap_trajectory_id,
                            last_node_index);
}

void LoopPipeline::DeleteSubmap(const uncertainty::SubmapId& submap) {
  RejectIf([&](const LoopCandidate& c) { return c.submap == submap; },
           LoopDecision::SUBMAP_DELETED);
}

void LoopPipeline::DeleteNodes(const int trajectory_id,
                               const int last_node_index) {
  RejectIf(
      [&](const LoopCandidate& candidate) {
        return candidate.node.trajectory_id == trajectory_id &&
               candidate.node.node_index <= last_node_index;
      },
      LoopDecision::NODE_DELETED);
}

void LoopPipeline::DeleteTrajectory(const int trajectory_id) {
  history_.DeleteTrajectory(trajectory_id);
  drift_.DeleteTrajectory(trajectory_id);
  paths_.DeleteTrajectory(trajectory_id);
  typical_step_.DeleteTrajectory(trajectory_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
