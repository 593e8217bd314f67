// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_verifier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/verification/dtw.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using FusionOptions = proto::LoopClosureOptions::Fusion;

// The mixture is fitted once in so many candidates; it moves slowly.
constexpr int64_t kFitInterval = 10;
// Nodes looked at to find one node of the query.
constexpr int kScanPerNode = 50;
// Probability of a candidate about which nothing is known.
constexpr double kNeutralScore = 0.5;

void ToProto(const MixtureComponent& from,
             LoopDecision::MixtureComponent* const to) {
  to->set_weight(from.weight);
  to->set_mean_grid(from.mean.x());
  to->set_mean_temporal(from.mean.y());
  to->set_variance_grid(from.covariance(0, 0));
  to->set_covariance(from.covariance(0, 1));
  to->set_variance_temporal(from.covariance(1, 1));
}

LoopDecision::Temporal::Outcome ToProto(const TemporalOutcome outcome) {
  switch (outcome) {
    case TemporalOutcome::kScored:
      return LoopDecision::Temporal::SCORED;
    case TemporalOutcome::kShortHistory:
      return LoopDecision::Temporal::SHORT_HISTORY;
    case TemporalOutcome::kUnknownWay:
      break;
  }
  return LoopDecision::Temporal::UNKNOWN_WAY;
}

LoopDecision::Reason ToProto(const SubsetReason reason) {
  switch (reason) {
    case SubsetReason::kSupported:
      return LoopDecision::CONFIRMED_BY_SUBSET;
    case SubsetReason::kSingleStrong:
      return LoopDecision::SINGLE_STRONG;
    case SubsetReason::kJoinsAccepted:
      return LoopDecision::JOINED_ACCEPTED;
    case SubsetReason::kContradicted:
      return LoopDecision::CONTRADICTED;
    case SubsetReason::kRival:
      return LoopDecision::RIVAL;
    case SubsetReason::kUnsupported:
      break;
  }
  return LoopDecision::UNSUPPORTED;
}

// Neighbouring points of a scan and neighbouring cells of a grid err together:
// a match knows about as much as so much fewer points would.
constexpr double kCorrelatedPoints = 25.;
// No match is less certain than this, metres and radians: one along a corridor
// still sees doors go by.
constexpr double kLeastCertainTranslation = 0.3;
constexpr double kLeastCertainRotation = 0.1;

// What the match leaves open, such as the way along a corridor; frame of the
// submap. Zero where nothing is known about it.
Eigen::Matrix3d OpenCovariance(const LoopCandidate& candidate) {
  if (candidate.information.isZero(0.) || !candidate.information.allFinite()) {
    return Eigen::Matrix3d::Zero();
  }
  const Eigen::Vector3d least(
      1. / (kLeastCertainTranslation * kLeastCertainTranslation),
      1. / (kLeastCertainTranslation * kLeastCertainTranslation),
      1. / (kLeastCertainRotation * kLeastCertainRotation));
  Eigen::Matrix3d information = candidate.information / kCorrelatedPoints;
  information.diagonal() += least;
  return information.inverse();
}

// Of the loop itself, frame of the node: the constant part of the options, and
// what the match leaves open.
Eigen::Matrix3d MatchCovariance(const Eigen::Matrix3d& constant,
                                const LoopCandidate& candidate) {
  const Eigen::Matrix3d rotation = PlanarRotation(candidate.refined.theta);
  return constant + rotation.transpose() * OpenCovariance(candidate) * rotation;
}

// How well the search knew where to look: by the uncertainty of the way, or
// because it found the place right there.
double PriorSigma(const LoopCandidate& candidate) {
  const LoopDecision::Search& search = candidate.search;
  const bool is_foreign =
      candidate.submap.trajectory_id != candidate.node.trajectory_id;
  double sigma = search.prior_translation_sigma();
  // In another run zero means that nobody knows.
  if (is_foreign && (sigma == 0. || candidate.unpredicted)) {
    sigma = std::numeric_limits<double>::infinity();
  }
  if (!search.has_predicted() || candidate.unpredicted) return sigma;
  const double offset =
      (Eigen::Vector2d(search.predicted().x(), search.predicted().y()) -
       candidate.refined.translation())
          .norm();
  return std::min(sigma, offset);
}

// Adds the CPU time that passes while it exists, where times are asked for.
class Timer {
 public:
  using Setter = void (LoopDecision::Times::*)(double);
  Timer(const proto::LoopClosureOptions& options, LoopDecision* const decision,
        const Setter setter)
      : decision_(options.log().times() ? decision : nullptr),
        setter_(setter),
        start_(decision_ == nullptr ? 0. : ThreadCpuSeconds()) {}
  ~Timer() {
    if (decision_ == nullptr) return;
    (decision_->mutable_times()->*setter_)(ThreadCpuSeconds() - start_);
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  LoopDecision* const decision_;
  const Setter setter_;
  const double start_;
};

bool Reject(const LoopDecision::Reason reason, LoopOutcome* const outcome) {
  outcome->decision.set_verdict(LoopDecision::REJECTED);
  outcome->decision.set_reason(reason);
  return false;
}

}  // namespace

LoopVerifier::LoopVerifier(const proto::LoopClosureOptions& options,
                           const ConstraintWeights& stock_weights)
    : options_(options),
      stock_weights_(stock_weights),
      temporal_options_(ToTemporalVerificationOptions(options)),
      history_(options.temporal_verification().max_history_nodes()),
      paths_(ToPathNoiseOptions(options),
             options.temporal_verification().max_history_nodes()),
      threshold_(ToDynamicThresholdOptions(options)),
      fusion_(ToScoreFusionOptions(options)),
      mixture_(ToLoopMixtureOptions(options)),
      subset_(ToCompatibleSubsetOptions(options), &paths_) {}

bool LoopVerifier::AddNode(const int trajectory_id, HistoryNode node) {
  paths_.Add(uncertainty::NodeId{trajectory_id, node.node_index},
             node.local_pose);
  return history_.Add(trajectory_id, std::move(node));
}

void LoopVerifier::AddSubmap(const uncertainty::SubmapId& submap,
                             const Pose2& local_pose) {
  paths_.Add(submap, local_pose);
}

bool LoopVerifier::HasNode(const uncertainty::NodeId& node) const {
  return history_.Contains(node.trajectory_id, node.node_index);
}

bool LoopVerifier::VerifyScores(const LoopCandidate& candidate,
                                LoopOutcome* const outcome) {
  LoopDecision& decision = outcome->decision;
  bool scored = false;
  bool below_threshold = false;
  double temporal_score = 0.;
  if (options_.temporal_verification().enabled()) {
    const Timer timer(options_, &decision,
                      &LoopDecision::Times::set_temporal_seconds);
    const int window =
        VariableWindow(ToVariableWindowOptions(options_), candidate.submap_age);
    std::vector<const HistoryNode*> sequence = history_.Sequence(
        candidate.node.trajectory_id, candidate.node.node_index, window,
        options_.temporal_verification().spacing(), kScanPerNode * window);
    sequence.erase(sequence.begin(),
                   std::find_if(sequence.begin(), sequence.end(),
                                [&](const HistoryNode* const node) {
                                  return node->node_index >=
                                         candidate.first_node_index;
                                }));
    const TemporalResult result = VerifySequence(
        temporal_options_, sequence, candidate.refined, candidate.maps);
    const double threshold =
        options_.dynamic_threshold().enabled()
            ? threshold_.Current()
            : options_.dynamic_threshold().base_threshold();
    LoopDecision::Temporal& record = *decision.mutable_temporal();
    record.set_outcome(ToProto(result.outcome));
    record.set_window(window);
    record.set_num_query(result.num_query);
    record.set_num_reference(result.num_reference);
    record.set_travelled(result.travelled);
    record.set_threshold(threshold);
    record.set_score_variance(threshold_.Variance());
    scored = result.outcome == TemporalOutcome::kScored;
    if (scored) {
      temporal_score = result.score;
      record.set_score(temporal_score);
      below_threshold = temporal_score < threshold;
      threshold_.AddScore(temporal_score);
    }
  }

  double final_score = candidate.grid_score;
  if (options_.fusion().enabled()) {
    const Timer timer(options_, &decision,
                      &LoopDecision::Times::set_fusion_seconds);
    LoopDecision::Fusion& record = *decision.mutable_fusion();
    if (options_.fusion().mode() == FusionOptions::LIKELIHOOD_RATIO) {
      ToProto(mixture_.components()[0], record.mutable_false_loops());
      ToProto(mixture_.components()[1], record.mutable_true_loops());
      final_score = kNeutralScore;
      if (scored) {
        final_score =
            mixture_.ProbabilityTrue(candidate.grid_score, temporal_score);
        mixture_.Add(candidate.grid_score, temporal_score);
        if (++num_mixture_candidates_ % kFitInterval == 0) mixture_.Fit();
      }
    } else if (scored) {
      const FusedScore fused =
          fusion_.Fuse(candidate.grid_score, temporal_score);
      fusion_.AddScores(candidate.grid_score, temporal_score);
      record.set_lambda(fused.lambda);
      final_score = fused.score;
    } else {
      final_score = std::min(candidate.grid_score, kNeutralScore);
    }
    record.set_final_score(final_score);
  }
  outcome->weights = stock_weights_;
  if (options_.information().enabled()) {
    outcome->weights = ConfidenceWeights(ToConfidenceWeightOptions(options_),
                                         stock_weights_, final_score);
  }
  // All memory has been updated, now the verdicts.
  if (below_threshold) return Reject(LoopDecision::LOW_TEMPORAL_SCORE, outcome);
  // A candidate that could not be scored is left to the later stages.
  const bool judged = scored || !options_.temporal_verification().enabled();
  if (options_.fusion().enabled() && judged &&
      final_score < options_.fusion().min_final_score()) {
    return Reject(LoopDecision::LOW_FINAL_SCORE, outcome);
  }
  return true;
}

bool LoopVerifier::PassesVeto(const LoopCandidate& candidate,
                              LoopOutcome* const outcome) const {
  if (!options_.innovation_veto().enabled() ||
      candidate.submap.trajectory_id != candidate.node.trajectory_id) {
    return true;
  }
  const auto anchor =
      candidate.anchor.has_value()
          ? candidate.anchor
          : paths_.Nearest(candidate.submap.trajectory_id,
                           candidate.submap_local_pose.translation());
  if (!anchor.has_value()) return true;
  const auto prior = paths_.Between(*anchor, candidate.node);
  if (!prior.has_value()) return true;
  uncertainty::UncertainPose loop;
  loop.pose = Between(*paths_.LocalPose(*anchor), candidate.submap_local_pose) *
              candidate.refined;
  loop.covariance = MatchCovariance(LoopCovariance(options_), candidate);
  const InnovationResult result =
      TestInnovation(ToInnovationOptions(options_), *prior, loop);
  LoopDecision::Innovation& record = *outcome->decision.mutable_innovation();
  record.mutable_pose()->set_x(result.innovation.x);
  record.mutable_pose()->set_y(result.innovation.y);
  record.mutable_pose()->set_theta(result.innovation.theta);
  record.set_chi_square(result.chi_square);
  record.set_bound(options_.innovation_veto().chi_square_bound());
  return !result.vetoed || Reject(LoopDecision::INNOVATION_TOO_LARGE, outcome);
}

LoopOutcome LoopVerifier::MakeOutcome(const LoopCandidate& candidate) {
  LoopOutcome outcome;
  outcome.submap = candidate.submap;
  outcome.node = candidate.node;
  outcome.anchor = candidate.anchor;
  outcome.submap_local_pose = candidate.submap_local_pose;
  outcome.pose = candidate.refined;
  outcome.constraint_pose = candidate.constraint_pose;
  LoopDecision& decision = outcome.decision;
  decision.set_candidate(next_candidate_++);
  decision.set_submap_trajectory_id(candidate.submap.trajectory_id);
  decision.set_submap_index(candidate.submap.submap_index);
  decision.set_node_trajectory_id(candidate.node.trajectory_id);
  decision.set_node_index(candidate.node.node_index);
  decision.set_node_time(candidate.node_time);
  *decision.mutable_search() = candidate.search;
  if (options_.log().times()) {
    decision.mutable_times()->set_search_seconds(candidate.search_seconds);
    decision.mutable_times()->set_refinement_seconds(
        candidate.refinement_seconds);
  }
  return outcome;
}

void LoopVerifier::Dismiss(const LoopCandidate& candidate,
                           const LoopDecision::Reason reason) {
  LoopOutcome outcome = MakeOutcome(candidate);
  Reject(reason, &outcome);
  settled_.push_back(std::move(outcome));
}

void LoopVerifier::Process(const LoopCandidate& candidate) {
  paths_.Add(candidate.submap, candidate.submap_local_pose);
  LoopOutcome outcome = MakeOutcome(candidate);
  LoopDecision& decision = outcome.decision;
  const int64_t number = decision.candidate();
  decision.mutable_search()->set_grid_score(candidate.grid_score);

  if (!VerifyScores(candidate, &outcome) || !PassesVeto(candidate, &outcome)) {
    settled_.push_back(std::move(outcome));
    return;
  }
  decision.mutable_information()->set_translation_weight(
      outcome.weights.translation);
  decision.mutable_information()->set_rotation_weight(outcome.weights.rotation);
  if (!candidate.information.isZero(0.)) {
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        decision.mutable_information()->add_matrix(candidate.information(i, j));
      }
    }
  }
  if (options_.information().full_matrix() &&
      !candidate.information.isZero(0.)) {
    const Eigen::Matrix3d certain = LoopCovariance(options_);
    outcome.full_information = FullInformation(
        outcome.weights, certain, certain + OpenCovariance(candidate));
  }
  if (!options_.compatible_subset().enabled()) {
    decision.set_verdict(LoopDecision::ACCEPTED);
    decision.set_reason(LoopDecision::ALL_STAGES_PASSED);
    settled_.push_back(std::move(outcome));
    return;
  }
  LoopEvidence evidence;
  evidence.id = number;
  evidence.edge.a = candidate.submap;
  evidence.edge.b = candidate.node;
  evidence.edge.pose.pose = candidate.refined;
  // Within a trajectory the way runs along the nodes, which know about jumps.
  if (candidate.anchor.has_value() &&
      candidate.anchor->IsNodeOf(candidate.node.trajectory_id)) {
    const auto anchor_pose = paths_.LocalPose(*candidate.anchor);
    if (anchor_pose.has_value()) {
      evidence.edge.a = *candidate.anchor;
      evidence.edge.pose.pose =
          Between(*anchor_pose, candidate.submap_local_pose) *
          candidate.refined;
    }
  }
  evidence.edge.pose.covariance =
      MatchCovariance(LoopCovariance(options_), candidate);
  evidence.score = decision.has_fusion() ? decision.fusion().final_score()
                                         : candidate.grid_score;
  evidence.prior_sigma = PriorSigma(candidate);
  LoopOutcome& waiting =
      waiting_.emplace(number, std::move(outcome)).first->second;
  tests_waited_[number] = 0;
  const Timer timer(options_, &waiting.decision,
                    &LoopDecision::Times::set_subset_seconds);
  subset_.Add(evidence);
}

void LoopVerifier::Settle(const std::vector<SubsetDecision>& decisions) {
  for (auto& waited : tests_waited_) ++waited.second;
  for (const SubsetDecision& from : decisions) {
    const auto it = waiting_.find(from.id);
    CHECK(it != waiting_.end());
    LoopDecision& decision = it->second.decision;
    decision.set_verdict(from.accepted ? LoopDecision::ACCEPTED
                                       : LoopDecision::REJECTED);
    decision.set_reason(ToProto(from.reason));
    LoopDecision::Subset& record = *decision.mutable_subset();
    record.set_support(from.support);
    record.set_contradictions(from.contradictions);
    record.set_subset_size(from.subset_size);
    record.set_num_tests(tests_waited_[from.id]);
    record.set_exact(subset_.exact());
    settled_.push_back(std::move(it->second));
    waiting_.erase(it);
    tests_waited_.erase(from.id);
  }
}

std::vector<LoopOutcome> LoopVerifier::TakeSettled() {
  std::vector<LoopOutcome> outcomes = std::move(settled_);
  settled_.clear();
  std::sort(outcomes.begin(), outcomes.end(),
            [](const LoopOutcome& a, const LoopOutcome& b) {
              return a.decision.candidate() < b.decision.candidate();
            });
  return outcomes;
}

std::vector<LoopDecision> LoopVerifier::Undecided() const {
  std::vector<LoopDecision> decisions;
  for (const SubsetDecision& from : subset_.Undecided()) {
    decisions.push_back(waiting_.at(from.id).decision);
    LoopDecision& decision = decisions.back();
    decision.set_verdict(LoopDecision::UNDECIDED);
    decision.set_reason(ToProto(from.reason));
    LoopDecision::Subset& record = *decision.mutable_subset();
    record.set_support(from.support);
    record.set_contradictions(from.contradictions);
    record.set_subset_size(from.subset_size);
    record.set_num_tests(tests_waited_.at(from.id));
    record.set_exact(subset_.exact());
  }
  return decisions;
}

std::vector<LoopOutcome> LoopVerifier::Decide() {
  Settle(subset_.Decide());
  return TakeSettled();
}

std::vector<LoopOutcome> LoopVerifier::Flush() {
  Settle(subset_.Flush());
  return TakeSettled();
}

void LoopVerifier::Withdraw(
    const std::function<bool(const LoopOutcome&)>& condition,
    const LoopDecision::Reason reason) {
  // The subset may have decided some already, to stay within its bounds.
  Settle(subset_.Decide());
  for (LoopOutcome& outcome : settled_) {
    if (outcome.accepted() && condition(outcome)) Reject(reason, &outcome);
  }
  for (const int64_t id : subset_.Withdraw([&](const LoopEvidence& evidence) {
         const auto it = waiting_.find(evidence.id);
         return it != waiting_.end() && condition(it->second);
       })) {
    const auto it = waiting_.find(id);
    Reject(reason, &it->second);
    settled_.push_back(std::move(it->second));
    waiting_.erase(it);
    tests_waited_.erase(id);
  }
}

void LoopVerifier::ForgetLoops(const int trajectory_id,
                               const int submap_trajectory_id,
                               const int last_node_index) {
  Withdraw(
      [&](const LoopOutcome& outcome) {
        return outcome.node.trajectory_id == trajectory_id &&
               outcome.submap.trajectory_id == submap_trajectory_id &&
               outcome.node.node_index <= last_node_index &&
               !outcome.decision.search().full_submap();
      },
      LoopDecision::OUT_OF_DATE);
  subset_.ForgetAccepted([&](const LoopEvidence& evidence) {
    return evidence.edge.b.IsNodeOf(trajectory_id) &&
           evidence.edge.b.index() <= last_node_index &&
           evidence.edge.a.IsSubmapOf(submap_trajectory_id);
  });
}

void LoopVerifier::DeleteSubmap(const uncertainty::SubmapId& submap) {
  Withdraw(
      [&](const LoopOutcome& outcome) {
        return outcome.submap.trajectory_id == submap.trajectory_id &&
               outcome.submap.submap_index == submap.submap_index;
      },
      LoopDecision::SUBMAP_DELETED);
}

void LoopVerifier::DeleteNodes(const int trajectory_id,
                               const int last_node_index) {
  Withdraw(
      [&](const LoopOutcome& outcome) {
        return outcome.node.trajectory_id == trajectory_id &&
               outcome.node.node_index <= last_node_index;
      },
      LoopDecision::NODE_DELETED);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
