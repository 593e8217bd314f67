// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using testing::ElementsAre;
using testing::IsEmpty;
using uncertainty::NodeId;
using uncertainty::SubmapId;

// Run 1 drives along a line, a node every metre; run 0 has left a map of seven
// submaps.
class PairPlannerTest : public testing::Test {
 protected:
  PairPlannerTest() : paths_(uncertainty::RandomWalk(), 1000) {
    options_.set_max_constraint_distance(15.);
    options_.set_sampling_ratio(0.5);
    options_.mutable_fast_correlative_scan_matcher_options()
        ->set_linear_search_window(7.);
    options_.mutable_fast_correlative_scan_matcher_options()
        ->set_angular_search_window(0.5);
    for (int i = 0; i <= 100; ++i) {
      paths_.Add(NodeId{0, i}, Pose2(i, 0., 0.));
      paths_.Add(NodeId{1, i}, Pose2(i, 0., 0.));
    }
    for (int s = 0; s < 7; ++s) {
      paths_.Add(SubmapId{0, s}, Pose2(10. * s, 0., 0.));
    }
    MakePlanner();
  }

  void MakePlanner() {
    planner_.reset(new PairPlanner(options_, extension_, &paths_));
  }

  LoopCandidate Pair(const SubmapId& submap, const NodeId& node,
                     const bool is_global) {
    LoopCandidate pair;
    pair.submap = submap;
    pair.node = node;
    if (!is_global) pair.predicted = Pose2();
    if (pair.is_inter_trajectory()) pair.anchor = submap;
    return pair;
  }

  // Node `i` of run 1 with all submaps of the map.
  std::vector<LoopCandidate> WithMap(const int i, const bool is_global) {
    std::vector<LoopCandidate> pairs;
    for (int s = 0; s < 7; ++s) {
      pairs.push_back(Pair(SubmapId{0, s}, NodeId{1, i}, is_global));
    }
    return pairs;
  }

  std::vector<LoopCandidate> Plan(const std::vector<LoopCandidate>& pairs) {
    return planner_->Plan(pairs, &lost_);
  }

  // Indices of the submaps.
  static std::vector<int> Searched(const std::vector<LoopCandidate>& planned) {
    std::vector<int> result;
    for (const LoopCandidate& pair : planned) {
      if (pair.plan.query >= 0 && pair.plan.skipped == LoopDecision::NONE) {
        result.push_back(pair.submap.submap_index);
      }
    }
    return result;
  }

  cartographer::mapping::constraints::proto::ConstraintBuilderOptions options_;
  LoopOptions extension_;
  uncertainty::PathUncertainty paths_;
  std::unique_ptr<PairPlanner> planner_;
  std::vector<LostPlace> lost_;
};

TEST_F(PairPlannerTest, NothingIsPlannedOfNothing) {
  EXPECT_THAT(Plan({}), IsEmpty());
}

TEST_F(PairPlannerTest, EachSecondSubmapIsSearched) {
  const std::vector<LoopCandidate> planned = Plan(WithMap(0, true));
  ASSERT_EQ(planned.size(), 7u);
  EXPECT_THAT(Searched(planned), ElementsAre(0, 2, 4, 6));
  for (const LoopCandidate& pair : planned) {
    EXPECT_TRUE(pair.plan.full_submap);
    EXPECT_EQ(pair.plan.skipped, pair.submap.submap_index % 2 == 0
                                     ? LoopDecision::NONE
                                     : LoopDecision::SKIPPED_REDUNDANT);
    EXPECT_EQ(pair.plan.query, planned[0].plan.query);
  }
  // The next node comes too soon.
  const std::vector<LoopCandidate> next = Plan(WithMap(1, true));
  ASSERT_EQ(next.size(), 7u);
  for (const LoopCandidate& pair : next) {
    EXPECT_EQ(pair.plan.skipped, LoopDecision::SKIPPED_SPACING);
  }
  const std::vector<LoopCandidate> later = Plan(WithMap(6, true));
  EXPECT_THAT(Searched(later), ElementsAre(0, 2, 4, 6));
  EXPECT_NE(later[0].plan.query, planned[0].plan.query);
}

TEST_F(PairPlannerTest, WithoutItsNeighboursASubmapIsNotCovered) {
  std::vector<LoopCandidate> pairs = WithMap(0, true);
  pairs.erase(pairs.begin() + 4);
  EXPECT_THAT(Searched(Plan(pairs)), ElementsAre(0, 2, 3, 5, 6));
}

TEST_F(PairPlannerTest, TheCapTakesTurns) {
  extension_.relocalization.max_submaps_per_query = 3;
  MakePlanner();
  const std::vector<LoopCandidate> first = Plan(WithMap(0, true));
  EXPECT_THAT(Searched(first), ElementsAre(0, 2, 4));
  EXPECT_EQ(first[6].plan.skipped, LoopDecision::SKIPPED_BUDGET);
  EXPECT_THAT(Searched(Plan(WithMap(10, true))), ElementsAre(0, 2, 6));
  EXPECT_THAT(Searched(Plan(WithMap(20, true))), ElementsAre(0, 2, 4));
}

TEST_F(PairPlannerTest, AroundAGivenStart) {
  const std::vector<LoopCandidate> planned = Plan(WithMap(0, false));
  ASSERT_EQ(planned.size(), 7u);
  EXPECT_THAT(Searched(planned), IsEmpty());
  EXPECT_EQ(planned[0].plan.linear_window, 7.);
  EXPECT_EQ(planned[0].plan.angular_window, 0.5);
}

TEST_F(PairPlannerTest, WatchesBesidesTheSearchAroundThePrediction) {
  Plan(WithMap(0, true));
  uncertainty::LoopEdge loop;
  loop.a = SubmapId{0, 2};
  loop.b = NodeId{1, 0};
  EXPECT_FALSE(planner_->AddAcceptedLoop(
      Pair(SubmapId{0, 2}, NodeId{1, 0}, false), loop));
  EXPECT_TRUE(planner_->localization()->IsKnown(1, 0));
  const std::vector<LoopCandidate> planned = Plan(WithMap(10, false));
  // In the order of the proposals, some twice.
  ASSERT_EQ(planned.size(), 14u);
  EXPECT_THAT(Searched(planned), ElementsAre(0, 2, 4, 6));
  for (size_t k = 1; k < planned.size(); ++k) {
    EXPECT_LE(planned[k - 1].submap.submap_index,
              planned[k].submap.submap_index);
  }
  // Lost: the path without a loop is too long.
  EXPECT_THAT(lost_, IsEmpty());
  const std::vector<LoopCandidate> lost = Plan(WithMap(40, false));
  EXPECT_EQ(lost.size(), 7u);
  ASSERT_EQ(lost_.size(), 1u);
  EXPECT_EQ(lost_[0].trajectory_id, 1);
  EXPECT_EQ(lost_[0].map_trajectory_id, 0);
  EXPECT_EQ(lost_[0].last_node_index, 0);
  EXPECT_FALSE(lost_[0].by_decisions);
}

TEST_F(PairPlannerTest, ALoadedMapIsNotSearchedInTheRun) {
  // The node that was added comes first, then those of the map with a submap
  // that the run has completed.
  std::vector<LoopCandidate> pairs = {
      Pair(SubmapId{0, 0}, NodeId{1, 50}, true)};
  for (int i = 0; i < 20; ++i) {
    pairs.push_back(Pair(SubmapId{1, 0}, NodeId{0, i}, true));
  }
  const std::vector<LoopCandidate> planned = Plan(pairs);
  ASSERT_EQ(planned.size(), 21u);
  EXPECT_THAT(Searched(planned), ElementsAre(0));
  for (size_t k = 1; k < planned.size(); ++k) {
    EXPECT_EQ(planned[k].plan.skipped, LoopDecision::SKIPPED_LOADED);
  }
}

TEST_F(PairPlannerTest, WithoutPlanningPairsAreSearchedAsTheHostAsks) {
  extension_.relocalization.enabled = false;
  extension_.search.enabled = false;
  MakePlanner();
  const std::vector<LoopCandidate> global = Plan(WithMap(0, true));
  ASSERT_EQ(global.size(), 7u);
  EXPECT_THAT(Searched(global), IsEmpty());
  for (const LoopCandidate& pair : global) {
    EXPECT_TRUE(pair.plan.full_submap);
    EXPECT_EQ(pair.plan.skipped, LoopDecision::NONE);
  }
  // Cartographer's sampler: each second one of a submap.
  std::vector<LoopCandidate> local = WithMap(1, false);
  local[3].predicted = Pose2(16., 0., 0.);
  const std::vector<LoopCandidate> first = Plan(local);
  ASSERT_EQ(first.size(), 7u);
  EXPECT_EQ(first[0].plan.skipped, LoopDecision::NONE);
  EXPECT_EQ(first[0].plan.linear_window, 7.);
  EXPECT_TRUE(first[3].plan.out_of_reach);
  EXPECT_EQ(Plan(local)[0].plan.skipped, LoopDecision::SKIPPED_SAMPLER);
  EXPECT_EQ(Plan(local)[0].plan.skipped, LoopDecision::NONE);
}

TEST_F(PairPlannerTest, NothingIsRememberedOfADeletedTrajectory) {
  Plan(WithMap(0, true));
  uncertainty::LoopEdge loop;
  loop.a = SubmapId{0, 2};
  loop.b = NodeId{1, 0};
  planner_->AddAcceptedLoop(Pair(SubmapId{0, 2}, NodeId{1, 0}, false), loop);
  planner_->DeleteTrajectory(2);
  EXPECT_TRUE(planner_->localization()->IsKnown(1, 0));
  planner_->DeleteTrajectory(1);
  EXPECT_FALSE(planner_->localization()->IsKnown(1, 0));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
