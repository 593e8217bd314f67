// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Damaged records of loop closure: reading them, and making a table of what was
// read, must return.
#include <string>

#include "cartographer_ext/loop_closure/decision_log.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(DecisionFuzzTest, DamagedRecordsReturn) {
  std::string sample;
  for (int i = 0; i < 8; ++i) {
    proto::LoopDecision decision;
    decision.set_candidate(i);
    decision.set_submap_index(4);
    decision.set_node_index(17 + i);
    decision.set_node_time(INT64_C(632633154295951823));
    decision.set_verdict(i % 2 == 0 ? proto::LoopDecision::ACCEPTED
                                    : proto::LoopDecision::REJECTED);
    decision.set_reason(proto::LoopDecision::LOW_TEMPORAL_SCORE);
    decision.mutable_search()->set_grid_score(0.625);
    decision.mutable_temporal()->set_score(0.25);
    decision.mutable_temporal()->set_threshold(0.5);
    AppendDecision(decision, &sample);
  }
  int accepted = 0;
  test::ForEachMutation(sample, [&accepted](const std::string& damaged) {
    const auto decisions = ParseDecisions(damaged);
    if (!decisions.ok()) return;
    ++accepted;
    EXPECT_FALSE(DecisionCsv(*decisions).empty());
  });
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, test::FuzzIterations());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
