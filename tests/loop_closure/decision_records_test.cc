// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_records.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(DecisionRecordsTest, GivesBackWhatWasAddedInOrder) {
  DecisionRecords records;
  EXPECT_TRUE(records.empty());
  EXPECT_TRUE(records.Parsed().empty());
  // More than one chunk.
  constexpr int kCount = 30000;
  for (int i = 0; i < kCount; ++i) {
    proto::LoopDecision decision;
    decision.set_candidate(i);
    decision.mutable_search()->set_grid_score(0.5 + i);
    decision.mutable_search()->mutable_refined()->set_x(0.25 * i);
    records.Add(decision);
  }
  ASSERT_EQ(records.size(), static_cast<size_t>(kCount));
  int next = 0;
  records.ForEach([&next](const proto::LoopDecision& decision) {
    ASSERT_EQ(decision.candidate(), next);
    ASSERT_EQ(decision.search().refined().x(), 0.25 * next);
    ++next;
  });
  EXPECT_EQ(next, kCount);
  EXPECT_EQ(records.Parsed().back().candidate(), kCount - 1);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
