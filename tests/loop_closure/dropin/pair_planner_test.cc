// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "cartographer_ext/loop_closure/loop_verifier.h"
#include "cartographer_ext/options/option_description.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using proto::LoopDecision;
using testing::ElementsAre;
using testing::IsEmpty;

// Run 1 drives along a line, a node every metre; run 0 has left a map of seven
// submaps.
class PairPlannerTest : public testing::Test {
 protected:
  PairPlannerTest() : paths_(uncertainty::PathNoiseOptions(), 1000) {
    options::SetDefaults(&extension_);
    options_.set_max_constraint_distance(15.);
    options_.set_sampling_ratio(0.5);
    options_.mutable_fast_correlative_scan_matcher_options()
        ->set_linear_search_window(7.);
    options_.mutable_fast_correlative_scan_matcher_options()
        ->set_angular_search_window(0.5);
    for (int i = 0; i <= 100; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, Pose2(i, 0., 0.));
      paths_.Add(uncertainty::NodeId{1, i}, Pose2(i, 0., 0.));
    }
    for (int s = 0; s < 7; ++s) {
      paths_.Add(uncertainty::SubmapId{0, s}, Pose2(10. * s, 0., 0.));
    }
    MakePlanner();
  }

  void MakePlanner() {
    planner_.reset(new PairPlanner(options_, extension_, &paths_));
  }

  OfferedPair Pair(const SubmapId& submap, const NodeId& node,
                   const bool is_global) {
    OfferedPair pair;
    pair.submap_id = submap;
    pair.node_id = node;
    pair.node = &data_;
    pair.is_global = is_global;
    if (submap.trajectory_id != node.trajectory_id) {
      pair.anchor =
          uncertainty::SubmapId{submap.trajectory_id, submap.submap_index};
    }
    return pair;
  }

  // Node `i` of run 1 with all submaps of the map.
  std::vector<OfferedPair> WithMap(const int i, const bool is_global) {
    std::vector<OfferedPair> pairs;
    for (int s = 0; s < 7; ++s) {
      pairs.push_back(Pair(SubmapId{0, s}, NodeId{1, i}, is_global));
    }
    return pairs;
  }

  std::vector<PlannedPair> Plan(const std::vector<OfferedPair>& pairs) {
    return planner_->Plan(pairs, &lost_);
  }

  static std::vector<size_t> Searched(const std::vector<PlannedPair>& planned) {
    std::vector<size_t> result;
    for (const PlannedPair& pair : planned) {
      if (pair.query >= 0 && pair.plan.skipped == LoopDecision::NONE) {
        result.push_back(pair.pair);
      }
    }
    return result;
  }

  cartographer::mapping::constraints::proto::ConstraintBuilderOptions options_;
  proto::LoopClosureOptions extension_;
  cartographer::mapping::TrajectoryNode::Data data_;
  uncertainty::PathUncertainty paths_;
  std::unique_ptr<PairPlanner> planner_;
  std::vector<LostPlace> lost_;
};

TEST_F(PairPlannerTest, NothingIsPlannedOfNothing) {
  EXPECT_THAT(Plan({}), IsEmpty());
}

TEST_F(PairPlannerTest, EachSecondSubmapIsSearched) {
  const std::vector<PlannedPair> planned = Plan(WithMap(0, true));
  ASSERT_EQ(planned.size(), 7u);
  EXPECT_THAT(Searched(planned), ElementsAre(0, 2, 4, 6));
  for (const PlannedPair& pair : planned) {
    EXPECT_TRUE(pair.plan.full_submap);
    EXPECT_EQ(pair.plan.skipped, pair.pair % 2 == 0
                                     ? LoopDecision::NONE
                                     : LoopDecision::SKIPPED_REDUNDANT);
    EXPECT_EQ(pair.query, planned[0].query);
  }
  // The next node comes too soon.
  const std::vector<PlannedPair> next = Plan(WithMap(1, true));
  ASSERT_EQ(next.size(), 7u);
  for (const PlannedPair& pair : next) {
    EXPECT_EQ(pair.plan.skipped, LoopDecision::SKIPPED_SPACING);
  }
  const std::vector<PlannedPair> later = Plan(WithMap(6, true));
  EXPECT_THAT(Searched(later), ElementsAre(0, 2, 4, 6));
  EXPECT_NE(later[0].query, planned[0].query);
}

TEST_F(PairPlannerTest, WithoutItsNeighboursASubmapIsNotCovered) {
  std::vector<OfferedPair> pairs = WithMap(0, true);
  pairs.erase(pairs.begin() + 4);
  EXPECT_THAT(Searched(Plan(pairs)), ElementsAre(0, 2, 3, 4, 5));
}

TEST_F(PairPlannerTest, TheCapTakesTurns) {
  extension_.mutable_localization()->set_max_submaps_per_query(3);
  MakePlanner();
  const std::vector<PlannedPair> first = Plan(WithMap(0, true));
  EXPECT_THAT(Searched(first), ElementsAre(0, 2, 4));
  EXPECT_EQ(first[6].plan.skipped, LoopDecision::SKIPPED_BUDGET);
  EXPECT_THAT(Searched(Plan(WithMap(10, true))), ElementsAre(0, 2, 6));
  EXPECT_THAT(Searched(Plan(WithMap(20, true))), ElementsAre(0, 2, 4));
}

TEST_F(PairPlannerTest, AroundTheStartThatSomebodyTold) {
  const std::vector<PlannedPair> planned = Plan(WithMap(0, false));
  ASSERT_EQ(planned.size(), 7u);
  EXPECT_THAT(Searched(planned), IsEmpty());
  EXPECT_EQ(planned[0].plan.linear_window, 7.);
  EXPECT_EQ(planned[0].plan.angular_window, 0.5);
}

TEST_F(PairPlannerTest, WatchesBesidesTheSearchAroundThePrediction) {
  Plan(WithMap(0, true));
  uncertainty::LoopEdge loop;
  loop.a = uncertainty::SubmapId{0, 2};
  loop.b = uncertainty::NodeId{1, 0};
  EXPECT_FALSE(planner_->AddAcceptedLoop(SubmapId{0, 2},
                                         uncertainty::NodeId{1, 0}, 0, loop));
  EXPECT_TRUE(planner_->localization()->IsKnown(1, 0));
  const std::vector<PlannedPair> planned = Plan(WithMap(10, false));
  // In the order they were offered, some twice.
  ASSERT_EQ(planned.size(), 14u);
  EXPECT_THAT(Searched(planned), ElementsAre(0, 2, 4, 6));
  for (size_t k = 1; k < planned.size(); ++k) {
    EXPECT_LE(planned[k - 1].pair, planned[k].pair);
  }
  // Lost: the way without a loop is too long.
  EXPECT_THAT(lost_, IsEmpty());
  const std::vector<PlannedPair> lost = Plan(WithMap(40, false));
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
  std::vector<OfferedPair> pairs = {Pair(SubmapId{0, 0}, NodeId{1, 50}, true)};
  for (int i = 0; i < 20; ++i) {
    pairs.push_back(Pair(SubmapId{1, 0}, NodeId{0, i}, true));
  }
  const std::vector<PlannedPair> planned = Plan(pairs);
  ASSERT_EQ(planned.size(), 21u);
  EXPECT_THAT(Searched(planned), ElementsAre(0));
  for (size_t k = 1; k < planned.size(); ++k) {
    EXPECT_EQ(planned[k].plan.skipped, LoopDecision::SKIPPED_LOADED);
  }
}

TEST_F(PairPlannerTest, SwitchedOffPairsAreSearchedAsTheHostAsks) {
  extension_.mutable_localization()->set_enabled(false);
  extension_.mutable_search()->set_enabled(false);
  MakePlanner();
  const std::vector<PlannedPair> global = Plan(WithMap(0, true));
  ASSERT_EQ(global.size(), 7u);
  EXPECT_THAT(Searched(global), IsEmpty());
  for (const PlannedPair& pair : global) {
    EXPECT_TRUE(pair.plan.full_submap);
    EXPECT_EQ(pair.plan.skipped, LoopDecision::NONE);
  }
  // Cartographer's sampler: each second one of a submap.
  std::vector<OfferedPair> local = WithMap(1, false);
  local[3].predicted = Pose2(16., 0., 0.);
  const std::vector<PlannedPair> first = Plan(local);
  ASSERT_EQ(first.size(), 7u);
  EXPECT_EQ(first[0].plan.skipped, LoopDecision::NONE);
  EXPECT_EQ(first[0].plan.linear_window, 7.);
  EXPECT_TRUE(first[3].plan.out_of_reach);
  EXPECT_EQ(Plan(local)[0].plan.skipped, LoopDecision::SKIPPED_SAMPLER);
  EXPECT_EQ(Plan(local)[0].plan.skipped, LoopDecision::NONE);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
