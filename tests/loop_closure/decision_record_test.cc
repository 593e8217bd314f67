// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_record.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

TEST(DecisionRecordTest, StagesThatWereNotReachedAreUnset) {
  LoopCandidate candidate;
  candidate.number = 7;
  candidate.submap = uncertainty::SubmapId{1, 2};
  candidate.node = uncertainty::NodeId{3, 4};
  candidate.node_time = 5;
  candidate.plan.linear_window = 2.;
  candidate.Reject(LoopDecision::SKIPPED_BUDGET);
  const LoopDecision record = MakeDecisionRecord(candidate, false);
  EXPECT_EQ(record.candidate(), 7);
  EXPECT_EQ(record.submap_trajectory_id(), 1);
  EXPECT_EQ(record.submap_index(), 2);
  EXPECT_EQ(record.node_trajectory_id(), 3);
  EXPECT_EQ(record.node_index(), 4);
  EXPECT_EQ(record.node_time(), 5);
  EXPECT_EQ(record.verdict(), LoopDecision::REJECTED);
  EXPECT_EQ(record.reason(), LoopDecision::SKIPPED_BUDGET);
  EXPECT_EQ(record.search().linear_window(), 2.);
  EXPECT_FALSE(record.search().has_predicted());
  EXPECT_FALSE(record.search().has_refined());
  EXPECT_FALSE(record.has_temporal());
  EXPECT_FALSE(record.has_fusion());
  EXPECT_FALSE(record.has_innovation());
  EXPECT_FALSE(record.has_information());
  EXPECT_FALSE(record.has_subset());
  EXPECT_FALSE(record.has_times());
}

TEST(DecisionRecordTest, EveryStageHasItsMessage) {
  LoopCandidate candidate;
  // A node frame that is turned by a right angle against the robot.
  candidate.aligned_from_tracking = Pose2(0., 0., 0.5 * kPi);
  candidate.predicted = Pose2(1., 2., 0.);
  candidate.match.found = true;
  candidate.match.has_pose = true;
  candidate.match.score = 0.7;
  candidate.match.refined = Pose2(3., 4., 0.25 * kPi);
  candidate.match.information = Eigen::Vector3d(1., 2., 3.).asDiagonal();
  candidate.temporal = TemporalScore();
  candidate.temporal->result.outcome = TemporalOutcome::kScored;
  candidate.temporal->result.score = 0.8;
  candidate.temporal->threshold = 0.5;
  candidate.fusion = ScoreFusionResult();
  candidate.fusion->final_score = 0.9;
  candidate.fusion->probability = 0.75;
  candidate.fusion->mixture = std::array<MixtureDescription, 2>();
  (*candidate.fusion->mixture)[1].mean_grid = 0.6;
  candidate.innovation = InnovationResult();
  candidate.innovation->bound = 21.;
  candidate.weights = ConstraintWeights{100., 200.};
  candidate.consensus = ConsensusResult();
  candidate.consensus->num_tests = 4;
  candidate.times.search = 0.25;
  candidate.Accept(LoopDecision::SINGLE_STRONG);
  const LoopDecision record = MakeDecisionRecord(candidate, true);
  EXPECT_EQ(record.verdict(), LoopDecision::ACCEPTED);
  EXPECT_EQ(record.search().grid_score(), 0.7);
  EXPECT_DOUBLE_EQ(record.search().predicted().theta(), 0.5 * kPi);
  EXPECT_EQ(record.search().refined().x(), 3.);
  EXPECT_DOUBLE_EQ(record.search().refined().theta(), 0.75 * kPi);
  EXPECT_EQ(record.temporal().score(), 0.8);
  EXPECT_EQ(record.temporal().threshold(), 0.5);
  EXPECT_EQ(record.fusion().final_score(), 0.9);
  EXPECT_EQ(record.fusion().probability(), 0.75);
  EXPECT_EQ(record.fusion().true_loops().mean_grid(), 0.6);
  EXPECT_EQ(record.innovation().bound(), 21.);
  EXPECT_EQ(record.information().rotation_weight(), 200.);
  ASSERT_EQ(record.information().matrix_size(), 6);
  EXPECT_EQ(record.information().matrix(3), 2.);
  EXPECT_EQ(record.subset().num_tests(), 4);
  EXPECT_EQ(record.times().search_seconds(), 0.25);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
