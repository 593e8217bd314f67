// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <vector>

#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/consensus/forth_and_back.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class CompatibleSubsetEndTest : public testing::Test {
 protected:
  CompatibleSubsetEndTest() : paths_(uncertainty::RandomWalk(), 1000) {
    for (int i = 0; i <= 200; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, ForthAndBack(i));
    }
  }

  // A badly predicted loop between the place of node i forth and back.
  static LoopEvidence Last(int64_t id, int i, double probability) {
    LoopEvidence loop = ForthAndBackLoop(id, i, 0., 0.6);
    loop.prior_sigma = 2.;
    loop.probability = probability;
    return loop;
  }

  CompatibleSubsetOptions options_;
  uncertainty::PathUncertainty paths_;
};

TEST_F(CompatibleSubsetEndTest, ProbableLoopsAreAccepted) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Last(0, 2, 0.89));
  subset.Add(Last(1, 1, 0.95));
  subset.Add(Last(2, 0, 0.9));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  const auto decisions = subset.Decide(RunState::kEnds);
  EXPECT_THAT(Accepted(decisions), ElementsAre(1, 2));
  EXPECT_EQ(decisions[0].reason, SubsetReason::kLikelyAtEnd);
  EXPECT_EQ(subset.num_undecided(), 1);
  // The run goes on.
  subset.Add(Last(3, 3, 0.5));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(0, 3));

  // Not so where another hypothesis for the same nodes waits, ...
  CompatibleSubset contested(options_, &paths_);
  contested.Add(Last(0, 10, 0.99));
  LoopEvidence rival = Last(1, 10, 0.99);
  rival.edge.pose.pose.x += 12.;
  contested.Add(rival);
  EXPECT_THAT(Accepted(contested.Decide(RunState::kEnds)), IsEmpty());
  // ... where nothing predicted it, ...
  CompatibleSubset unpredicted(options_, &paths_);
  LoopEvidence loop = Last(0, 10, 0.99);
  loop.prior_sigma = std::numeric_limits<double>::infinity();
  unpredicted.Add(loop);
  EXPECT_THAT(Accepted(unpredicted.Decide(RunState::kEnds)), IsEmpty());
  // ... and in the literal subset of the paper.
  options_.single_strong_enabled = false;
  CompatibleSubset literal(options_, &paths_);
  literal.Add(Last(0, 10, 0.99));
  EXPECT_THAT(Accepted(literal.Decide(RunState::kEnds)), IsEmpty());
}

TEST_F(CompatibleSubsetEndTest, ProbableLoopsOfAConfirmedRevisitAreAccepted) {
  options_.scores_are_probabilities = true;
  options_.weak_prior_revisits = 2;
  CompatibleSubset subset(options_, &paths_);
  const auto add = [&subset](const int64_t id, const int i, const double score,
                             const double probability) {
    LoopEvidence loop = Last(id, i, probability);
    loop.score = score;
    subset.Add(loop);
  };
  // Two revisits confirm each other; the second loop of each scores badly.
  add(0, 10, 0.9, 0.5);
  add(1, 11, 0.05, 0.89);
  add(2, 25, 0.9, 0.5);
  add(3, 26, 0.05, 0.9);
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(0, 2));
  const auto at_end = subset.Decide(RunState::kEnds);
  EXPECT_THAT(Accepted(at_end), ElementsAre(3));
  EXPECT_EQ(at_end[0].reason, SubsetReason::kLikelyAtEnd);
  EXPECT_EQ(subset.num_undecided(), 1);
}

// Where no match of the run was wrong, fewer loops need agree in a weak prior.
class FarOffTest : public CompatibleSubsetEndTest {
 protected:
  FarOffTest() { options_.scores_are_probabilities = true; }

  static LoopEvidence Strong(int i, double score) {
    LoopEvidence loop = Last(i, i, 0.1);
    loop.score = score;
    return loop;
  }
};

TEST_F(FarOffTest, TwoRevisitsAreEnough) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Strong(10, 0.9));  // odds 9 x 3
  subset.Add(Strong(25, 0.8));  // 4 x 3
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEnds)), IsEmpty());
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEndsUnalike)), ElementsAre(10));
  // After one that was right 4 x 3 x 2.
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEndsUnalike)), ElementsAre(25));
}

TEST_F(FarOffTest, NotIfAnotherMatchWasWrong) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Strong(10, 0.9));
  subset.Add(Strong(25, 0.9));
  LoopEvidence wrong = Strong(70, 0.6);
  wrong.edge.pose.pose.x += 12.;
  subset.Add(wrong);
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEndsUnalike)), IsEmpty());
}

TEST_F(FarOffTest, ASingleOneAfterThreeThatWereRight) {
  // Far apart: none supports another.
  options_.informative_sigma = 1e-3;
  for (const int num_right : {2, 3}) {
    CompatibleSubset subset(options_, &paths_);
    for (int i = 0; i < num_right; ++i) {
      LoopEvidence loop = Strong(15 * i, 0.6);
      loop.probability = 0.95;
      subset.Add(loop);
    }
    EXPECT_EQ(Accepted(subset.Decide(RunState::kEnds)).size(),
              static_cast<size_t>(num_right));
    subset.Add(Strong(60, 0.8));   // 4 x 4
    subset.Add(Strong(75, 0.85));  // 5.7 x 4
    const auto accepted = Accepted(subset.Decide(RunState::kEndsUnalike));
    if (num_right == 3) {
      EXPECT_THAT(accepted, ElementsAre(75));
    } else {
      EXPECT_THAT(accepted, IsEmpty());
    }
  }
}

TEST_F(FarOffTest, NeighboursDecideAboutASingleOne) {
  options_.informative_sigma = 1e-3;
  for (const double score_of_wrong : {0.2, 0.7}) {
    CompatibleSubset subset(options_, &paths_);
    LoopEvidence loop = Strong(10, 0.7);
    LoopEvidence wrong = Strong(70, 0.6);
    wrong.edge.pose.pose.x += 12.;
    subset.Add(loop);
    subset.Add(wrong);
    EXPECT_THAT(Accepted(subset.Decide(RunState::kEndsUnalike)), IsEmpty());
    loop.score = 0.96;
    loop.odds_of_neighbours = 10.;
    wrong.score = score_of_wrong;
    subset.UpdateEvidence(loop);
    subset.UpdateEvidence(wrong);
    // Unless the other one, whose neighbours match, too, tells of places that
    // look alike.
    const auto accepted = Accepted(subset.Decide(RunState::kEndsUnalike));
    if (score_of_wrong < 0.5) {
      EXPECT_THAT(accepted, ElementsAre(10));
    } else {
      EXPECT_THAT(accepted, IsEmpty());
    }
  }
  // A high score alone does not.
  CompatibleSubset alone(options_, &paths_);
  alone.Add(Strong(10, 0.96));
  EXPECT_THAT(Accepted(alone.Decide(RunState::kEndsUnalike)), IsEmpty());
}

// Loops accepted meanwhile predict a place better: then fewer need agree.
TEST_F(CompatibleSubsetEndTest, BetterPredictedLoopsNeedLessSupport) {
  CompatibleSubset subset(options_, &paths_);
  // Two revisits: one fewer than badly predicted ones need.
  subset.Add(Last(0, 10, 0.2));
  subset.Add(Last(1, 25, 0.2));
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEnds)), IsEmpty());
  LoopEvidence known = Last(0, 10, 0.3);
  known.prior_sigma = 0.8;
  subset.UpdateEvidence(known);
  const auto decisions = subset.Decide(RunState::kEnds);
  EXPECT_THAT(Accepted(decisions), ElementsAre(0));
  EXPECT_EQ(decisions[0].reason, SubsetReason::kSupported);
  // Nothing happens to a loop that is decided.
  subset.UpdateEvidence(known);
  EXPECT_THAT(subset.Decide(RunState::kEnds), IsEmpty());
  // A probable loop needs none.
  known = Last(1, 25, 0.95);
  subset.UpdateEvidence(known);
  EXPECT_THAT(Accepted(subset.Decide(RunState::kEnds)), ElementsAre(1));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
