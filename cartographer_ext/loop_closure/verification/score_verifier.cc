// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/score_verifier.h"

#include <algorithm>
#include <array>
#include <vector>

#include "cartographer_ext/loop_closure/stage_timer.h"
#include "cartographer_ext/loop_closure/verification/dtw.h"
#include "cartographer_ext/loop_closure/verification/search_prior.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

// The mixture moves slowly; it is fitted once in this many candidates.
constexpr int64_t kFitInterval = 10;
// Nodes looked at to find one node of the query.
constexpr int kScanPerNode = 50;
// Probability of a candidate about which nothing is known.
constexpr double kNeutralScore = 0.5;
// The same of a match in a whole submap: many poses compete there.
constexpr double kUnverifiedWhole = 0.05;

bool IsScored(const LoopCandidate& candidate) {
  return candidate.temporal.has_value() && candidate.temporal->is_scored();
}

double VolumeOf(const SearchPlannerOptions& options, const SearchPlan& plan) {
  return plan.full_submap
             ? SearchVolume(
                   std::max(plan.linear_window, options.max_linear_window), kPi)
             : SearchVolume(
                   std::max(plan.linear_window, options.min_linear_window),
                   std::max(plan.angular_window, options.min_angular_window));
}

// Of the match, where its search expected it.
double DensityInWindow(const SearchPlannerOptions& options,
                       const LoopCandidate& candidate) {
  return PredictedDensity(
      Between(candidate.InTrackingFrame(*candidate.predicted),
              candidate.RefinedInTrackingFrame()),
      ExpectedCovariance(options, candidate.plan));
}

MixtureDescription Describe(const MixtureComponent& component) {
  MixtureDescription description;
  description.weight = component.weight;
  description.mean_grid = component.mean.x();
  description.mean_temporal = component.mean.y();
  description.variance_grid = component.covariance(0, 0);
  description.covariance = component.covariance(0, 1);
  description.variance_temporal = component.covariance(1, 1);
  return description;
}

}  // namespace

ScoreVerifier::ScoreVerifier(const LoopOptions& options)
    : options_(options),
      threshold_(options.threshold),
      fusion_(options.fusion.blend),
      mixture_(options.fusion.mixture) {}

void ScoreVerifier::ComputeTemporalScore(const NodeHistory& history,
                                         LoopCandidate* const candidate) const {
  if (!options_.temporal.enabled) return;
  const StageTimer timer(options_.log_times, &candidate->times.temporal);
  candidate->temporal = TemporalScore();
  TemporalScore& temporal = *candidate->temporal;
  temporal.window =
      VariableWindow(options_.temporal.window, candidate->submap_age);
  std::vector<const HistoryNode*> sequence = history.Sequence(
      candidate->node.trajectory_id, candidate->node.node_index,
      temporal.window, options_.temporal.spacing,
      kScanPerNode * temporal.window);
  sequence.erase(sequence.begin(),
                 std::find_if(sequence.begin(), sequence.end(),
                              [&](const HistoryNode* const node) {
                                return node->node_index >=
                                       candidate->first_node_index;
                              }));
  temporal.is_beyond_submap =
      !sequence.empty() &&
      sequence.front()->node_index > candidate->last_submap_node;
  temporal.result =
      VerifySequence(options_.temporal.comparison, sequence,
                     candidate->RefinedInTrackingFrame(), candidate->maps);
}

double ScoreVerifier::Threshold() const {
  // As printed, it is the same for every robot.
  return options_.threshold.direction ==
                 ThresholdDirection::kStricterWhenUnstable
             ? threshold_.Current() * mixture_.temporal_scale()
             : threshold_.Current();
}

void ScoreVerifier::TestTemporalScore(LoopCandidate* const candidate) {
  if (!options_.threshold.enabled || !candidate->temporal.has_value()) return;
  TemporalScore& temporal = *candidate->temporal;
  temporal.threshold = Threshold();
  temporal.score_variance = threshold_.Variance();
  if (!temporal.is_scored()) return;
  threshold_.AddScore(temporal.result.score);
  if (temporal.result.score < temporal.threshold) {
    candidate->Reject(LoopDecision::LOW_TEMPORAL_SCORE);
  }
}

void ScoreVerifier::FuseScores(LoopCandidate* const candidate) {
  if (!options_.fusion.enabled) return;
  const StageTimer timer(options_.log_times, &candidate->times.fusion);
  ScoreFusionResult result;
  if (options_.fusion.mode == FusionMode::kLikelihoodRatio) {
    FuseByLikelihoodRatio(*candidate, &result);
  } else {
    FuseByLambda(*candidate, &result);
  }
  candidate->fusion = result;
  EstimateProbability(options_.search, candidate);
  // What could not be scored is left to the stages that follow.
  const bool is_comparable = IsScored(*candidate) || !options_.temporal.enabled;
  if (!candidate->is_rejected() && is_comparable &&
      result.final_score < options_.fusion.min_final_score) {
    candidate->Reject(LoopDecision::LOW_FINAL_SCORE);
  }
}

bool ScoreVerifier::IsCertain(const LoopCandidate& candidate) const {
  // The smallest window holds the true place, and no other.
  return !candidate.is_inter_trajectory() && !candidate.relocalized &&
         candidate.plan.translation_sigma > 0. &&
         options_.search.window_sigmas * candidate.plan.translation_sigma <=
             options_.search.min_linear_window;
}

void ScoreVerifier::FuseByLikelihoodRatio(const LoopCandidate& candidate,
                                          ScoreFusionResult* const result) {
  result->mixture = std::array<MixtureDescription, 2>{
      {Describe(mixture_.components()[0]), Describe(mixture_.components()[1])}};
  const double grid_score = candidate.match.score;
  const double volume = VolumeOf(options_.search, candidate.plan);
  result->search_density = 1. / volume;
  result->predicted_density =
      candidate.predicted.has_value() && !candidate.relocalized
          ? DensityInWindow(options_.search, candidate)
          : result->search_density;
  if (!IsScored(candidate)) {
    result->final_score = std::min(
        candidate.plan.full_submap && !candidate.relocalized ? kUnverifiedWhole
                                                             : kNeutralScore,
        mixture_.ProbabilityTrue(grid_score));
    result->wrong_density = mixture_.WrongDensity(grid_score);
    return;
  }
  const double temporal_score = candidate.temporal->result.score;
  result->final_score = mixture_.ProbabilityTrue(grid_score, temporal_score);
  result->wrong_density = mixture_.WrongDensity(grid_score, temporal_score);
  if (IsCertain(candidate)) {
    mixture_.AddCertain(grid_score, temporal_score,
                        !candidate.temporal->is_beyond_submap);
  } else {
    mixture_.Add(grid_score, temporal_score, volume);
  }
  if (++num_mixture_candidates_ % kFitInterval == 0) mixture_.Fit();
}

absl::optional<double> ScoreVerifier::FinalScore(
    const LoopCandidate& candidate) const {
  if (!IsScored(candidate)) return absl::nullopt;
  const double temporal_score = candidate.temporal->result.score;
  if (options_.threshold.enabled && temporal_score < Threshold()) return 0.;
  return mixture_.ProbabilityTrue(candidate.match.score, temporal_score);
}

void ScoreVerifier::Learn(const LoopCandidate& accepted) {
  if (!options_.fusion.enabled ||
      options_.fusion.mode != FusionMode::kLikelihoodRatio ||
      !IsScored(accepted) || IsCertain(accepted)) {
    return;
  }
  mixture_.AddCertain(accepted.match.score, accepted.temporal->result.score,
                      false);
}

void ScoreVerifier::FuseByLambda(const LoopCandidate& candidate,
                                 ScoreFusionResult* const result) {
  const double grid_score = candidate.match.score;
  if (!IsScored(candidate)) {
    result->final_score = std::min(grid_score, kNeutralScore);
    return;
  }
  const double temporal_score = candidate.temporal->result.score;
  const FusedScore fused = fusion_.Fuse(grid_score, temporal_score);
  fusion_.AddScores(grid_score, temporal_score);
  result->lambda = fused.lambda;
  result->final_score = fused.score;
}

void EstimateProbability(const SearchPlannerOptions& options,
                         LoopCandidate* const candidate) {
  if (!candidate->fusion.has_value() ||
      candidate->fusion->wrong_density == 0.) {
    return;
  }
  ScoreFusionResult& fusion = *candidate->fusion;
  double by_path = fusion.predicted_density;
  if (candidate->innovation.has_value()) {
    by_path = PredictedDensity(
        candidate->innovation->innovation,
        ExpectedCovariance(options, candidate->innovation->covariance));
  }
  fusion.true_density =
      TrueDensity(fusion.predicted_density, by_path, fusion.search_density);
  // A whole submap is one of the places where an unexpected node may be; a window
  // is where it is sought.
  const int num_places =
      candidate->plan.full_submap ? candidate->plan.num_places : 1;
  const double density = TrueDensity(fusion.predicted_density, by_path,
                                     fusion.search_density / num_places);
  fusion.probability = density / (density + fusion.wrong_density);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
