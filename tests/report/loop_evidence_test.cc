// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/loop_evidence.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/report/report_example.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::LoopVerdict;
using testing::HasSubstr;
using testing::Not;

TEST(LoopEvidenceTest, LoopsFirstThenRefusedCandidates) {
  const ReportData data = test::ExampleData(true);
  const auto stored = CollectEvidence(data.runs[0], *data.contents);
  ASSERT_EQ(stored.size(), 3u);
  EXPECT_TRUE(stored[0].in_graph);
  EXPECT_TRUE(stored[0].accepted);
  EXPECT_EQ(stored[0].decision, nullptr);
  // Neither scan nor grid.
  EXPECT_EQ(stored[0].score, -1.);
  EXPECT_NEAR(stored[0].residual_translation, 0., 1e-12);
  EXPECT_NEAR(stored[1].residual_translation, 2., 1e-12);
  EXPECT_FALSE(stored[0].suspicious());
  EXPECT_TRUE(stored[1].suspicious());
  EXPECT_NEAR(stored[1].badness(), 2., 1e-12);

  const auto ours = CollectEvidence(data.runs[1], *data.contents);
  // Two loops are left; the candidate without a pose is none.
  ASSERT_EQ(ours.size(), 3u);
  ASSERT_NE(ours[0].decision, nullptr);
  EXPECT_EQ(ours[0].decision->reason(),
            proto::LoopDecision::CONFIRMED_BY_SUBSET);
  EXPECT_EQ(ours[1].decision, nullptr);
  EXPECT_FALSE(ours[2].accepted);
  EXPECT_FALSE(ours[2].in_graph);
  EXPECT_EQ(ours[2].submap_id, (evaluation::GraphId{0, 1}));
  EXPECT_EQ(ours[2].relative_pose.x, 7.);
  EXPECT_NEAR(ours[2].score, 0.6, 1e-12);
  EXPECT_FALSE(ours[2].suspicious());
}

TEST(LoopEvidenceTest, TruthGoesBeforeTheMap) {
  LoopEvidence evidence;
  evidence.in_graph = true;
  evidence.residual_translation = 3.;
  evidence.truth = LoopVerdict::kCorrect;
  evidence.truth_translation = 0.1;
  EXPECT_FALSE(evidence.suspicious());
  EXPECT_EQ(evidence.badness(), 0.1);
  evidence.truth = LoopVerdict::kWrong;
  evidence.residual_translation = 0.;
  EXPECT_TRUE(evidence.suspicious());
}

TEST(LoopEvidenceTest, CyclesCount) {
  ReportData data = test::ExampleData(false);
  data.runs[0].evaluation.consistency = test::ExampleConsistency();
  const auto evidence = CollectEvidence(data.runs[0], *data.contents);
  EXPECT_EQ(evidence[1].partners, 2);
  EXPECT_EQ(evidence[1].open_share, 0.5);
  EXPECT_THAT(Describe(evidence[1]), HasSubstr("50 % of 2 cycles are open"));
}

TEST(LoopEvidenceTest, VerdictsInWords) {
  proto::LoopDecision decision;
  EXPECT_EQ(VerdictInWords(decision), "undecided at the end");
  decision.set_verdict(proto::LoopDecision::ACCEPTED);
  decision.set_reason(proto::LoopDecision::SINGLE_STRONG);
  EXPECT_EQ(VerdictInWords(decision), "accepted: single strong");
  decision.set_verdict(proto::LoopDecision::REJECTED);
  decision.set_reason(proto::LoopDecision::LOW_TEMPORAL_SCORE);
  EXPECT_EQ(VerdictInWords(decision), "rejected: low temporal score");
  decision.set_reason(proto::LoopDecision::SKIPPED_BUDGET);
  EXPECT_EQ(VerdictInWords(decision), "not searched: budget");
  // Of a later version.
  EXPECT_EQ(ReasonInWords(static_cast<proto::LoopDecision::Reason>(999)),
            "reason 999");
}

TEST(LoopEvidenceTest, DescribesWhatIsKnown) {
  const ReportData data = test::ExampleData(true);
  const auto evidence = CollectEvidence(data.runs[1], *data.contents);
  const std::string accepted = Describe(evidence[0]);
  EXPECT_THAT(accepted, HasSubstr("submap (0, 0) - node (0, 2)"));
  EXPECT_THAT(accepted, HasSubstr("residual in the map 0.00 m, 0.0 deg"));
  EXPECT_THAT(accepted, HasSubstr("temporal score 0.900, threshold 0.400"));
  EXPECT_THAT(accepted, HasSubstr("fused score 0.950"));
  EXPECT_THAT(accepted, HasSubstr("3 revisits support, 0 contradict"));
  EXPECT_THAT(accepted, Not(HasSubstr("score on the grid")));
  EXPECT_THAT(accepted, Not(HasSubstr("truth")));
  const std::string rejected = Describe(evidence[2]);
  EXPECT_THAT(rejected, HasSubstr("node (0, 4), rejected"));
  EXPECT_THAT(rejected, HasSubstr("score on the grid 0.600"));
  EXPECT_THAT(rejected, HasSubstr("rejected: low temporal score"));
  EXPECT_THAT(rejected, Not(HasSubstr("residual in the map")));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
