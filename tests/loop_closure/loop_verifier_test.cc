// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/loop_verifier.h"

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cartographer_ext/options/option_description.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kResolution = 0.1;
constexpr double kLength = 40.;  // metres

// A corridor from (0, -1) to (40, 1); its ends are closed. With `wide` the
// middle is twice as wide to the left.
OccupancyView Corridor(bool wide) {
  const int nx = static_cast<int>(std::lround(kLength / kResolution));
  const int ny = 32;
  OccupancyView view(Eigen::Vector2d(0., -1.1), kResolution, nx, ny);
  for (int i = 0; i < nx; ++i) {
    const double x = (i + 0.5) * kResolution;
    const int top = wide && x > 10. && x < 30. ? 31 : 21;
    for (int j = 0; j < ny; ++j) {
      const bool wall = j == 0 || j >= top || i == 0 || i == nx - 1;
      view.Set(i, j, wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  return view;
}

// Forth and back through the corridor, a node every half metre; submap s has
// its origin at x = 5 s and is seen on the way forth.
class LoopVerifierTest : public testing::Test {
 protected:
  LoopVerifierTest() : world_(Corridor(true)), other_(Corridor(false)) {
    options::SetDefaults(&options_);
    options_.mutable_compatible_subset()->set_single_strong(false);
    // The robot turns round in one step.
    options_.mutable_path_noise()->set_free_radians(4.);
    options_.mutable_temporal_verification()->set_comparison(
        proto::LoopClosureOptions::TemporalVerification::SECTORS);
    options_.mutable_temporal_verification()->set_max_range(10.);
    options_.mutable_temporal_verification()->set_clip(1.);
    options_.mutable_temporal_verification()->set_minimum_overlap(0.5);
    options_.mutable_fusion()->set_mode(
        proto::LoopClosureOptions::Fusion::AS_PRINTED);
  }

  static Pose2 True(int i) {
    return i <= 76 ? Pose2(1. + 0.5 * i, 0., 0.)
                   : Pose2(39. - 0.5 * (i - 76), 0., kPi);
  }

  void MakeVerifier() {
    verifier_.reset(
        new LoopVerifier(options_, ConstraintWeights{1000., 2000.}));
    for (int i = 0; i <= 152; ++i) {
      HistoryNode node;
      node.node_index = i;
      node.local_pose = True(i);
      node.signature = PredictSignature(verifier_->temporal_options().signature,
                                        world_, True(i));
      EXPECT_TRUE(verifier_->AddNode(0, node));
    }
  }

  // Node `i` found in submap `s`, wrong by `offset` metres. `map` is what the
  // submap shows, in the world's frame.
  LoopCandidate Candidate(int s, int i, double offset,
                          const OccupancyView* map) {
    LoopCandidate candidate;
    candidate.submap = uncertainty::SubmapId{0, s};
    candidate.node = uncertainty::NodeId{0, i};
    candidate.submap_local_pose = Pose2(5. * s, 0., 0.);
    candidate.refined =
        Pose2(offset, 0., 0.) * Between(candidate.submap_local_pose, True(i));
    candidate.grid_score = 0.7;
    candidate.maps = {{map, candidate.submap_local_pose}};
    return candidate;
  }

  OccupancyView world_;
  OccupancyView other_;
  proto::LoopClosureOptions options_;
  std::unique_ptr<LoopVerifier> verifier_;
};

TEST_F(LoopVerifierTest, ConfirmedLoopsGoThroughAllStages) {
  MakeVerifier();
  EXPECT_TRUE(verifier_->HasNode(uncertainty::NodeId{0, 3}));
  EXPECT_FALSE(verifier_->HasNode(uncertainty::NodeId{0, 300}));
  verifier_->Process(Candidate(5, 100, 0., &world_));
  EXPECT_THAT(verifier_->Decide(), IsEmpty());
  EXPECT_EQ(verifier_->num_undecided(), 1);
  verifier_->Process(Candidate(3, 120, 0., &world_));
  const std::vector<LoopOutcome> outcomes = verifier_->Decide();
  ASSERT_EQ(outcomes.size(), 2u);
  for (const LoopOutcome& outcome : outcomes) {
    const LoopDecision& decision = outcome.decision;
    EXPECT_TRUE(outcome.accepted());
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
    EXPECT_NEAR(outcome.weights.translation,
                1000. * std::pow(decision.fusion().final_score() / 0.6, 0.6),
                1e-6);
    EXPECT_NEAR(outcome.weights.rotation,
                2000. * std::pow(decision.fusion().final_score() / 0.6, 0.75),
                1e-6);
  }
  EXPECT_EQ(outcomes[0].decision.candidate(), 0);
  EXPECT_EQ(outcomes[0].decision.subset().num_tests(), 2);
  EXPECT_EQ(outcomes[1].decision.submap_index(), 3);
  EXPECT_EQ(outcomes[1].decision.node_index(), 120);
  EXPECT_EQ(outcomes[1].decision.subset().num_tests(), 1);
}

TEST_F(LoopVerifierTest, AnotherWayScoresLow) {
  options_.mutable_dynamic_threshold()->set_base_threshold(0.9);
  MakeVerifier();
  verifier_->Process(Candidate(3, 120, 0., &other_));
  const std::vector<LoopOutcome> outcomes = verifier_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(outcomes[0].decision.reason(), LoopDecision::LOW_TEMPORAL_SCORE);
  EXPECT_LT(outcomes[0].decision.temporal().score(), 0.85);
  EXPECT_FALSE(outcomes[0].decision.has_innovation());
}

TEST_F(LoopVerifierTest, ComparesNothingFromBeforeTheFirstNode) {
  MakeVerifier();
  LoopCandidate candidate = Candidate(3, 120, 0., &world_);
  candidate.first_node_index = 116;
  verifier_->Process(candidate);
  candidate.first_node_index = 120;
  verifier_->Process(candidate);
  const std::vector<LoopOutcome> outcomes = verifier_->Flush();
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(outcomes[0].decision.temporal().num_query(), 5);
  EXPECT_EQ(outcomes[1].decision.temporal().outcome(),
            LoopDecision::Temporal::SHORT_HISTORY);
}

TEST_F(LoopVerifierTest, LowFinalScoreIsRejected) {
  options_.mutable_fusion()->set_min_final_score(0.95);
  MakeVerifier();
  verifier_->Process(Candidate(3, 120, 0., &world_));
  const std::vector<LoopOutcome> outcomes = verifier_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(outcomes[0].decision.reason(), LoopDecision::LOW_FINAL_SCORE);
}

TEST_F(LoopVerifierTest, ImpossibleInnovationIsVetoed) {
  options_.mutable_temporal_verification()->set_enabled(false);
  MakeVerifier();
  verifier_->Process(Candidate(3, 60, 15., &world_));
  const std::vector<LoopOutcome> outcomes = verifier_->Decide();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(outcomes[0].decision.reason(), LoopDecision::INNOVATION_TOO_LARGE);
  EXPECT_GT(outcomes[0].decision.innovation().chi_square(), 21.108);
  EXPECT_NEAR(std::abs(outcomes[0].decision.innovation().pose().x()), 15.,
              1e-6);
}

TEST_F(LoopVerifierTest, WithoutHistoryTheOthersDecide) {
  options_.mutable_fusion()->set_mode(
      proto::LoopClosureOptions::Fusion::LIKELIHOOD_RATIO);
  MakeVerifier();
  // Maps that show nothing.
  const OccupancyView empty(Eigen::Vector2d::Zero(), 0.1, 10, 10);
  verifier_->Process(Candidate(5, 100, 0., &empty));
  verifier_->Process(Candidate(3, 120, 0., &empty));
  const std::vector<LoopOutcome> outcomes = verifier_->Decide();
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_TRUE(outcomes[0].accepted());
  EXPECT_EQ(outcomes[0].decision.temporal().outcome(),
            LoopDecision::Temporal::UNKNOWN_WAY);
  EXPECT_EQ(outcomes[0].decision.fusion().final_score(), 0.5);
  EXPECT_GT(outcomes[0].decision.fusion().true_loops().mean_temporal(),
            outcomes[0].decision.fusion().false_loops().mean_temporal());
}

TEST_F(LoopVerifierTest, EveryCombinationOfStagesRuns) {
  for (int mask = 0; mask < 64; ++mask) {
    options_.mutable_temporal_verification()->set_enabled(mask & 1);
    options_.mutable_dynamic_threshold()->set_enabled(mask & 2);
    options_.mutable_fusion()->set_enabled(mask & 4);
    options_.mutable_information()->set_enabled(mask & 8);
    options_.mutable_compatible_subset()->set_enabled(mask & 16);
    options_.mutable_innovation_veto()->set_enabled(mask & 32);
    MakeVerifier();
    verifier_->Process(Candidate(5, 100, 0., &world_));
    verifier_->Process(Candidate(3, 120, 0., &world_));
    const std::vector<LoopOutcome> outcomes = verifier_->Flush();
    ASSERT_EQ(outcomes.size(), 2u) << mask;
    const LoopDecision& decision = outcomes[1].decision;
    EXPECT_TRUE(outcomes[1].accepted()) << mask;
    EXPECT_EQ(decision.has_temporal(), (mask & 1) != 0);
    EXPECT_EQ(decision.has_fusion(), (mask & 4) != 0);
    EXPECT_EQ(decision.has_subset(), (mask & 16) != 0);
    EXPECT_EQ(decision.has_innovation(), (mask & 32) != 0);
    if (!(mask & 8)) {
      EXPECT_EQ(outcomes[1].weights.translation, 1000.);
    }
  }
}

TEST_F(LoopVerifierTest, FlushDecidesTheRest) {
  MakeVerifier();
  verifier_->Process(Candidate(5, 100, 0., &world_));
  const std::vector<LoopOutcome> outcomes = verifier_->Flush();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(outcomes[0].decision.verdict(), LoopDecision::REJECTED);
  EXPECT_EQ(outcomes[0].decision.reason(), LoopDecision::UNSUPPORTED);
  EXPECT_THAT(verifier_->Flush(), IsEmpty());
}

TEST_F(LoopVerifierTest, NothingIsAcceptedForWhatIsDeleted) {
  MakeVerifier();
  verifier_->Process(Candidate(5, 100, 0., &world_));
  verifier_->Process(Candidate(3, 120, 0., &world_));
  verifier_->Process(Candidate(1, 140, 0., &world_));
  verifier_->DeleteSubmap(uncertainty::SubmapId{0, 5});
  verifier_->DeleteNodes(0, 125);
  verifier_->DeleteNodes(1, 1000);
  std::vector<LoopDecision::Reason> reasons;
  for (const LoopOutcome& outcome : verifier_->Flush()) {
    reasons.push_back(outcome.decision.reason());
  }
  EXPECT_THAT(reasons, ElementsAre(LoopDecision::SUBMAP_DELETED,
                                   LoopDecision::NODE_DELETED,
                                   LoopDecision::CONFIRMED_BY_SUBSET));
}

TEST_F(LoopVerifierTest, BadNumbersDoNotCrash) {
  MakeVerifier();
  LoopCandidate candidate = Candidate(5, 100, 0., &world_);
  candidate.refined.x = std::numeric_limits<double>::quiet_NaN();
  verifier_->Process(candidate);
  candidate = Candidate(3, 999, 0., &world_);  // a node never seen
  verifier_->Process(candidate);
  candidate = Candidate(3, 120, 0., &world_);
  candidate.maps.clear();
  verifier_->Process(candidate);
  EXPECT_EQ(verifier_->Flush().size(), 3u);
}

TEST_F(LoopVerifierTest, RepeatsExactly) {
  std::vector<std::string> first;
  for (int run = 0; run < 2; ++run) {
    options_.mutable_fusion()->set_mode(
        proto::LoopClosureOptions::Fusion::LIKELIHOOD_RATIO);
    MakeVerifier();
    std::vector<std::string> records;
    for (int k = 0; k < 40; ++k) {
      verifier_->Process(Candidate(1 + k % 6, 90 + k, k % 3 == 0 ? 2. : 0.,
                                   k % 4 == 0 ? &other_ : &world_));
      for (const LoopOutcome& outcome : verifier_->Decide()) {
        records.push_back(outcome.decision.SerializeAsString());
      }
    }
    for (const LoopOutcome& outcome : verifier_->Flush()) {
      records.push_back(outcome.decision.SerializeAsString());
    }
    EXPECT_EQ(records.size(), 40u);
    if (run == 0) {
      first = records;
    } else {
      EXPECT_EQ(records, first);
    }
  }
}

TEST_F(LoopVerifierTest, TimesAndFullMatrixOnlyWhereAskedFor) {
  for (const bool asked : {false, true}) {
    options_.mutable_log()->set_times(asked);
    options_.mutable_information()->set_full_matrix(asked);
    MakeVerifier();
    for (const int submap : {5, 3}) {
      LoopCandidate candidate =
          Candidate(submap, submap == 5 ? 100 : 120, 0., &world_);
      candidate.search_seconds = 0.5;
      candidate.refinement_seconds = 0.25;
      // Nothing is known of the way along the corridor.
      candidate.information = Eigen::Vector3d(0., 1e6, 1e6).asDiagonal();
      verifier_->Process(candidate);
    }
    const std::vector<LoopOutcome> outcomes = verifier_->Decide();
    ASSERT_EQ(outcomes.size(), 2u);
    for (const LoopOutcome& outcome : outcomes) {
      ASSERT_EQ(outcome.decision.has_times(), asked);
      ASSERT_EQ(outcome.full_information.isZero(0.), !asked);
      if (!asked) continue;
      EXPECT_EQ(outcome.decision.times().search_seconds(), 0.5);
      EXPECT_EQ(outcome.decision.times().refinement_seconds(), 0.25);
      EXPECT_GT(outcome.decision.times().temporal_seconds(), 0.);
      const double whole =
          outcome.weights.translation * outcome.weights.translation;
      // A loop has 0.05 m, the way along the corridor 0.3 m.
      EXPECT_NEAR(outcome.full_information(0, 0),
                  whole * 0.0025 / (0.0025 + 0.09), 1e-3 * whole);
      EXPECT_NEAR(outcome.full_information(1, 1), whole, 0.02 * whole);
    }
  }
}

TEST_F(LoopVerifierTest, UnpredictedLoopsOfAnotherRunNeedMorePlaces) {
  options_.mutable_compatible_subset()->set_single_strong(true);
  MakeVerifier();
  // Run 1 repeats the way of run 0, in whose submaps it is found.
  for (int i = 0; i <= 60; ++i) {
    HistoryNode node;
    node.node_index = i;
    node.local_pose = True(i);
    node.signature = PredictSignature(verifier_->temporal_options().signature,
                                      world_, True(i));
    verifier_->AddNode(1, node);
  }
  for (int s = 0; s < 8; ++s) {
    verifier_->AddSubmap(uncertainty::SubmapId{0, s}, Pose2(5. * s, 0., 0.));
  }
  const auto found = [this](const int s, const int i) {
    LoopCandidate candidate = Candidate(s, i, 0., &world_);
    candidate.node.trajectory_id = 1;
    candidate.unpredicted = true;
    candidate.search.set_full_submap(true);
    return candidate;
  };
  for (const int i : {10, 38}) {
    verifier_->Process(found(1, i));
    verifier_->Process(found(2, i));
    EXPECT_THAT(verifier_->Decide(), IsEmpty()) << i;
  }
  verifier_->Process(found(4, 52));
  EXPECT_EQ(verifier_->Decide().size(), 5u);
  // Another one joins them.
  verifier_->Process(found(4, 53));
  EXPECT_EQ(verifier_->Decide().size(), 1u);
  // Unless they are forgotten; what was found without a prediction waits.
  verifier_->ForgetLoops(1, 0, 60);
  verifier_->Process(found(4, 54));
  LoopCandidate predicted = found(5, 55);
  predicted.unpredicted = false;
  predicted.search.set_full_submap(false);
  verifier_->Process(predicted);
  EXPECT_EQ(verifier_->num_undecided(), 2);
  EXPECT_THAT(verifier_->Decide(), IsEmpty());
  verifier_->ForgetLoops(1, 0, 60);
  const std::vector<LoopOutcome> rejected = verifier_->Decide();
  ASSERT_EQ(rejected.size(), 1u);
  EXPECT_EQ(rejected[0].decision.reason(), LoopDecision::OUT_OF_DATE);
  EXPECT_EQ(rejected[0].node.node_index, 55);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
