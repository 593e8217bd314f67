// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_record.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

void ToProto(const Pose2& from, LoopDecision::Pose* const to) {
  to->set_x(from.x);
  to->set_y(from.y);
  to->set_theta(from.theta);
}

LoopDecision::Temporal::Outcome ToProto(const TemporalOutcome outcome) {
  switch (outcome) {
    case TemporalOutcome::kScored:
      return LoopDecision::Temporal::SCORED;
    case TemporalOutcome::kShortHistory:
      return LoopDecision::Temporal::SHORT_HISTORY;
    case TemporalOutcome::kPathUnknown:
      break;
  }
  return LoopDecision::Temporal::PATH_UNKNOWN;
}

void ToProto(const MixtureDescription& from,
             LoopDecision::MixtureComponent* const to) {
  to->set_weight(from.weight);
  to->set_mean_grid(from.mean_grid);
  to->set_mean_temporal(from.mean_temporal);
  to->set_variance_grid(from.variance_grid);
  to->set_covariance(from.covariance);
  to->set_variance_temporal(from.variance_temporal);
}

void RecordSearch(const LoopCandidate& candidate,
                  LoopDecision::Search* const record) {
  record->set_full_submap(candidate.plan.full_submap);
  record->set_linear_window(candidate.plan.linear_window);
  record->set_angular_window(candidate.plan.angular_window);
  record->set_prior_translation_sigma(candidate.plan.translation_sigma);
  record->set_prior_rotation_sigma(candidate.plan.rotation_sigma);
  if (candidate.predicted.has_value()) {
    ToProto(candidate.InTrackingFrame(*candidate.predicted),
            record->mutable_predicted());
  }
  const SearchMatch& match = candidate.match;
  if (!match.found) return;
  record->set_grid_score(match.score);
  if (!match.has_pose) return;
  ToProto(candidate.InTrackingFrame(match.matched), record->mutable_matched());
  ToProto(candidate.RefinedInTrackingFrame(), record->mutable_refined());
}

void RecordTemporal(const TemporalScore& temporal,
                    LoopDecision::Temporal* const record) {
  record->set_outcome(ToProto(temporal.result.outcome));
  if (temporal.is_scored()) record->set_score(temporal.result.score);
  record->set_window(temporal.window);
  record->set_num_query(temporal.result.num_query);
  record->set_num_reference(temporal.result.num_reference);
  record->set_travelled(temporal.result.travelled);
  record->set_threshold(temporal.threshold);
  record->set_score_variance(temporal.score_variance);
}

void RecordFusion(const ScoreFusionResult& fusion,
                  LoopDecision::Fusion* const record) {
  record->set_lambda(fusion.lambda);
  record->set_final_score(fusion.final_score);
  record->set_probability(fusion.probability);
  if (!fusion.mixture.has_value()) return;
  ToProto((*fusion.mixture)[0], record->mutable_false_loops());
  ToProto((*fusion.mixture)[1], record->mutable_true_loops());
}

void RecordInnovation(const InnovationResult& innovation,
                      LoopDecision::Innovation* const record) {
  ToProto(innovation.innovation, record->mutable_pose());
  record->set_chi_square(innovation.chi_square);
  record->set_bound(innovation.bound);
}

void RecordInformation(const LoopCandidate& candidate,
                       LoopDecision::Information* const record) {
  record->set_translation_weight(candidate.weights->translation);
  record->set_rotation_weight(candidate.weights->rotation);
  const Eigen::Matrix3d& information = candidate.match.information;
  if (information.isZero(0.)) return;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) record->add_matrix(information(i, j));
  }
}

void RecordConsensus(const ConsensusResult& consensus,
                     LoopDecision::Subset* const record) {
  record->set_support(consensus.decision.support);
  record->set_contradictions(consensus.decision.contradictions);
  record->set_subset_size(consensus.decision.subset_size);
  record->set_num_tests(consensus.num_tests);
  record->set_exact(consensus.exact);
}

void RecordTimes(const StageTimes& times, LoopDecision::Times* const record) {
  record->set_search_seconds(times.search);
  record->set_refinement_seconds(times.refinement);
  record->set_temporal_seconds(times.temporal);
  record->set_fusion_seconds(times.fusion);
  record->set_subset_seconds(times.consensus);
}

}  // namespace

LoopDecision MakeDecisionRecord(const LoopCandidate& candidate,
                                const bool with_times) {
  LoopDecision record;
  record.set_candidate(candidate.number);
  record.set_submap_trajectory_id(candidate.submap.trajectory_id);
  record.set_submap_index(candidate.submap.submap_index);
  record.set_node_trajectory_id(candidate.node.trajectory_id);
  record.set_node_index(candidate.node.node_index);
  record.set_node_time(candidate.node_time);
  record.set_verdict(candidate.verdict);
  record.set_reason(candidate.reason);
  RecordSearch(candidate, record.mutable_search());
  if (candidate.temporal.has_value()) {
    RecordTemporal(*candidate.temporal, record.mutable_temporal());
  }
  if (candidate.fusion.has_value()) {
    RecordFusion(*candidate.fusion, record.mutable_fusion());
  }
  if (candidate.innovation.has_value()) {
    RecordInnovation(*candidate.innovation, record.mutable_innovation());
    record.mutable_innovation()->set_closed_sigma(
        candidate.closed_sigma.value_or(0.));
  }
  if (candidate.weights.has_value()) {
    RecordInformation(candidate, record.mutable_information());
  }
  if (candidate.followed.has_value()) {
    LoopDecision::Neighbours* const neighbours = record.mutable_neighbours();
    neighbours->set_num_found(candidate.followed->num_found);
    neighbours->set_num_missed(candidate.followed->num_missed);
  }
  if (candidate.consensus.has_value()) {
    RecordConsensus(*candidate.consensus, record.mutable_subset());
  }
  if (with_times) RecordTimes(candidate.times, record.mutable_times());
  return record;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
