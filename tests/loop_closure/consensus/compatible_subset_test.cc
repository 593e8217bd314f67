// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/compatible_subset.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/consensus/forth_and_back.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Trajectory 1 repeats the way in a frame of its own.
class CompatibleSubsetTest : public testing::Test {
 protected:
  CompatibleSubsetTest() : paths_(uncertainty::RandomWalk(), 1000) {
    options_.single_strong_enabled = false;
    for (int i = 0; i <= 200; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, ForthAndBack(i));
      paths_.Add(uncertainty::NodeId{1, i},
                 Pose2(7., -3., 1.) * ForthAndBack(i));
    }
  }

  // See forth_and_back.h.
  static LoopEvidence Loop(int64_t id, int i, double offset,
                           double score = 0.6) {
    return ForthAndBackLoop(id, i, offset, score);
  }

  CompatibleSubsetOptions options_;
  uncertainty::PathUncertainty paths_;
};

TEST_F(CompatibleSubsetTest, TwoRevisitsConfirmEachOther) {
  CompatibleSubset subset(options_, &paths_);
  EXPECT_THAT(subset.Decide(), IsEmpty());
  subset.Add(Loop(1, 10, 0.));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  EXPECT_EQ(subset.num_undecided(), 1);
  subset.Add(Loop(2, 30, 0.));
  const auto decisions = subset.Decide();
  EXPECT_THAT(Accepted(decisions), ElementsAre(1, 2));
  EXPECT_EQ(decisions[0].reason, SubsetReason::kSupported);
  EXPECT_EQ(decisions[0].support, 1);
  EXPECT_EQ(decisions[0].subset_size, 2);
  EXPECT_EQ(subset.num_undecided(), 0);
  EXPECT_EQ(subset.num_clusters(), 2);
  // What belongs to an accepted revisit follows at once.
  subset.Add(Loop(3, 12, 0.));
  const auto joining = subset.Decide();
  EXPECT_THAT(Accepted(joining), ElementsAre(3));
  EXPECT_EQ(joining[0].reason, SubsetReason::kJoinsAccepted);
  EXPECT_THAT(subset.Decide(), IsEmpty());
  EXPECT_THAT(subset.Flush(), IsEmpty());
}

TEST_F(CompatibleSubsetTest, UnlikelyLoopsConfirmNobody) {
  for (const bool probabilities : {false, true}) {
    options_.scores_are_probabilities = probabilities;
    CompatibleSubset subset(options_, &paths_);
    subset.Add(Loop(1, 10, 0., 0.3));
    subset.Add(Loop(2, 30, 0., 0.3));
    EXPECT_EQ(Accepted(subset.Decide()).size(), probabilities ? 0u : 2u);
  }
}

// Each counts as 1 + ln(0.4 / 0.6) / ln 3 = 0.63: of three the odds rise to
// 2/3 x 3^1.26 = 2.7, of four to 2/3 x 3^1.89 = 5.3.
TEST_F(CompatibleSubsetTest, RatherUnlikelyLoopsConfirmEachOtherInPart) {
  options_.scores_are_probabilities = true;
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 0., 0.4));
  subset.Add(Loop(2, 30, 0., 0.4));
  subset.Add(Loop(3, 50, 0., 0.4));
  EXPECT_THAT(Accepted(subset.Decide()), IsEmpty());
  EXPECT_EQ(subset.Undecided()[0].support, 1);
  subset.Add(Loop(4, 70, 0., 0.4));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 2, 3, 4));
  // Any number of those with the odds 1 / 3.5.
  CompatibleSubset unlikely(options_, &paths_);
  for (int i = 0; i < 8; ++i) {
    unlikely.Add(Loop(i, 10 + 10 * i, 0., 1. / 4.5));
  }
  EXPECT_THAT(Accepted(unlikely.Decide()), IsEmpty());
  EXPECT_EQ(unlikely.Undecided()[0].support, 0);
}

TEST_F(CompatibleSubsetTest, TheLessLikelyTheMoreRevisitsHaveToAgree) {
  options_.scores_are_probabilities = true;
  CompatibleSubset subset(options_, &paths_);
  // Odds of 1/3, which two revisits raise to 3.
  subset.Add(Loop(1, 10, 0., 0.25));
  subset.Add(Loop(2, 30, 0., 0.9));
  EXPECT_THAT(Accepted(subset.Decide()), IsEmpty());
  subset.Add(Loop(3, 50, 0., 0.9));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 2, 3));
  // Further ones are not independent: odds of 1/19 stay below.
  subset.Add(Loop(4, 70, 0., 0.05));
  EXPECT_THAT(Accepted(subset.Decide()), IsEmpty());
  const auto decisions = subset.Flush();
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_EQ(decisions[0].reason, SubsetReason::kUnsupported);
}

TEST_F(CompatibleSubsetTest, OneThatScoresFarWorseIsNoRival) {
  for (const bool probabilities : {false, true}) {
    options_.scores_are_probabilities = probabilities;
    options_.single_strong_enabled = true;
    CompatibleSubset subset(options_, &paths_);
    subset.Add(Loop(1, 60, 8., 0.3));
    for (int i = 0; i < 4; ++i) subset.Add(Loop(10 + i, 60 + i, 0., 0.95));
    EXPECT_EQ(Accepted(subset.Decide()).size(), probabilities ? 4u : 0u);
  }
}

TEST_F(CompatibleSubsetTest, NeighbouringNodesAreOnePieceOfEvidence) {
  CompatibleSubset subset(options_, &paths_);
  for (int i = 0; i < 8; ++i) subset.Add(Loop(i, 10 + i, 0.));
  EXPECT_EQ(subset.num_clusters(), 1);
  EXPECT_THAT(subset.Decide(), IsEmpty());
  const auto decisions = subset.Flush();
  ASSERT_EQ(decisions.size(), 8u);
  EXPECT_THAT(Accepted(decisions), IsEmpty());
  EXPECT_EQ(decisions[0].reason, SubsetReason::kUnsupported);
  EXPECT_EQ(subset.num_clusters(), 0);
}

TEST_F(CompatibleSubsetTest, BetweenRunsPlacesCountNotSubmaps) {
  CompatibleSubset subset(options_, &paths_);
  // Node i of run 1 in the submap that begins at node a of run 0.
  const auto found = [this](const int64_t id, const int a, const int i,
                            const double prior_sigma) {
    LoopEvidence loop = Loop(id, a, 0.);
    loop.edge.b = uncertainty::NodeId{1, i};
    loop.edge.pose.pose = Between(ForthAndBack(a), ForthAndBack(i));
    loop.prior_sigma = prior_sigma;
    return loop;
  };
  const double unknown = std::numeric_limits<double>::infinity();
  // One node in four submaps is one place.
  for (int s = 0; s < 4; ++s) subset.Add(found(s, 20 * s, 30, unknown));
  EXPECT_EQ(subset.num_clusters(), 4);
  EXPECT_THAT(subset.Decide(), IsEmpty());
  // Three places are needed where nothing was predicted.
  subset.Add(found(4, 20, 45, unknown));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  subset.Add(found(5, 40, 60, unknown));
  const auto decisions = subset.Decide();
  EXPECT_THAT(Accepted(decisions), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(decisions[0].support, 2);
}

TEST_F(CompatibleSubsetTest, ForgottenLoopsNoLongerCount) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 0.));
  subset.Add(Loop(2, 30, 0.));
  EXPECT_EQ(subset.Decide().size(), 2u);
  subset.Add(Loop(3, 31, 0.));
  subset.ForgetAccepted(
      [](const LoopEvidence& loop) { return loop.edge.a.index() < 20; });
  EXPECT_EQ(subset.num_clusters(), 1);
  subset.ForgetAccepted([](const LoopEvidence&) { return true; });
  // What still waits is no longer accepted for its company.
  EXPECT_EQ(subset.num_clusters(), 1);
  EXPECT_THAT(Accepted(subset.Decide()), IsEmpty());
  EXPECT_EQ(subset.num_undecided(), 1);
  // Nor does another one join it.
  subset.Add(Loop(4, 31, 0.));
  EXPECT_THAT(Accepted(subset.Decide()), IsEmpty());
}

TEST_F(CompatibleSubsetTest, BadlyPredictedPlacesNeedMore) {
  options_.single_strong_enabled = true;
  CompatibleSubset subset(options_, &paths_);
  const auto doubtful = [this](const int64_t id, const int i) {
    LoopEvidence loop = Loop(id, i, 0., 0.9);
    loop.prior_sigma = 2.;
    return loop;
  };
  // Three strong loops of one revisit, but nobody knew where to look.
  for (int i = 0; i < 3; ++i) subset.Add(doubtful(i, 10 + i));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  // Two revisits are not enough, either, and it says what it waits for.
  subset.Add(doubtful(3, 30));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  const auto waiting = subset.Undecided();
  ASSERT_EQ(waiting.size(), 4u);
  EXPECT_EQ(waiting[3].id, 3);
  EXPECT_EQ(waiting[3].reason, SubsetReason::kUnsupported);
  EXPECT_EQ(waiting[3].support, 1);
  EXPECT_EQ(subset.num_undecided(), 4);
  subset.Add(doubtful(4, 50));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(subset.Undecided(), IsEmpty());
}

TEST_F(CompatibleSubsetTest, SingleStrongLoopHasItsOwnRule) {
  options_.single_strong_enabled = true;
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(0, 10, 0., 0.9));
  subset.Add(Loop(1, 11, 0., 0.6));
  EXPECT_THAT(subset.Decide(), IsEmpty());  // two loops are not three
  subset.Add(Loop(2, 12, 0., 0.6));
  const auto decisions = subset.Decide();
  EXPECT_THAT(Accepted(decisions), ElementsAre(0, 1, 2));
  EXPECT_EQ(decisions[0].reason, SubsetReason::kSingleStrong);

  CompatibleSubset weak(options_, &paths_);
  for (int i = 0; i < 3; ++i) weak.Add(Loop(i, 10 + i, 0., 0.79));
  EXPECT_THAT(weak.Decide(), IsEmpty());

  // Contradicted by another hypothesis for the same nodes.
  CompatibleSubset contested(options_, &paths_);
  for (int i = 0; i < 3; ++i) contested.Add(Loop(i, 10 + i, 0., 0.9));
  contested.Add(Loop(3, 10, 3., 0.9));
  EXPECT_THAT(contested.Decide(), IsEmpty());
}

TEST_F(CompatibleSubsetTest, FalseLoopIsKeptOutAndRejectedAtTheEnd) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 0.));
  subset.Add(Loop(2, 20, 5.));
  subset.Add(Loop(3, 30, 0.));
  subset.Add(Loop(4, 45, 0.));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 3, 4));
  EXPECT_EQ(subset.num_undecided(), 1);
  const auto decisions = subset.Flush();
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_EQ(decisions[0].id, 2);
  EXPECT_FALSE(decisions[0].accepted);
  EXPECT_EQ(decisions[0].reason, SubsetReason::kContradicted);
  EXPECT_GE(decisions[0].contradictions, 2);
}

TEST_F(CompatibleSubsetTest, RivalsWaitForMoreEvidence) {
  CompatibleSubset subset(options_, &paths_);
  // Two hypotheses, each consistent in itself.
  subset.Add(Loop(1, 10, 4.));
  subset.Add(Loop(2, 22, 4.));
  subset.Add(Loop(3, 10, 0.));
  subset.Add(Loop(4, 22, 0.));
  EXPECT_EQ(subset.num_clusters(), 4);
  EXPECT_THAT(subset.Decide(), IsEmpty());
  EXPECT_EQ(subset.num_undecided(), 4);
  subset.Add(Loop(5, 34, 0.));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(3, 4, 5));
  for (const SubsetDecision& decision : subset.Flush()) {
    EXPECT_FALSE(decision.accepted) << decision.id;
  }
}

TEST_F(CompatibleSubsetTest, RivalIsTheReasonWhenTheEndComes) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 4.));
  subset.Add(Loop(2, 22, 4.));
  subset.Add(Loop(3, 10, 0.));
  subset.Add(Loop(4, 22, 0.));
  const auto decisions = subset.Flush();
  ASSERT_EQ(decisions.size(), 4u);
  int rivals = 0;
  for (const SubsetDecision& decision : decisions) {
    EXPECT_FALSE(decision.accepted);
    rivals += decision.reason == SubsetReason::kRival;
  }
  EXPECT_EQ(rivals, 2);
}

TEST_F(CompatibleSubsetTest, LaterEvidenceOverturns) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 4.));
  subset.Add(Loop(2, 22, 4.));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 2));
  EXPECT_EQ(subset.num_overturned(), 0);
  for (int i = 0; i < 5; ++i) subset.Add(Loop(3 + i, 10 + 12 * i, 0.));
  EXPECT_THAT(Accepted(subset.Decide()), testing::Contains(5));
  EXPECT_EQ(subset.num_overturned(), 2);
}

TEST_F(CompatibleSubsetTest, WhatWouldCloseAnywayDoesNotSupport) {
  options_.informative_sigma = 0.05;
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 0.));
  subset.Add(Loop(2, 60, 0.));
  EXPECT_THAT(subset.Decide(), IsEmpty());
  for (const SubsetDecision& decision : subset.Flush()) {
    EXPECT_EQ(decision.reason, SubsetReason::kUnsupported);
  }
}

TEST_F(CompatibleSubsetTest, LoopsBetweenTrajectoriesInEitherDirection) {
  CompatibleSubset subset(options_, &paths_);
  LoopEvidence forth = Loop(1, 10, 0.);
  forth.edge.b = uncertainty::NodeId{1, 190};
  LoopEvidence back = Loop(2, 30, 0.);
  back.edge.a = uncertainty::NodeId{1, 170};
  back.edge.b = uncertainty::NodeId{0, 30};
  back.edge.pose = Invert(back.edge.pose);
  subset.Add(forth);
  subset.Add(back);
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 2));

  // Loops without a path between them neither help nor hinder each other.
  CompatibleSubset apart(options_, &paths_);
  LoopEvidence elsewhere = Loop(1, 10, 0.);
  elsewhere.edge.a = uncertainty::NodeId{2, elsewhere.edge.a.index()};
  apart.Add(elsewhere);
  apart.Add(Loop(2, 10, 0.));
  EXPECT_THAT(apart.Decide(), IsEmpty());
  apart.Add(Loop(3, 30, 0.));
  EXPECT_THAT(Accepted(apart.Decide()), ElementsAre(2, 3));
}

TEST_F(CompatibleSubsetTest, RemovedLoopsAreForgotten) {
  CompatibleSubset subset(options_, &paths_);
  subset.Add(Loop(1, 10, 0.));
  subset.Add(Loop(2, 11, 0.));
  EXPECT_THAT(subset.Remove([](const LoopEvidence& loop) {
    return loop.edge.a.index() == 10;
  }),
              ElementsAre(1));
  EXPECT_EQ(subset.num_clusters(), 1);
  EXPECT_THAT(subset.Remove([](const LoopEvidence&) { return true; }),
              ElementsAre(2));
  EXPECT_EQ(subset.num_clusters(), 0);
  subset.Add(Loop(3, 30, 0.));
  EXPECT_THAT(subset.Decide(), IsEmpty());
}

TEST_F(CompatibleSubsetTest, BoundedAndNothingIsLost) {
  options_.max_clusters = 6;
  CompatibleSubset subset(options_, &paths_);
  Random random(3);
  std::map<int64_t, int> seen;
  for (int id = 0; id < 300; ++id) {
    const int i = static_cast<int>(random.UniformInt(0, 90));
    const double offset = random.Uniform() < 0.5 ? 0. : 20. * random.Uniform();
    subset.Add(Loop(id, i, offset));
    EXPECT_LE(subset.num_clusters(), 6);
    if (id % 7 == 0) {
      for (const SubsetDecision& decision : subset.Decide()) {
        ++seen[decision.id];
      }
    }
  }
  for (const SubsetDecision& decision : subset.Flush()) ++seen[decision.id];
  EXPECT_EQ(seen.size(), 300u);
  for (const auto& entry : seen) EXPECT_EQ(entry.second, 1) << entry.first;
}

// Half of the loops are one to four places of 0.8 m off. Searches after one that
// reached its limit get a tenth of it, and accept nearly what exact ones do.
TEST_F(CompatibleSubsetTest, LaterSearchesContinueAndCostLess) {
  constexpr int kNumLoops = 150;
  // A search is stopped by the step after its limit, which counts by its size.
  constexpr int64_t kLastStep = 1 + kNumLoops * kNumLoops / 1024;
  std::map<int64_t, int> num_stopped, num_right, num_wrong;
  for (const int64_t limit : {10, 1000}) {
    options_.clique.max_steps = limit;
    CompatibleSubset subset(options_, &paths_);
    Random random(3);
    std::vector<bool> is_true;
    for (int id = 0; id < kNumLoops; ++id) {
      is_true.push_back(random.Uniform() < 0.5);
      const double offset = is_true.back() ? 0. : 0.8 * random.UniformInt(1, 4);
      subset.Add(Loop(id, static_cast<int>(random.UniformInt(0, 90)), offset));
      const int64_t before = subset.num_clique_steps();
      const int64_t bound = (subset.exact() ? limit : limit / 10) + kLastStep;
      for (const int64_t accepted : Accepted(subset.Decide())) {
        ++(is_true[accepted] ? num_right : num_wrong)[limit];
      }
      EXPECT_LE(subset.num_clique_steps() - before, bound) << id;
      num_stopped[limit] += !subset.exact();
    }
  }
  EXPECT_EQ(num_stopped[1000], 0);
  EXPECT_GT(num_stopped[10], 20);
  EXPECT_GT(num_right[10], 0.9 * num_right[1000]);
  EXPECT_LE(num_wrong[10], num_wrong[1000] + 2);
}

TEST_F(CompatibleSubsetTest, SeparatesTrueFromRandomFalseLoops) {
  for (int seed = 0; seed < 5; ++seed) {
    std::vector<int64_t> first_run;
    for (int run = 0; run < 2; ++run) {
      Random random(seed);
      CompatibleSubset subset(options_, &paths_);
      std::vector<bool> is_true;
      std::vector<int64_t> accepted;
      const auto collect = [&](const std::vector<SubsetDecision>& decisions) {
        for (const int64_t id : Accepted(decisions)) accepted.push_back(id);
      };
      for (int id = 0; id < 60; ++id) {
        is_true.push_back(random.Uniform() < 0.6);
        const double offset = is_true.back() ? 0.05 * (random.Uniform() - 0.5)
                                             : 2.5 + 15. * random.Uniform();
        subset.Add(
            Loop(id, static_cast<int>(random.UniformInt(0, 90)), offset));
        collect(subset.Decide());
      }
      collect(subset.Flush());
      int correct = 0;
      for (const int64_t id : accepted) correct += is_true[id];
      EXPECT_EQ(correct, static_cast<int>(accepted.size())) << seed;
      EXPECT_GE(correct, 0.9 * std::count(is_true.begin(), is_true.end(), true))
          << seed;
      if (run == 0) {
        first_run = accepted;
      } else {
        EXPECT_EQ(accepted, first_run);
      }
    }
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
