// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/score_verifier.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

LoopOptions Options(const FusionMode mode) {
  LoopOptions options;
  options.fusion.mode = mode;
  options.threshold.base_threshold = 0.5;
  return options;
}

LoopCandidate Scored(const double grid_score, const double temporal_score) {
  LoopCandidate candidate;
  candidate.match.found = true;
  candidate.match.score = grid_score;
  candidate.temporal = TemporalScore();
  candidate.temporal->result.outcome = TemporalOutcome::kScored;
  candidate.temporal->result.score = temporal_score;
  return candidate;
}

TEST(ScoreVerifierTest, TheThresholdIsThatOfTheCandidatesBefore) {
  LoopOptions options = Options(FusionMode::kAsPrinted);
  options.threshold.window = 2;
  ScoreVerifier verifier(options);
  for (const double score : {0.4, 0.9}) {
    LoopCandidate candidate = Scored(0.7, score);
    verifier.TestTemporalScore(&candidate);
    EXPECT_EQ(candidate.temporal->threshold, 0.5);
    EXPECT_EQ(candidate.temporal->score_variance, 0.);
    EXPECT_EQ(candidate.is_rejected(), score < 0.5);
  }
  LoopCandidate third = Scored(0.7, 0.9);
  verifier.TestTemporalScore(&third);
  EXPECT_NEAR(third.temporal->score_variance, 0.0625, 1e-12);
  EXPECT_NE(third.temporal->threshold, 0.5);
}

TEST(ScoreVerifierTest, WithoutATemporalScoreTheFinalOneIsNeutralAtBest) {
  for (const FusionMode mode :
       {FusionMode::kAsPrinted, FusionMode::kLikelihoodRatio}) {
    ScoreVerifier verifier(Options(mode));
    LoopCandidate candidate = Scored(0.9, 0.);
    candidate.temporal->result.outcome = TemporalOutcome::kShortHistory;
    verifier.TestTemporalScore(&candidate);
    verifier.FuseScores(&candidate);
    EXPECT_FALSE(candidate.is_rejected());
    EXPECT_EQ(candidate.FinalScore(), 0.5);
    EXPECT_EQ(candidate.fusion->mixture.has_value(),
              mode == FusionMode::kLikelihoodRatio);
  }
}

TEST(ScoreVerifierTest, WithoutATemporalScoreAWholeSubmapSaysLittle) {
  ScoreVerifier verifier(Options(FusionMode::kLikelihoodRatio));
  LoopCandidate candidate = Scored(0.9, 0.);
  candidate.temporal->result.outcome = TemporalOutcome::kShortHistory;
  candidate.plan.full_submap = true;
  verifier.FuseScores(&candidate);
  EXPECT_EQ(candidate.FinalScore(), 0.05);
  // Whose place has been tracked is verified otherwise.
  candidate.relocalized = true;
  verifier.FuseScores(&candidate);
  EXPECT_EQ(candidate.FinalScore(), 0.5);
}

TEST(ScoreVerifierTest, ProbabilityByHand) {
  LoopCandidate candidate = Scored(0.7, 0.9);
  const SearchPlannerOptions options;
  EstimateProbability(options, &candidate);  // nothing is fused
  EXPECT_FALSE(candidate.fusion.has_value());
  candidate.fusion = ScoreFusionResult();
  candidate.fusion->search_density = 0.01;
  candidate.fusion->wrong_density = 0.05;
  candidate.fusion->predicted_density = 3.;
  EstimateProbability(options, &candidate);  // without a path
  EXPECT_NEAR(candidate.fusion->probability, 1. / (1. + 0.05 / 2.701), 1e-12);
  // Certain paths have the deviations of the smallest window: 1/3 m, 0.17/3 rad.
  candidate.innovation = InnovationResult();
  EstimateProbability(options, &candidate);
  const double peak = 1. / (std::pow(2. * kPi, 1.5) * (1. / 9.) * (0.17 / 3.));
  EXPECT_NEAR(candidate.fusion->probability,
              1. / (1. + 0.05 / (0.45 * (3. + peak) + 0.1 * 0.01)), 1e-12);
  // Far from both predictions what is left is that the drift may be another one.
  candidate.fusion->predicted_density = 0.;
  candidate.innovation->innovation = Pose2(5., 0., 0.);
  EstimateProbability(options, &candidate);
  EXPECT_NEAR(candidate.fusion->probability, 1. / (1. + 0.05 / 0.001), 1e-9);
  // Less, where the path is less certain: to one side only, here.
  candidate.innovation->covariance =
      Eigen::Vector3d(25. - 1. / 9., 1. - 1. / 9., 0.17 * 0.17 * 8. / 9.)
          .asDiagonal();
  EstimateProbability(options, &candidate);
  const double wide = std::exp(-0.5) / (std::pow(2. * kPi, 1.5) * 5. * 0.17);
  EXPECT_NEAR(candidate.fusion->probability,
              1. / (1. + 0.05 / (0.45 * wide + 0.001)), 1e-12);
}

TEST(ScoreVerifierTest, AWholeSubmapIsOneOfManyPlaces) {
  LoopCandidate candidate = Scored(0.7, 0.9);
  const SearchPlannerOptions options;
  candidate.fusion = ScoreFusionResult();
  candidate.fusion->search_density = 0.01;
  candidate.fusion->wrong_density = 0.05;
  candidate.plan.num_places = 20;
  EstimateProbability(options, &candidate);  // a window
  EXPECT_NEAR(candidate.fusion->probability, 0.001 / 0.051, 1e-12);
  candidate.plan.full_submap = true;
  EstimateProbability(options, &candidate);
  EXPECT_NEAR(candidate.fusion->probability, 0.00005 / 0.05005, 1e-12);
  // What consensus compares with the density of wrong matches in the search.
  EXPECT_NEAR(candidate.fusion->true_density, 0.001, 1e-12);
}

TEST(ScoreVerifierTest, WideSearchesAreLessProbablyRight) {
  const auto probability = [](const bool full_submap) {
    ScoreVerifier verifier(Options(FusionMode::kLikelihoodRatio));
    LoopCandidate candidate = Scored(0.64, 0.);
    candidate.temporal->result.outcome = TemporalOutcome::kShortHistory;
    candidate.plan.full_submap = full_submap;
    verifier.FuseScores(&candidate);
    return candidate.fusion->probability;
  };
  EXPECT_GT(probability(false), 0.9);
  EXPECT_LT(probability(true), 0.1);
}

TEST(ScoreVerifierTest, FusionLearnsFromRejectedCandidates) {
  LoopOptions options = Options(FusionMode::kAsPrinted);
  options.fusion.blend.window = 1;
  options.fusion.min_final_score = 0.65;
  ScoreVerifier verifier(options);
  LoopCandidate rejected = Scored(0.7, 0.1);
  verifier.TestTemporalScore(&rejected);
  verifier.FuseScores(&rejected);
  // The first reason stays.
  EXPECT_EQ(rejected.reason, LoopDecision::LOW_TEMPORAL_SCORE);
  EXPECT_EQ(rejected.fusion->lambda, 0.5);
  LoopCandidate next = Scored(0.7, 0.6);
  verifier.TestTemporalScore(&next);
  verifier.FuseScores(&next);
  // S_g is as before, S_t is not: C eq. 6 puts the weight on S_g.
  EXPECT_NEAR(next.fusion->lambda, 1., 1e-9);
  EXPECT_NEAR(next.fusion->final_score, 0.7, 1e-9);
  EXPECT_FALSE(next.is_rejected());
  LoopCandidate low = Scored(0.6, 0.6);
  verifier.FuseScores(&low);
  EXPECT_EQ(low.reason, LoopDecision::LOW_FINAL_SCORE);
}

TEST(ScoreVerifierTest, ScoresOfCertainPlacesLowerTheThreshold) {
  for (const bool is_certain : {false, true}) {
    ScoreVerifier verifier(Options(FusionMode::kLikelihoodRatio));
    for (int i = 0; i < 40; ++i) {
      LoopCandidate candidate = Scored(0.55, 0.7);
      candidate.temporal->is_beyond_submap = true;
      // Within the smallest window at three standard deviations, or not.
      candidate.plan.translation_sigma = is_certain ? 0.3 : 0.4;
      verifier.FuseScores(&candidate);
    }
    LoopCandidate candidate = Scored(0.55, 0.45);
    verifier.TestTemporalScore(&candidate);
    EXPECT_EQ(candidate.is_rejected(), !is_certain);
  }
}

TEST(ScoreVerifierTest, ConfirmedLoopsTellWhatRightOnesScore) {
  ScoreVerifier verifier(Options(FusionMode::kLikelihoodRatio));
  LoopCandidate before = Scored(0.55, 0.7);
  verifier.FuseScores(&before);
  for (int i = 0; i < 40; ++i) verifier.Learn(Scored(0.55, 0.7));
  // The mixture is fitted once in ten candidates.
  LoopCandidate after = Scored(0.55, 0.7);
  for (int i = 0; i < 11; ++i) verifier.FuseScores(&after);
  EXPECT_GT(after.FinalScore(), 10. * before.FinalScore());
}

TEST(ScoreVerifierTest, StagesThatAreOffLeaveNoResult) {
  LoopOptions options = Options(FusionMode::kAsPrinted);
  options.temporal.enabled = false;
  options.fusion.enabled = false;
  ScoreVerifier verifier(options);
  const NodeHistory history(10);
  LoopCandidate candidate;
  candidate.match.score = 0.7;
  verifier.ComputeTemporalScore(history, &candidate);
  verifier.TestTemporalScore(&candidate);
  verifier.FuseScores(&candidate);
  EXPECT_FALSE(candidate.temporal.has_value());
  EXPECT_FALSE(candidate.fusion.has_value());
  EXPECT_EQ(candidate.FinalScore(), 0.7);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
