// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Equal places 1.2 m apart along a corridor, forth and back: the path of up to
// 100 m is known to half a metre.
#include <cstdint>
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

class CompatibleSubsetPathsTest : public ForthAndBackTest {
 protected:
  LoopEvidence Loop(const int64_t id, const int i, const double offset) const {
    LoopEvidence loop = ForthAndBackLoop(id, i, offset, 0.9);
    loop.search_density = search_density_;
    return loop;
  }

  // Six loops that are all one place off.
  void AddWrong(CompatibleSubset* const subset,
                const double offset = 1.2) const {
    for (int i = 0; i < 6; ++i) subset->Add(Loop(1 + i, 5 + 11 * i, offset));
  }
  // Four right ones elsewhere.
  void AddRight(CompatibleSubset* const subset) const {
    for (int i = 0; i < 4; ++i) subset->Add(Loop(11 + i, 10 + 11 * i, 0.));
  }

  double search_density_ = 0.1;
};

TEST_F(CompatibleSubsetPathsTest, TheSetNearerToItsPathIsTaken) {
  for (const bool is_known : {false, true}) {
    search_density_ = is_known ? 0.1 : 0.;
    CompatibleSubset subset(options_, &paths_);
    subset.SetShareWrong(0.9);
    AddWrong(&subset);
    AddRight(&subset);
    const std::vector<int64_t> accepted = Accepted(subset.Decide());
    if (is_known) {
      EXPECT_THAT(accepted, ElementsAre(11, 12, 13, 14));
    } else {
      EXPECT_THAT(accepted, ElementsAre(1, 2, 3, 4, 5, 6));
    }
  }
}

// One loop nearer to its path does not outweigh six that agree, 0.9 m from
// theirs.
TEST_F(CompatibleSubsetPathsTest, AgreementCountsForMoreThanASmallDrift) {
  CompatibleSubset subset(options_, &paths_);
  AddWrong(&subset, 0.9);
  subset.Add(Loop(11, 10, 0.));
  EXPECT_THAT(Accepted(subset.Decide()), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(CompatibleSubsetPathsTest, LongPathsTurnOutBetterThanAssumed) {
  CompatibleSubset subset(options_, &paths_);
  EXPECT_DOUBLE_EQ(subset.PathFactor(0), 1.);
  for (int i = 0; i < 6; ++i) subset.Add(Loop(1 + i, 5 + 11 * i, 0.));
  EXPECT_EQ(Accepted(subset.Decide()).size(), 6u);
  EXPECT_LT(subset.PathFactor(0), 0.7);
  // As if there were no probabilities: the subset of the paper.
  options_.scores_are_probabilities = false;
  CompatibleSubset of_paper(options_, &paths_);
  for (int i = 0; i < 6; ++i) of_paper.Add(Loop(1 + i, 5 + 11 * i, 0.));
  EXPECT_EQ(Accepted(of_paper.Decide()).size(), 6u);
  EXPECT_DOUBLE_EQ(of_paper.PathFactor(0), 1.);
}

// 300 m forth and back. Two metres are nothing between loops that far apart, until
// paths are known to be better.
TEST(CompatibleSubsetLongPathsTest, ThenLoopsFarFromOthersContradictThem) {
  const auto pose_at = [](const int i) {
    return i <= 300 ? Pose2(i, 0., 0.) : Pose2(600. - i, 0., kPi);
  };
  uncertainty::PathUncertainty paths(uncertainty::RandomWalk(), 1000);
  for (int i = 0; i <= 600; ++i)
    paths.Add(uncertainty::NodeId{0, i}, pose_at(i));
  CompatibleSubsetOptions options;
  options.single_strong_enabled = false;
  options.scores_are_probabilities = true;
  for (const bool learns : {false, true}) {
    const auto loop = [&](const int64_t id, const int i, const double offset) {
      LoopEvidence loop = ForthAndBackLoop(id, 0, 0., 0.9);
      loop.edge.a = uncertainty::NodeId{0, i};
      loop.edge.b = uncertainty::NodeId{0, 600 - i};
      loop.edge.pose.pose =
          Pose2(offset, 0., 0.) * Between(pose_at(i), pose_at(600 - i));
      loop.search_density = learns ? 0.1 : 0.;
      return loop;
    };
    CompatibleSubset subset(options, &paths);
    for (int i = 0; i < 4; ++i) subset.Add(loop(1 + i, 10 + 20 * i, 0.));
    EXPECT_EQ(Accepted(subset.Decide()).size(), 4u);
    EXPECT_EQ(subset.PathFactor(0) < 1., learns);
    subset.Add(loop(20, 250, 2.));
    EXPECT_THAT(Accepted(subset.Decide()), IsEmpty());
    const std::vector<SubsetDecision> undecided = subset.Undecided();
    ASSERT_EQ(undecided.size(), 1u);
    EXPECT_EQ(undecided[0].contradictions, learns ? 4 : 0);
  }
}

// Another robot may drift more.
TEST_F(CompatibleSubsetPathsTest, EachTrajectoryHasItsOwnFactor) {
  for (int i = 0; i <= 200; ++i) {
    paths_.Add(uncertainty::NodeId{1, i}, ForthAndBack(i));
  }
  CompatibleSubset subset(options_, &paths_);
  for (int i = 0; i < 6; ++i) {
    subset.Add(Loop(1 + i, 5 + 11 * i, 0.));
    LoopEvidence other = Loop(11 + i, 5 + 11 * i, 1.2);
    other.edge.a = uncertainty::NodeId{1, 5 + 11 * i};
    other.edge.b = uncertainty::NodeId{1, 195 - 11 * i};
    subset.Add(other);
  }
  EXPECT_EQ(Accepted(subset.Decide()).size(), 12u);
  EXPECT_LT(subset.PathFactor(0), 0.7);
  EXPECT_DOUBLE_EQ(subset.PathFactor(1), 1.);
  EXPECT_DOUBLE_EQ(subset.PathFactor(2), 1.);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
