// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/loop_consensus.h"

#include <memory>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using testing::IsEmpty;

// Forth and back along a line, a node every metre.
class LoopConsensusTest : public testing::Test {
 protected:
  LoopConsensusTest() : paths_(uncertainty::RandomWalk(), 1000) {
    options_.compatible_subset.single_strong_enabled = false;
    for (int i = 0; i <= 100; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, Truth(i));
    }
    consensus_.reset(new LoopConsensus(options_, &paths_));
  }

  static Pose2 Truth(const int i) {
    return i <= 50 ? Pose2(i, 0., 0.) : Pose2(100. - i, 0., kPi);
  }

  // Node 100 - i found in the submap of node i.
  LoopCandidate Candidate(const int i) {
    LoopCandidate candidate;
    candidate.number = num_candidates_++;
    candidate.submap = uncertainty::SubmapId{0, i};
    candidate.submap_local_pose = Truth(i);
    candidate.anchor = uncertainty::NodeId{0, i};
    candidate.node = uncertainty::NodeId{0, 100 - i};
    candidate.predicted = Between(Truth(i), Truth(100 - i));
    candidate.match.found = true;
    candidate.match.score = 0.7;
    candidate.match.refined = *candidate.predicted;
    return candidate;
  }

  LoopOptions options_;
  uncertainty::PathUncertainty paths_;
  std::unique_ptr<LoopConsensus> consensus_;
  int num_candidates_ = 0;
};

TEST_F(LoopConsensusTest, CandidatesConfirmEachOther) {
  consensus_->Add(Candidate(5));
  EXPECT_THAT(consensus_->Decide(), IsEmpty());
  const std::vector<LoopCandidate> undecided = consensus_->Undecided();
  ASSERT_EQ(undecided.size(), 1u);
  EXPECT_EQ(undecided[0].verdict, LoopDecision::UNDECIDED);
  EXPECT_EQ(undecided[0].reason, LoopDecision::UNSUPPORTED);
  EXPECT_EQ(undecided[0].consensus->num_tests, 1);
  consensus_->Add(Candidate(25));
  const std::vector<LoopCandidate> accepted = consensus_->Decide();
  ASSERT_EQ(accepted.size(), 2u);
  for (const LoopCandidate& candidate : accepted) {
    EXPECT_TRUE(candidate.is_accepted());
    EXPECT_EQ(candidate.reason, LoopDecision::CONFIRMED_BY_SUBSET);
    EXPECT_EQ(candidate.consensus->decision.support, 1);
  }
  EXPECT_EQ(accepted[0].consensus->num_tests, 2);
  EXPECT_EQ(accepted[1].consensus->num_tests, 1);
  EXPECT_EQ(consensus_->num_undecided(), 0);
}

TEST_F(LoopConsensusTest, RemovedCandidatesConfirmNothing) {
  consensus_->Add(Candidate(5));
  const std::vector<LoopCandidate> removed = consensus_->Remove(
      [](const LoopCandidate& c) { return c.node.node_index == 95; });
  ASSERT_EQ(removed.size(), 1u);
  EXPECT_EQ(removed[0].number, 0);
  EXPECT_EQ(removed[0].verdict, LoopDecision::UNDECIDED);
  consensus_->Add(Candidate(25));
  EXPECT_THAT(consensus_->Decide(), IsEmpty());
  const std::vector<LoopCandidate> rest = consensus_->Flush();
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_TRUE(rest[0].is_rejected());
  EXPECT_EQ(rest[0].reason, LoopDecision::UNSUPPORTED);
}

// Of two matches that contradict each other the one is right that finds its
// neighbours where they should be.
TEST_F(LoopConsensusTest, NeighboursOfAMatchChangeItsScore) {
  options_.compatible_subset.single_strong_enabled = true;
  options_.compatible_subset.single_strong_sigma = 0.;
  consensus_.reset(new LoopConsensus(options_, &paths_));
  LoopCandidate right = Candidate(5);
  LoopCandidate wrong = Candidate(5);
  wrong.match.refined.x += 8.;
  for (LoopCandidate* const candidate : {&right, &wrong}) {
    candidate->plan.translation_sigma = 9.;
    candidate->plan.full_submap = true;
    candidate->predicted->y += 9.;
    consensus_->Add(*candidate);
  }
  EXPECT_THAT(consensus_->Decide(RunState::kEndsUnalike), IsEmpty());
  FollowedMatch confirmed;
  confirmed.num_found = 14;
  confirmed.num_missed = 1;
  consensus_->SetFollowed(right.number, confirmed);
  FollowedMatch refuted;
  refuted.num_found = 1;
  refuted.num_missed = 14;
  consensus_->SetFollowed(wrong.number, refuted);
  consensus_->SetFollowed(1000, refuted);  // unknown
  const std::vector<LoopCandidate> accepted =
      consensus_->Decide(RunState::kEndsUnalike);
  ASSERT_EQ(accepted.size(), 1u);
  EXPECT_EQ(accepted[0].number, right.number);
  EXPECT_EQ(accepted[0].reason, LoopDecision::LIKELY_AT_END);
  EXPECT_EQ(accepted[0].followed->num_found, 14);
  const std::vector<LoopCandidate> undecided = consensus_->Undecided();
  ASSERT_EQ(undecided.size(), 1u);
  EXPECT_EQ(undecided[0].followed->num_missed, 14);
}

// Two wrong candidates that agree, and four right ones that contradict them.
TEST_F(LoopConsensusTest, WithdrawnCandidatesAreReturnedAgain) {
  for (const bool forget : {false, true}) {
    consensus_.reset(new LoopConsensus(options_, &paths_));
    num_candidates_ = 0;
    for (const int i : {5, 15}) {
      LoopCandidate wrong = Candidate(i);
      wrong.match.refined.x += 8.;
      consensus_->Add(wrong);
    }
    EXPECT_EQ(consensus_->Decide().size(), 2u);
    EXPECT_EQ(consensus_->num_right(), 2);
    if (forget) {
      // As of a submap that is deleted.
      consensus_->ForgetAcceptedIf([](const LoopCandidate& candidate) {
        return candidate.submap.submap_index == 5;
      });
    }
    for (const int i : {10, 20, 30, 40}) consensus_->Add(Candidate(i));
    const std::vector<LoopCandidate> decided = consensus_->Decide();
    const size_t num_withdrawn = forget ? 1 : 2;
    ASSERT_EQ(decided.size(), num_withdrawn + 4);
    EXPECT_EQ(decided[0].number, forget ? 1 : 0);
    for (size_t i = 0; i < decided.size(); ++i) {
      EXPECT_EQ(decided[i].is_accepted(), i >= num_withdrawn);
    }
    EXPECT_EQ(decided[0].verdict, LoopDecision::UNDECIDED);
    EXPECT_EQ(decided[0].reason, LoopDecision::OVERTURNED);
    EXPECT_EQ(consensus_->NumWrong(), static_cast<int>(num_withdrawn));
    const std::vector<LoopCandidate> undecided = consensus_->Undecided();
    ASSERT_EQ(undecided.size(), num_withdrawn);
    EXPECT_EQ(undecided[0].reason, LoopDecision::OVERTURNED);
  }
}

TEST_F(LoopConsensusTest, WithdrawsWhereAConditionHolds) {
  const auto never = [](const LoopCandidate&) { return false; };
  EXPECT_THAT(consensus_->WithdrawIf([](const LoopCandidate&) { return true; }),
              testing::IsEmpty());
  for (const int i : {10, 20, 30}) consensus_->Add(Candidate(i));
  EXPECT_EQ(consensus_->Decide().size(), 3u);
  EXPECT_THAT(consensus_->WithdrawIf(never), testing::IsEmpty());
  const auto withdrawn =
      consensus_->WithdrawIf([](const LoopCandidate& candidate) {
        return candidate.submap.submap_index == 20;
      });
  ASSERT_EQ(withdrawn.size(), 1u);
  EXPECT_EQ(withdrawn[0].verdict, LoopDecision::UNDECIDED);
  EXPECT_EQ(withdrawn[0].reason, LoopDecision::OVERTURNED);
  EXPECT_EQ(consensus_->num_right(), 2);
  EXPECT_EQ(consensus_->num_undecided(), 1);
}

// Four candidates, accepted; two of them were expected elsewhere, one of these by
// the others as well.
TEST_F(LoopConsensusTest,
       PathsOverOthersRefuteCandidatesFarFromTheirPrediction) {
  for (const int i : {5, 15, 25, 35}) {
    LoopCandidate candidate = Candidate(i);
    candidate.plan.translation_sigma = 0.2;
    candidate.plan.rotation_sigma = 0.1;
    if (i == 15 || i == 25) candidate.predicted->x += 0.7;
    consensus_->Add(candidate);
  }
  EXPECT_EQ(consensus_->Decide().size(), 4u);
  LoopEnds asked;
  const std::vector<LoopCandidate> refuted =
      consensus_->Refute([&](const LoopEnds& ends) -> PathBetween {
        asked = ends;
        return [&](const uncertainty::VertexId& a,
                   const uncertainty::VertexId& b) {
          uncertainty::UncertainPose path;
          path.pose = Between(Truth(a.index()), Truth(b.index()));
          if (a.index() == 15) path.pose.x += 0.7;
          path.covariance = Eigen::Vector3d(0.01, 0.01, 1e-3).asDiagonal();
          return absl::optional<uncertainty::UncertainPose>(path);
        };
      });
  EXPECT_EQ(asked.size(), 2u);
  ASSERT_EQ(refuted.size(), 1u);
  EXPECT_EQ(refuted[0].number, 1);
  EXPECT_EQ(refuted[0].verdict, LoopDecision::UNDECIDED);
  EXPECT_EQ(refuted[0].reason, LoopDecision::OVERTURNED);
  // The record says by what.
  EXPECT_TRUE(refuted[0].innovation->vetoed);
  EXPECT_NEAR(refuted[0].innovation->innovation.x, 0.7, 1e-9);
  EXPECT_NEAR(*refuted[0].closed_sigma, 0.1, 1e-9);
  EXPECT_THAT(consensus_->Decide(RunState::kEndsUnalike), IsEmpty());
  EXPECT_EQ(consensus_->num_undecided(), 1);
  // Without suspects nobody is asked.
  EXPECT_THAT(consensus_->Refute([](const LoopEnds& ends) -> PathBetween {
    EXPECT_EQ(ends.size(), 1u);
    return [](const uncertainty::VertexId&, const uncertainty::VertexId&)
               -> absl::optional<uncertainty::UncertainPose> {
      return absl::nullopt;
    };
  }),
              IsEmpty());
}

// Densities of 0.05 as predicted and of 0.1 anywhere, half of the verified
// matches wrong: at most 0.5, which one revisit raises to odds of 1.8.
TEST_F(LoopConsensusTest, ScoresSayLittleWhereManyMatchesAreWrong) {
  for (const double share_wrong : {0., 0.5}) {
    consensus_.reset(new LoopConsensus(options_, &paths_));
    num_candidates_ = 0;
    for (const int i : {5, 25}) {
      LoopCandidate candidate = Candidate(i);
      candidate.fusion = ScoreFusionResult();
      candidate.fusion->final_score = 0.9;
      candidate.fusion->true_density = 0.05;
      candidate.fusion->search_density = 0.1;
      consensus_->Add(candidate);
    }
    consensus_->SetShareWrong(share_wrong);
    EXPECT_EQ(consensus_->Decide().size(), share_wrong == 0. ? 2u : 0u);
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
