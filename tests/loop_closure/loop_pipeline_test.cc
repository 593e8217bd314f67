// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_pipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cartographer_ext/loop_closure/decision_record.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/corridor_pipeline.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(LoopPipelineTest, ConfirmedLoopsGoThroughAllStages) {
  MakePipeline();
  EXPECT_TRUE(pipeline_->HasNode(uncertainty::NodeId{0, 3}));
  EXPECT_FALSE(pipeline_->HasNode(uncertainty::NodeId{0, 300}));
  pipeline_->Process(Candidate(5, 100, 0., &world_));
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  EXPECT_EQ(pipeline_->num_undecided(), 1);
  pipeline_->Process(Candidate(3, 120, 0., &world_));
  const std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 2u);
  for (const LoopCandidate& outcome : outcomes) {
    const LoopDecision decision = Record(outcome);
    EXPECT_TRUE(outcome.is_accepted());
    EXPECT_EQ(decision.reason(), LoopDecision::CONFIRMED_BY_SUBSET);
    EXPECT_EQ(decision.temporal().outcome(), LoopDecision::Temporal::SCORED);
    EXPECT_GT(decision.temporal().score(), 0.95);
    EXPECT_EQ(decision.temporal().window(), 12);
    EXPECT_EQ(decision.temporal().threshold(), 0.5);
    EXPECT_EQ(decision.fusion().lambda(), 0.5);
    EXPECT_NEAR(decision.fusion().final_score(),
                0.5 * (0.7 + decision.temporal().score()), 1e-12);
    EXPECT_LT(decision.innovation().chi_square(), 1e-6);
    EXPECT_EQ(decision.subset().support(), 1);
    // Nodes are twice as far apart as dense ones.
    EXPECT_NEAR(outcome.weights->translation,
                4000. * std::pow(decision.fusion().final_score() / 0.6, 0.6),
                1e-6);
    EXPECT_NEAR(outcome.weights->rotation,
                8000. * std::pow(decision.fusion().final_score() / 0.6, 0.75),
                1e-6);
  }
  EXPECT_EQ(Record(outcomes[0]).candidate(), 0);
  EXPECT_EQ(Record(outcomes[0]).subset().num_tests(), 2);
  EXPECT_EQ(Record(outcomes[1]).submap_index(), 3);
  EXPECT_EQ(Record(outcomes[1]).node_index(), 120);
  EXPECT_EQ(Record(outcomes[1]).subset().num_tests(), 1);
}

TEST_F(LoopPipelineTest, AnotherWayScoresLow) {
  options_.threshold.base_threshold = 0.9;
  MakePipeline();
  pipeline_->Process(Candidate(3, 120, 0., &other_));
  const std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(Record(outcomes[0]).reason(), LoopDecision::LOW_TEMPORAL_SCORE);
  EXPECT_LT(Record(outcomes[0]).temporal().score(), 0.85);
  EXPECT_FALSE(Record(outcomes[0]).has_innovation());
}

TEST_F(LoopPipelineTest, ComparesNothingFromBeforeTheFirstNode) {
  MakePipeline();
  LoopCandidate candidate = Candidate(3, 120, 0., &world_);
  candidate.first_node_index = 116;
  pipeline_->Process(candidate);
  candidate.first_node_index = 120;
  pipeline_->Process(candidate);
  const std::vector<LoopCandidate> outcomes = pipeline_->Flush();
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(Record(outcomes[0]).temporal().num_query(), 5);
  EXPECT_EQ(Record(outcomes[1]).temporal().outcome(),
            LoopDecision::Temporal::SHORT_HISTORY);
}

// A scan of a straight wall is found somewhere along it.
TEST_F(LoopPipelineTest, AnAmbiguousMatchIsNoLoop) {
  MakePipeline();
  LoopCandidate candidate = Candidate(3, 120, 0., &world_);
  candidate.match.slide_odds = 0.9;
  pipeline_->Process(candidate);
  std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(Record(outcomes[0]).reason(), LoopDecision::AMBIGUOUS);
  EXPECT_TRUE(Record(outcomes[0]).search().has_refined());
  EXPECT_FALSE(Record(outcomes[0]).has_temporal());
  candidate.match.slide_odds = 1.1;
  pipeline_->Process(candidate);
  outcomes = pipeline_->Flush();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_NE(Record(outcomes[0]).reason(), LoopDecision::AMBIGUOUS);
}

TEST_F(LoopPipelineTest, SkippedAndUnmatchedCandidatesAreRecorded) {
  MakePipeline();
  LoopCandidate candidate = Candidate(3, 120, 0., &world_);
  candidate.match = SearchMatch();
  pipeline_->Process(candidate);
  candidate.plan.skipped = LoopDecision::SKIPPED_BUDGET;
  pipeline_->Process(candidate);
  candidate.plan.skipped = LoopDecision::NONE;
  candidate.Reject(LoopDecision::OUTSCORED);
  pipeline_->Process(candidate);
  std::vector<LoopDecision::Reason> reasons;
  for (const LoopCandidate& rejected : pipeline_->Decide()) {
    const LoopDecision record = Record(rejected);
    EXPECT_EQ(record.candidate(), static_cast<int64_t>(reasons.size()));
    EXPECT_EQ(record.verdict(), LoopDecision::REJECTED);
    EXPECT_TRUE(record.has_search());
    EXPECT_FALSE(record.search().has_refined());
    EXPECT_FALSE(record.has_temporal());
    reasons.push_back(record.reason());
  }
  EXPECT_THAT(reasons, ElementsAre(LoopDecision::LOW_GRID_SCORE,
                                   LoopDecision::SKIPPED_BUDGET,
                                   LoopDecision::OUTSCORED));
}

TEST_F(LoopPipelineTest, NothingIsRememberedOfADeletedTrajectory) {
  MakePipeline();
  pipeline_->DeleteTrajectory(1);
  EXPECT_TRUE(pipeline_->HasNode(uncertainty::NodeId{0, 3}));
  pipeline_->DeleteTrajectory(0);
  EXPECT_FALSE(pipeline_->HasNode(uncertainty::NodeId{0, 3}));
  EXPECT_FALSE(
      pipeline_->paths().LocalPose(uncertainty::NodeId{0, 3}).has_value());
}

TEST_F(LoopPipelineTest, LowFinalScoreIsRejected) {
  options_.fusion.min_final_score = 0.95;
  MakePipeline();
  pipeline_->Process(Candidate(3, 120, 0., &world_));
  const std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(Record(outcomes[0]).reason(), LoopDecision::LOW_FINAL_SCORE);
}

TEST_F(LoopPipelineTest, ImpossibleInnovationIsVetoed) {
  options_.temporal.enabled = false;
  MakePipeline();
  pipeline_->Process(Candidate(3, 60, 15., &world_));
  // It waits: local SLAM may turn out to drift more than is known.
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  EXPECT_EQ(pipeline_->num_undecided(), 1);
  ASSERT_EQ(pipeline_->Undecided().size(), 1u);
  EXPECT_EQ(Record(pipeline_->Undecided()[0]).reason(),
            LoopDecision::INNOVATION_TOO_LARGE);
  const std::vector<LoopCandidate> outcomes = pipeline_->Flush();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(pipeline_->num_undecided(), 0);
  EXPECT_TRUE(outcomes[0].is_rejected());
  EXPECT_EQ(Record(outcomes[0]).reason(), LoopDecision::INNOVATION_TOO_LARGE);
  EXPECT_GT(Record(outcomes[0]).innovation().chi_square(), 21.108);
  EXPECT_NEAR(std::abs(Record(outcomes[0]).innovation().pose().x()), 15., 1e-6);
}

// Two loops to the side of the corridor agree, and a heading may have drifted so
// far. Matches that are certainly wrong are many and have the right heading: it
// has not, and the one that asks for more is taken back.
TEST_F(LoopPipelineTest, WhatTheDriftDoesNotAllowAnyMoreIsWithdrawn) {
  options_.temporal.enabled = false;
  MakePipeline();
  const auto process = [&](const int s, const int i, const Pose2& offset) {
    LoopCandidate candidate = Candidate(s, i, 0., &world_);
    candidate.anchor = uncertainty::NodeId{0, std::max(0, 10 * s - 2)};
    candidate.match.refined = offset * candidate.match.refined;
    pipeline_->Process(candidate);
  };
  process(0, 150, Pose2(0., 2.5, 0.));
  process(2, 130, Pose2(0., 2.5, 0.));
  std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_TRUE(outcomes[0].is_accepted());
  for (int i = 110; i <= 150; ++i) {
    process(i % 7, i, Pose2(15., 0., 0.));
  }
  // The drift needs the share of wrong matches, which is counted after it.
  pipeline_->Decide();
  EXPECT_GT(pipeline_->share_wrong(), 0.5);
  outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(outcomes[0].node.node_index, 130);
  EXPECT_EQ(outcomes[0].verdict, LoopDecision::UNDECIDED);
  EXPECT_EQ(outcomes[0].reason, LoopDecision::OVERTURNED);
  EXPECT_EQ(pipeline_->Undecided().size(), 42u);
  EXPECT_EQ(Record(pipeline_->Undecided()[0]).reason(),
            LoopDecision::INNOVATION_TOO_LARGE);
}

TEST_F(LoopPipelineTest, WithoutHistoryTheOthersDecide) {
  options_.fusion.mode = FusionMode::kLikelihoodRatio;
  MakePipeline();
  // Maps that show nothing.
  const OccupancyView empty(Eigen::Vector2d::Zero(), 0.1, 10, 10);
  pipeline_->Process(Candidate(5, 100, 0., &empty));
  pipeline_->Process(Candidate(3, 120, 0., &empty));
  const std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_TRUE(outcomes[0].is_accepted());
  EXPECT_EQ(Record(outcomes[0]).temporal().outcome(),
            LoopDecision::Temporal::PATH_UNKNOWN);
  EXPECT_EQ(Record(outcomes[0]).fusion().final_score(), 0.5);
  EXPECT_GT(Record(outcomes[0]).fusion().true_loops().mean_temporal(),
            Record(outcomes[0]).fusion().false_loops().mean_temporal());
}

TEST_F(LoopPipelineTest, EveryCombinationOfStagesRuns) {
  for (int mask = 0; mask < 64; ++mask) {
    options_.temporal.enabled = mask & 1;
    options_.threshold.enabled = mask & 2;
    options_.fusion.enabled = mask & 4;
    options_.information.enabled = mask & 8;
    options_.compatible_subset.enabled = mask & 16;
    options_.innovation_veto.enabled = mask & 32;
    MakePipeline();
    pipeline_->Process(Candidate(5, 100, 0., &world_));
    pipeline_->Process(Candidate(3, 120, 0., &world_));
    const std::vector<LoopCandidate> outcomes = pipeline_->Flush();
    ASSERT_EQ(outcomes.size(), 2u) << mask;
    const LoopDecision decision = Record(outcomes[1]);
    EXPECT_TRUE(outcomes[1].is_accepted()) << mask;
    EXPECT_EQ(decision.has_temporal(), (mask & 1) != 0);
    EXPECT_EQ(decision.has_fusion(), (mask & 4) != 0);
    EXPECT_EQ(decision.has_subset(), (mask & 16) != 0);
    EXPECT_EQ(decision.has_innovation(), (mask & 32) != 0);
    if (!(mask & 8)) {
      EXPECT_EQ(outcomes[1].weights->translation, 1000.);
    }
  }
}

TEST_F(LoopPipelineTest, FlushDecidesTheRest) {
  MakePipeline();
  pipeline_->Process(Candidate(5, 100, 0., &world_));
  const std::vector<LoopCandidate> outcomes = pipeline_->Flush();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(Record(outcomes[0]).verdict(), LoopDecision::REJECTED);
  EXPECT_EQ(Record(outcomes[0]).reason(), LoopDecision::UNSUPPORTED);
  EXPECT_THAT(pipeline_->Flush(), IsEmpty());
}

TEST_F(LoopPipelineTest, NothingIsAcceptedForWhatIsDeleted) {
  MakePipeline();
  pipeline_->Process(Candidate(5, 100, 0., &world_));
  pipeline_->Process(Candidate(3, 120, 0., &world_));
  pipeline_->Process(Candidate(1, 140, 0., &world_));
  pipeline_->DeleteSubmap(uncertainty::SubmapId{0, 5});
  pipeline_->DeleteNodes(0, 125);
  pipeline_->DeleteNodes(1, 1000);
  std::vector<LoopDecision::Reason> reasons;
  for (const LoopCandidate& outcome : pipeline_->Flush()) {
    reasons.push_back(Record(outcome).reason());
  }
  EXPECT_THAT(reasons, ElementsAre(LoopDecision::SUBMAP_DELETED,
                                   LoopDecision::NODE_DELETED,
                                   LoopDecision::CONFIRMED_BY_SUBSET));
}

TEST_F(LoopPipelineTest, BadNumbersDoNotCrash) {
  MakePipeline();
  LoopCandidate candidate = Candidate(5, 100, 0., &world_);
  candidate.match.refined.x = std::numeric_limits<double>::quiet_NaN();
  pipeline_->Process(candidate);
  candidate = Candidate(3, 999, 0., &world_);  // a node never seen
  pipeline_->Process(candidate);
  candidate = Candidate(3, 120, 0., &world_);
  candidate.maps.clear();
  pipeline_->Process(candidate);
  EXPECT_EQ(pipeline_->Flush().size(), 3u);
}

TEST_F(LoopPipelineTest, RepeatsExactly) {
  std::vector<std::string> first;
  for (int run = 0; run < 2; ++run) {
    options_.fusion.mode = FusionMode::kLikelihoodRatio;
    MakePipeline();
    std::vector<std::string> records;
    for (int k = 0; k < 40; ++k) {
      pipeline_->Process(Candidate(1 + k % 6, 90 + k, k % 3 == 0 ? 2. : 0.,
                                   k % 4 == 0 ? &other_ : &world_));
      for (const LoopCandidate& outcome : pipeline_->Decide()) {
        records.push_back(Record(outcome).SerializeAsString());
      }
    }
    for (const LoopCandidate& outcome : pipeline_->Flush()) {
      records.push_back(Record(outcome).SerializeAsString());
    }
    EXPECT_EQ(records.size(), 40u);
    if (run == 0) {
      first = records;
    } else {
      EXPECT_EQ(records, first);
    }
  }
}

TEST_F(LoopPipelineTest, TimesAndFullMatrixOnlyWhereAskedFor) {
  for (const bool asked : {false, true}) {
    options_.log_times = asked;
    options_.information.full_matrix = asked;
    MakePipeline();
    for (const int submap : {5, 3}) {
      LoopCandidate candidate =
          Candidate(submap, submap == 5 ? 100 : 120, 0., &world_);
      candidate.times.search = 0.5;
      candidate.times.refinement = 0.25;
      // Nothing is known of the translation along the corridor.
      candidate.match.information = Eigen::Vector3d(0., 1e6, 1e6).asDiagonal();
      pipeline_->Process(candidate);
    }
    const std::vector<LoopCandidate> outcomes = pipeline_->Decide();
    ASSERT_EQ(outcomes.size(), 2u);
    for (const LoopCandidate& outcome : outcomes) {
      ASSERT_EQ(Record(outcome).has_times(), asked);
      ASSERT_EQ(outcome.full_information.isZero(0.), !asked);
      if (!asked) continue;
      EXPECT_EQ(Record(outcome).times().search_seconds(), 0.5);
      EXPECT_EQ(Record(outcome).times().refinement_seconds(), 0.25);
      EXPECT_GT(Record(outcome).times().temporal_seconds(), 0.);
      const double whole =
          outcome.weights->translation * outcome.weights->translation;
      // A loop has 0.05 m, the translation along the corridor 0.3 m.
      EXPECT_NEAR(outcome.full_information(0, 0),
                  whole * 0.0025 / (0.0025 + 0.09), 1e-3 * whole);
      EXPECT_NEAR(outcome.full_information(1, 1), whole, 0.02 * whole);
    }
  }
}

TEST_F(LoopPipelineTest, KnowsWhichStepsAreDoubted) {
  MakePipeline();
  uncertainty::StepError doubted;
  doubted.doubt = Eigen::Vector3d(0., 0., 0.25).asDiagonal();
  for (int i = 0; i <= 2; ++i) {
    HistoryNode node;
    node.node_index = i;
    node.local_pose = True(i);
    pipeline_->AddNode(1, node, i == 1 ? doubted : uncertainty::StepError());
  }
  const auto variance = [this](const int a, const int b) {
    return pipeline_->paths()
        .Between(uncertainty::NodeId{1, a}, uncertainty::NodeId{1, b})
        ->covariance(2, 2);
  };
  EXPECT_GT(variance(0, 1), 0.25);
  EXPECT_LT(variance(1, 2), 0.01);
}

TEST_F(LoopPipelineTest, UnpredictedLoopsOfAnotherRunNeedMorePlaces) {
  options_.compatible_subset.single_strong_enabled = true;
  MakePipeline();
  // Run 1 repeats the path of run 0, in whose submaps it is found.
  for (int i = 0; i <= 60; ++i) {
    HistoryNode node;
    node.node_index = i;
    node.local_pose = True(i);
    node.signature = PredictSignature(pipeline_->temporal_options().signature,
                                      world_, True(i));
    pipeline_->AddNode(1, node);
  }
  for (int s = 0; s < 8; ++s) {
    pipeline_->AddSubmap(uncertainty::SubmapId{0, s}, Pose2(5. * s, 0., 0.));
  }
  const auto found = [this](const int s, const int i) {
    LoopCandidate candidate = Candidate(s, i, 0., &world_);
    candidate.node.trajectory_id = 1;
    candidate.relocalized = true;
    candidate.plan.full_submap = true;
    return candidate;
  };
  for (const int i : {10, 38}) {
    pipeline_->Process(found(1, i));
    pipeline_->Process(found(2, i));
    EXPECT_THAT(pipeline_->Decide(), IsEmpty()) << i;
  }
  pipeline_->Process(found(4, 52));
  EXPECT_EQ(pipeline_->Decide().size(), 5u);
  // Another one joins them.
  pipeline_->Process(found(4, 53));
  EXPECT_EQ(pipeline_->Decide().size(), 1u);
  // Unless they are forgotten; what was found without a prediction waits.
  pipeline_->ForgetLoops(1, 0, 60);
  pipeline_->Process(found(4, 54));
  LoopCandidate predicted = found(5, 55);
  predicted.relocalized = false;
  predicted.plan.full_submap = false;
  pipeline_->Process(predicted);
  EXPECT_EQ(pipeline_->num_undecided(), 2);
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  pipeline_->ForgetLoops(1, 0, 60);
  const std::vector<LoopCandidate> rejected = pipeline_->Decide();
  ASSERT_EQ(rejected.size(), 1u);
  EXPECT_EQ(Record(rejected[0]).reason(), LoopDecision::STALE);
  EXPECT_EQ(rejected[0].node.node_index, 55);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
