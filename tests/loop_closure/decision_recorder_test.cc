// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_recorder.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

DecisionRecorder::Decisions Some(const int first, const int count) {
  DecisionRecorder::Decisions decisions(count);
  for (int i = 0; i < count; ++i) decisions[i].set_candidate(first + i);
  return decisions;
}

TEST(DecisionRecorderTest, KeepsNothingBeforeTheStart) {
  DecisionRecorder recorder;
  EXPECT_FALSE(recorder.started());
  recorder.Record(Some(0, 3));
  EXPECT_TRUE(recorder.All().empty());
  recorder.Start(10);
  EXPECT_TRUE(recorder.started());
  recorder.Record(Some(3, 2));
  recorder.Stop();
  recorder.Record(Some(5, 2));
  ASSERT_EQ(recorder.All().size(), 2u);
  EXPECT_EQ(recorder.All()[0].candidate(), 3);
  recorder.Start(10);
  EXPECT_TRUE(recorder.All().empty());
}

TEST(DecisionRecorderTest, CountsBeyondItsCapacity) {
  DecisionRecorder recorder;
  recorder.Start(4);
  recorder.Record(Some(0, 3));
  recorder.Record(Some(3, 3));
  recorder.Record(Some(6, 1));
  EXPECT_EQ(recorder.All().size(), 4u);
  EXPECT_EQ(recorder.All().back().candidate(), 3);
  EXPECT_EQ(recorder.num_dropped(), 3);
}

// A loop that was withdrawn is undecided, or decided again.
TEST(DecisionRecorderTest, OfSeveralRecordsOfACandidateTheLastCounts) {
  DecisionRecorder recorder;
  recorder.Start(100);
  DecisionRecorder::Decisions first = Some(0, 3);
  for (proto::LoopDecision& decision : first) {
    decision.set_verdict(proto::LoopDecision::ACCEPTED);
  }
  recorder.Record(first);
  DecisionRecorder::Decisions withdrawn = Some(1, 1);
  withdrawn[0].set_verdict(proto::LoopDecision::UNDECIDED);
  recorder.Record(withdrawn);
  DecisionRecorder::Decisions pending = Some(1, 1);
  pending[0].set_reason(proto::LoopDecision::OVERTURNED);
  recorder.AddPending([&] { return pending; });
  const DecisionRecorder::Decisions all = recorder.All();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].candidate(), 0);
  EXPECT_EQ(all[1].candidate(), 2);
  EXPECT_EQ(all[2].candidate(), 1);
  EXPECT_EQ(all[2].reason(), proto::LoopDecision::OVERTURNED);
}

// Of a loop that the finished map contradicts what was accepted is rejected,
// whatever else was decided about its submap and node.
TEST(DecisionRecorderTest, LoopsOffTheMapAreTakenBack) {
  DecisionRecorder recorder;
  recorder.Start(100);
  DecisionRecorder::Decisions decisions = Some(0, 4);
  for (proto::LoopDecision& decision : decisions) {
    decision.set_verdict(proto::LoopDecision::ACCEPTED);
    decision.set_submap_index(3);
    decision.set_node_index(decision.candidate() < 2 ? 20 : 30);
  }
  decisions[0].set_verdict(proto::LoopDecision::REJECTED);
  decisions[0].set_reason(proto::LoopDecision::LOW_GRID_SCORE);
  recorder.Record(decisions);
  recorder.TakeBack({});
  EXPECT_EQ(recorder.All().size(), 4u);
  LoopId loop;
  loop.submap_index = 3;
  loop.node_index = 20;
  recorder.TakeBack({loop});
  recorder.TakeBack({loop});  // nothing is left
  const DecisionRecorder::Decisions all = recorder.All();
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].reason(), proto::LoopDecision::LOW_GRID_SCORE);
  EXPECT_EQ(all[1].verdict(), proto::LoopDecision::ACCEPTED);
  EXPECT_EQ(all[2].verdict(), proto::LoopDecision::ACCEPTED);
  EXPECT_EQ(all[3].candidate(), 1);
  EXPECT_EQ(all[3].verdict(), proto::LoopDecision::REJECTED);
  EXPECT_EQ(all[3].reason(), proto::LoopDecision::OFF_MAP);
}

TEST(DecisionRecorderTest, ManyRecordsComeBackUnchanged) {
  // Several megabytes.
  constexpr int kCount = 20000;
  DecisionRecorder::Decisions decisions = Some(0, kCount);
  for (proto::LoopDecision& decision : decisions) {
    decision.mutable_fusion()->set_final_score(1. / (decision.candidate() + 3));
    decision.mutable_temporal()->set_score(std::sqrt(decision.candidate()));
    decision.mutable_innovation()->set_chi_square(1e300);
  }
  DecisionRecorder recorder;
  recorder.Start(2 * kCount);
  recorder.Record(decisions);
  DecisionRecorder::Decisions more = decisions;
  for (proto::LoopDecision& decision : more) {
    decision.set_candidate(decision.candidate() + kCount);
  }
  recorder.Record(more);
  const DecisionRecorder::Decisions all = recorder.All();
  ASSERT_EQ(all.size(), 2u * kCount);
  for (int i = 0; i < 2 * kCount; ++i) {
    ASSERT_EQ(all[i].SerializeAsString(),
              (i < kCount ? decisions : more)[i % kCount].SerializeAsString());
  }
}

TEST(DecisionRecorderTest, AsksForWhatIsPending) {
  DecisionRecorder recorder;
  recorder.Start(10);
  recorder.Record(Some(0, 1));
  const int64_t first = recorder.AddPending([]() { return Some(10, 2); });
  recorder.AddPending([]() { return Some(20, 1); });
  ASSERT_EQ(recorder.All().size(), 4u);
  EXPECT_EQ(recorder.All()[1].candidate(), 10);
  EXPECT_EQ(recorder.All()[3].candidate(), 20);
  recorder.RemovePending(first);
  EXPECT_EQ(recorder.All().size(), 2u);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
