// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/loop_consensus.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"
#include "cartographer_ext/loop_closure/consensus/neighbour_odds.h"
#include "cartographer_ext/loop_closure/information/loop_information.h"
#include "cartographer_ext/loop_closure/stage_timer.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

LoopDecision::Reason ToReason(const SubsetReason reason) {
  switch (reason) {
    case SubsetReason::kSupported:
      return LoopDecision::CONFIRMED_BY_SUBSET;
    case SubsetReason::kSingleStrong:
      return LoopDecision::SINGLE_STRONG;
    case SubsetReason::kJoinsAccepted:
      return LoopDecision::JOINED_ACCEPTED;
    case SubsetReason::kLikelyAtEnd:
      return LoopDecision::LIKELY_AT_END;
    case SubsetReason::kContradicted:
      return LoopDecision::CONTRADICTED;
    case SubsetReason::kRival:
      return LoopDecision::RIVAL;
    case SubsetReason::kOverturned:
      return LoopDecision::OVERTURNED;
    case SubsetReason::kUnsupported:
      break;
  }
  return LoopDecision::UNSUPPORTED;
}

double PriorSigma(const LoopCandidate& candidate) {
  if (candidate.closed_sigma.has_value()) return *candidate.closed_sigma;
  double sigma = candidate.plan.translation_sigma;
  // With another trajectory zero means that nobody knows.
  if (candidate.is_inter_trajectory() &&
      (sigma == 0. || candidate.relocalized)) {
    sigma = std::numeric_limits<double>::infinity();
  }
  if (!candidate.predicted.has_value() || candidate.relocalized) return sigma;
  const double offset =
      (candidate.InTrackingFrame(*candidate.predicted).translation() -
       candidate.RefinedInTrackingFrame().translation())
          .norm();
  return std::min(sigma, offset);
}

// The literal subset of the paper knows no scores.
bool ScoresAreProbabilities(const LoopOptions& options) {
  return options.fusion.enabled &&
         options.fusion.mode == FusionMode::kLikelihoodRatio &&
         options.compatible_subset.cycle.test !=
             uncertainty::CycleTest::kFixedBound;
}

// A probability after a factor on its odds.
double WithOdds(const double probability, const double odds) {
  return probability * odds / (probability * odds + 1. - probability);
}

// How probable a match can be where so large a share of the verified ones is
// wrong: scores do not tell these from right ones, but they lie anywhere in
// the search, and right ones where they are predicted.
double MostProbable(const LoopCandidate& candidate, const double share_wrong) {
  if (!candidate.fusion.has_value() || candidate.fusion->true_density == 0.) {
    return 1.;
  }
  const double density = candidate.fusion->true_density;
  return density / (density + share_wrong * candidate.fusion->search_density);
}

CompatibleSubsetOptions SubsetOptions(const LoopOptions& options) {
  CompatibleSubsetOptions subset = options.compatible_subset;
  subset.scores_are_probabilities = ScoresAreProbabilities(options);
  return subset;
}

}  // namespace

LoopConsensus::LoopConsensus(const LoopOptions& options,
                             const uncertainty::PathUncertainty* const paths)
    : options_(options),
      paths_(CHECK_NOTNULL(paths)),
      subset_(SubsetOptions(options), paths),
      share_alike_(ShareAlike().Mean()) {}

LoopEvidence LoopConsensus::MakeEvidence(const LoopCandidate& candidate) const {
  LoopEvidence evidence;
  evidence.id = candidate.number;
  evidence.edge = CandidateEdge(options_, *paths_, candidate);
  evidence.anchor = candidate.submap;
  if (candidate.anchor.has_value() &&
      candidate.anchor->IsNodeOf(candidate.node.trajectory_id) &&
      paths_->LocalPose(*candidate.anchor).has_value()) {
    evidence.anchor = *candidate.anchor;
  }
  evidence.score = candidate.FinalScore();
  evidence.is_verified = evidence.score >= kConfirmingScore;
  if (!candidate.plan.full_submap && candidate.plan.linear_window > 0. &&
      !candidate.is_inter_trajectory()) {
    evidence.linear_window = std::max(candidate.plan.linear_window,
                                      options_.search.min_linear_window);
  }
  if (candidate.fusion.has_value()) {
    evidence.probability = candidate.fusion->probability;
    evidence.search_density = candidate.fusion->search_density;
  }
  if (ScoresAreProbabilities(options_) && !candidate.is_inter_trajectory()) {
    const double most = MostProbable(candidate, share_wrong_);
    evidence.score = std::min(evidence.score, most);
    evidence.probability = std::min(evidence.probability, most);
  }
  evidence.prior_sigma = PriorSigma(candidate);
  if (candidate.followed.has_value()) {
    const double odds = OddsOfNeighbours(*candidate.followed, share_alike_);
    evidence.odds_of_neighbours = odds;
    evidence.probability = WithOdds(evidence.probability, odds);
    if (ScoresAreProbabilities(options_)) {
      evidence.score = WithOdds(evidence.score, odds);
    }
  }
  return evidence;
}

void LoopConsensus::Add(LoopCandidate candidate) {
  const LoopEvidence evidence = MakeEvidence(candidate);
  Waiting& waiting = waiting_[candidate.number];
  waiting.candidate = std::move(candidate);
  const StageTimer timer(options_.log_times,
                         &waiting.candidate.times.consensus);
  subset_.Add(evidence);
}

ConsensusResult LoopConsensus::MakeResult(const SubsetDecision& decision,
                                          const Waiting& waiting) const {
  ConsensusResult result;
  result.decision = decision;
  result.num_tests = waiting.num_tests;
  result.exact = subset_.exact();
  return result;
}

std::vector<LoopCandidate> LoopConsensus::Settle(
    const std::vector<SubsetDecision>& decisions) {
  for (auto& entry : waiting_) ++entry.second.num_tests;
  std::vector<LoopCandidate> settled;
  for (const SubsetDecision& decision : decisions) {
    if (decision.withdrawn) {
      settled.push_back(Withdraw(decision));
      continue;
    }
    const auto it = waiting_.find(decision.id);
    CHECK(it != waiting_.end());
    LoopCandidate& candidate = it->second.candidate;
    candidate.consensus = MakeResult(decision, it->second);
    if (decision.accepted) {
      candidate.Accept(ToReason(decision.reason));
      if (!candidate.is_inter_trajectory()) accepted_.insert(*it);
    } else {
      candidate.Reject(ToReason(decision.reason));
    }
    settled.push_back(std::move(candidate));
    waiting_.erase(it);
  }
  PruneAccepted();
  return settled;
}

LoopCandidate LoopConsensus::Withdraw(const SubsetDecision& decision) {
  const auto it = accepted_.find(decision.id);
  CHECK(it != accepted_.end());
  Waiting& waiting = waiting_[decision.id];
  waiting = std::move(it->second);
  accepted_.erase(it);
  LoopCandidate& candidate = waiting.candidate;
  candidate.consensus = MakeResult(decision, waiting);
  candidate.verdict = LoopDecision::UNDECIDED;
  candidate.reason = ToReason(decision.reason);
  return candidate;
}

void LoopConsensus::PruneAccepted() {
  if (subset_.num_accepted_loops() == static_cast<int>(accepted_.size())) {
    return;
  }
  const std::vector<int64_t> kept = subset_.AcceptedLoops();
  for (auto it = accepted_.begin(); it != accepted_.end();) {
    it = std::binary_search(kept.begin(), kept.end(), it->first)
             ? std::next(it)
             : accepted_.erase(it);
  }
}

void LoopConsensus::ForgetAcceptedIf(const Condition& condition) {
  subset_.ForgetAcceptedLoops([&](const LoopEvidence& evidence) {
    const auto it = accepted_.find(evidence.id);
    return it != accepted_.end() && condition(it->second.candidate);
  });
  PruneAccepted();
}

std::vector<LoopCandidate> LoopConsensus::Decide(const RunState state) {
  return Settle(subset_.Decide(state));
}

std::vector<LoopCandidate> LoopConsensus::Flush() {
  return Settle(subset_.Flush());
}

std::vector<LoopCandidate> LoopConsensus::Refute(
    const PathsWithout& paths_without) {
  std::vector<LoopCandidate*> suspects;
  LoopEnds ends;
  for (auto& entry : accepted_) {
    LoopCandidate& candidate = entry.second.candidate;
    if (!IsFarFromPrediction(candidate)) continue;
    suspects.push_back(&candidate);
    const uncertainty::LoopEdge edge =
        CandidateEdge(options_, *paths_, candidate);
    ends.emplace(edge.a, edge.b);
  }
  if (suspects.empty()) return {};
  const PathBetween path_between = paths_without(ends);
  std::vector<int64_t> refuted;
  for (LoopCandidate* const candidate : suspects) {
    if (ContradictsPath(options_, *paths_, path_between, candidate)) {
      refuted.push_back(candidate->number);
    }
  }
  return refuted.empty() ? std::vector<LoopCandidate>()
                         : Settle(subset_.Refute(refuted));
}

std::vector<LoopCandidate> LoopConsensus::WithdrawIf(
    const Condition& condition) {
  std::vector<int64_t> numbers;
  for (const auto& entry : accepted_) {
    if (condition(entry.second.candidate)) numbers.push_back(entry.first);
  }
  return numbers.empty() ? std::vector<LoopCandidate>()
                         : Settle(subset_.Refute(numbers));
}

int LoopConsensus::PredictAgain(const Predict& predict) {
  int num_predicted = 0;
  for (auto& entry : waiting_) {
    LoopCandidate& candidate = entry.second.candidate;
    if (!predict(&candidate)) continue;
    subset_.UpdateEvidence(MakeEvidence(candidate));
    ++num_predicted;
  }
  return num_predicted;
}

void LoopConsensus::SetFollowed(const int64_t number,
                                const FollowedMatch& followed) {
  const auto it = waiting_.find(number);
  if (it == waiting_.end()) return;
  it->second.candidate.followed = followed;
  subset_.UpdateEvidence(MakeEvidence(it->second.candidate));
}

void LoopConsensus::SetShareAlike(const double share_alike) {
  if (share_alike == share_alike_) return;
  share_alike_ = share_alike;
  subset_.SetOddsPerFarRevisit(1. / share_alike);
  UpdateEvidenceIf([](const LoopCandidate& candidate) {
    return candidate.followed.has_value();
  });
}

void LoopConsensus::SetShareWrong(const double share_wrong) {
  // Smaller changes decide nothing.
  if (std::abs(share_wrong - share_wrong_) <= 0.1 * share_wrong_) return;
  share_wrong_ = share_wrong;
  subset_.SetShareWrong(share_wrong);
  UpdateEvidenceIf([](const LoopCandidate&) { return true; });
}

void LoopConsensus::UpdateEvidenceIf(const Condition& condition) {
  for (const auto& entry : waiting_) {
    const LoopCandidate& candidate = entry.second.candidate;
    if (condition(candidate)) subset_.UpdateEvidence(MakeEvidence(candidate));
  }
}

std::vector<LoopCandidate> LoopConsensus::Remove(const Condition& condition) {
  std::vector<LoopCandidate> removed;
  for (const int64_t id : subset_.Remove([&](const LoopEvidence& evidence) {
         const auto it = waiting_.find(evidence.id);
         return it != waiting_.end() && condition(it->second.candidate);
       })) {
    const auto it = waiting_.find(id);
    removed.push_back(std::move(it->second.candidate));
    waiting_.erase(it);
  }
  return removed;
}

void LoopConsensus::ForgetAccepted(const int trajectory_id,
                                   const int submap_trajectory_id,
                                   const int last_node_index) {
  subset_.ForgetAccepted([&](const LoopEvidence& evidence) {
    return evidence.edge.b.IsNodeOf(trajectory_id) &&
           evidence.edge.b.index() <= last_node_index &&
           evidence.edge.a.IsSubmapOf(submap_trajectory_id);
  });
}

std::vector<LoopCandidate> LoopConsensus::Undecided() const {
  std::vector<LoopCandidate> candidates;
  for (const SubsetDecision& decision : subset_.Undecided()) {
    const Waiting& waiting = waiting_.at(decision.id);
    candidates.push_back(waiting.candidate);
    candidates.back().consensus = MakeResult(decision, waiting);
    candidates.back().reason = ToReason(decision.reason);
  }
  return candidates;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
