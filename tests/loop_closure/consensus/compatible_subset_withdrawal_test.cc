// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Accepted loops that turn out wrong, and buildings where many matches are.
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/consensus/forth_and_back.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<int64_t> Withdrawn(const std::vector<SubsetDecision>& decisions) {
  std::vector<int64_t> ids;
  for (const SubsetDecision& decision : decisions) {
    if (decision.withdrawn) ids.push_back(decision.id);
  }
  return ids;
}

class WithdrawalTest : public ForthAndBackTest {
 protected:
  // Two wrong loops that agree with each other.
  void AddWrong(CompatibleSubset* const subset) const {
    subset->Add(ForthAndBackLoop(1, 10, 3., 0.6));
    subset->Add(ForthAndBackLoop(2, 30, 3., 0.6));
  }
  // Four right ones, which contradict them.
  void AddRight(CompatibleSubset* const subset) const {
    for (int i = 0; i < 4; ++i) {
      subset->Add(ForthAndBackLoop(3 + i, 20 + 20 * i, 0., 0.95));
    }
  }
};

TEST_F(WithdrawalTest, LoopsThatContradictTheSubsetAreWithdrawn) {
  CompatibleSubset subset(options_, &paths_);
  AddWrong(&subset);
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 2));
  EXPECT_THAT(subset.AcceptedLoops(), ElementsAre(1, 2));
  EXPECT_EQ(subset.num_undecided(), 0);
  AddRight(&subset);
  const std::vector<SubsetDecision> decisions = subset.Decide();
  EXPECT_THAT(Withdrawn(decisions), ElementsAre(1, 2));
  EXPECT_THAT(Accepted(decisions), ElementsAre(3, 4, 5, 6));
  // The withdrawn ones come first, with the reason.
  EXPECT_TRUE(decisions[0].withdrawn);
  EXPECT_FALSE(decisions[0].accepted);
  EXPECT_EQ(decisions[0].reason, SubsetReason::kOverturned);
  EXPECT_EQ(decisions[0].contradictions, 4);
  EXPECT_THAT(subset.AcceptedLoops(), ElementsAre(3, 4, 5, 6));
  // They wait, and are not withdrawn twice.
  EXPECT_EQ(subset.num_undecided(), 2);
  EXPECT_EQ(subset.Undecided()[0].reason, SubsetReason::kOverturned);
  EXPECT_THAT(subset.Decide(), IsEmpty());
  const std::vector<SubsetDecision> rest = subset.Flush();
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_EQ(rest[1].reason, SubsetReason::kOverturned);
  EXPECT_FALSE(rest[1].accepted);
}

TEST_F(WithdrawalTest, WithdrawnLoopsMayBeAcceptedAgain) {
  CompatibleSubset subset(options_, &paths_);
  AddWrong(&subset);
  subset.Decide();
  AddRight(&subset);
  subset.Decide();
  for (int i = 0; i < 8; ++i) {
    subset.Add(ForthAndBackLoop(10 + i, 5 + 12 * i, 3., 0.99));
  }
  const std::vector<SubsetDecision> decisions = subset.Decide();
  EXPECT_THAT(Withdrawn(decisions), ElementsAre(3, 4, 5, 6));
  const std::vector<int64_t> accepted = Accepted(decisions);
  ASSERT_EQ(accepted.size(), 10u);
  EXPECT_EQ(accepted[0], 1);
  EXPECT_EQ(accepted[1], 2);
}

TEST_F(WithdrawalTest, TheSubsetOfThePaperOnlyGrows) {
  options_.scores_are_probabilities = false;
  CompatibleSubset subset(options_, &paths_);
  AddWrong(&subset);
  subset.Decide();
  AddRight(&subset);
  EXPECT_THAT(Withdrawn(subset.Decide()), IsEmpty());
  EXPECT_EQ(subset.num_overturned(), 2);
}

TEST_F(WithdrawalTest, ForgottenLoopsStay) {
  CompatibleSubset subset(options_, &paths_);
  AddWrong(&subset);
  subset.Decide();
  subset.ForgetAcceptedLoops(
      [](const LoopEvidence& loop) { return loop.id == 1; });
  EXPECT_THAT(subset.AcceptedLoops(), ElementsAre(2));
  AddRight(&subset);
  EXPECT_THAT(Withdrawn(subset.Decide()), ElementsAre(2));
}

TEST_F(WithdrawalTest, RefutedLoopsAreNotAcceptedAgain) {
  options_.single_strong_enabled = true;
  options_.single_strong_loops = 10;
  CompatibleSubset subset(options_, &paths_);
  AddRight(&subset);
  EXPECT_EQ(Accepted(subset.Decide()).size(), 4u);
  const std::vector<SubsetDecision> refuted = subset.Refute({4, 6});
  EXPECT_THAT(Withdrawn(refuted), ElementsAre(4, 6));
  EXPECT_EQ(refuted[0].reason, SubsetReason::kOverturned);
  EXPECT_THAT(subset.AcceptedLoops(), ElementsAre(3, 5));
  // What makes them probable or confirms them does not help.
  for (const int64_t id : {4, 6}) {
    LoopEvidence loop;
    loop.id = id;
    loop.score = loop.probability = 0.999;
    subset.UpdateEvidence(loop);
  }
  subset.Add(ForthAndBackLoop(10, 10, 0., 0.95));
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEndsUnalike)), ElementsAre(10));
  for (const SubsetDecision& decision : subset.Undecided()) {
    EXPECT_EQ(decision.reason, SubsetReason::kOverturned);
  }
  EXPECT_THAT(subset.Refute({4, 99}), IsEmpty());
}

TEST_F(WithdrawalTest, CountsVerifiedLoops) {
  CompatibleSubset subset(options_, &paths_);
  for (const int64_t id : {1, 2}) {
    LoopEvidence loop =
        ForthAndBackLoop(id, 20 * static_cast<int>(id), 3., 0.6);
    loop.is_verified = id == 1;
    subset.Add(loop);
  }
  // Not known before they are compared.
  EXPECT_EQ(subset.num_right(), 0);
  EXPECT_EQ(subset.NumWrong(), 0);
  subset.Decide();
  EXPECT_EQ(subset.num_right(), 1);
  EXPECT_EQ(subset.NumWrong(), 0);
  AddRight(&subset);  // not verified
  subset.Decide();
  EXPECT_EQ(subset.num_right(), 0);
  EXPECT_EQ(subset.NumWrong(), 1);
}

// Odds of 1.5 and one revisit that agrees: times 3, or times
// 1 + 2 / (1 + 3 x 0.8) = 1.59.
TEST_F(WithdrawalTest, AgreementSaysLessWherePlacesLookAlike) {
  for (const double share_wrong : {0., 0.8}) {
    CompatibleSubset subset(options_, &paths_);
    subset.SetShareWrong(share_wrong);
    AddWrong(&subset);
    EXPECT_EQ(Accepted(subset.Decide()).size(), share_wrong == 0. ? 2u : 0u);
    AddRight(&subset);
    EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(3, 4, 5, 6));
  }
}

// In a window of 5 cm any two matches agree.
TEST_F(WithdrawalTest, NarrowSearchesConfirmNobody) {
  for (const double window : {0.05, 5.}) {
    for (const bool probabilities : {false, true}) {
      options_.scores_are_probabilities = probabilities;
      CompatibleSubset subset(options_, &paths_);
      for (const int64_t id : {1, 2}) {
        LoopEvidence loop =
            ForthAndBackLoop(id, 20 * static_cast<int>(id), 0., 0.6);
        if (id == 1) loop.linear_window = window;
        subset.Add(loop);
      }
      const bool confirmed = !probabilities || window == 5.;
      EXPECT_EQ(Accepted(subset.Decide()).size(), confirmed ? 2u : 0u);
    }
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
