// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"

#include <memory>

#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Run 1, a node every metre along a line, in the map of run 0.
class MapLocalizationTest : public testing::Test {
 protected:
  MapLocalizationTest() : paths_(uncertainty::RandomWalk(), 1000) {
    for (int i = 0; i <= 300; ++i) {
      paths_.Add(uncertainty::NodeId{1, i}, Pose2(i, 0., 0.));
    }
    options_.query_spacing = 5.;
    options_.watch_spacing = 10.;
    options_.lost_distance = 15.;
    options_.watches = 2;
    localization_.reset(new MapLocalization(options_, &paths_));
  }

  MapLocalization::Plan Plan(const int node, const bool is_predicted) {
    return localization_->PlanNode(uncertainty::NodeId{1, node}, 0,
                                   is_predicted);
  }
  bool Accept(const int node) {
    return localization_->AddAcceptedLoop(uncertainty::NodeId{1, node}, 0);
  }
  void Decided(const int node, const bool agrees) {
    localization_->AddDecision(uncertainty::NodeId{1, node}, 0, agrees);
  }

  MapLocalizationOptions options_;
  uncertainty::PathUncertainty paths_;
  std::unique_ptr<MapLocalization> localization_;
};

TEST_F(MapLocalizationTest, WithoutPredictionTheWholeMapIsSearchedNowAndThen) {
  EXPECT_FALSE(localization_->IsKnown(1, 0));
  for (int i = 0; i < 30; ++i) {
    const MapLocalization::Plan plan = Plan(i, false);
    EXPECT_EQ(plan.everywhere, i % 5 == 0) << i;
    EXPECT_FALSE(plan.around_prediction);
    EXPECT_FALSE(plan.newly_lost);
  }
  // The same for each map.
  EXPECT_TRUE(
      localization_->PlanNode(uncertainty::NodeId{1, 31}, 2, false).everywhere);
}

TEST_F(MapLocalizationTest, WhatAnOperatorSaysIsBelievedForAWhile) {
  for (int i = 0; i < 15; ++i) {
    EXPECT_TRUE(Plan(i, true).around_prediction) << i;
    EXPECT_FALSE(Plan(i, true).everywhere) << i;
  }
  // Nothing was found there.
  EXPECT_FALSE(Plan(15, true).around_prediction);
  EXPECT_FALSE(Plan(16, true).everywhere);
  EXPECT_TRUE(Plan(20, true).everywhere);
}

TEST_F(MapLocalizationTest, AKnownPlaceIsWatched) {
  Plan(0, false);
  Accept(0);
  EXPECT_TRUE(localization_->IsKnown(1, 0));
  EXPECT_FALSE(localization_->IsKnown(1, 2));
  int num_everywhere = 0;
  for (int i = 1; i <= 100; ++i) {
    const MapLocalization::Plan plan = Plan(i, true);
    EXPECT_TRUE(plan.around_prediction);
    num_everywhere += plan.everywhere ? 1 : 0;
    if (i % 10 == 0) Accept(i);
    if (plan.everywhere) Decided(i, true);
  }
  EXPECT_EQ(num_everywhere, 10);
  EXPECT_EQ(localization_->LastNodeBeforeLost(1, 0), -1);
}

TEST_F(MapLocalizationTest, ALongWayWithoutLoopsLosesThePlace) {
  Plan(0, false);
  Accept(0);
  Accept(20);
  EXPECT_FALSE(Plan(34, true).newly_lost);
  const MapLocalization::Plan plan = Plan(35, true);
  EXPECT_TRUE(plan.newly_lost);
  EXPECT_FALSE(plan.by_decisions);
  // The host's prediction is of before.
  EXPECT_FALSE(plan.around_prediction);
  EXPECT_TRUE(plan.everywhere);
  EXPECT_FALSE(localization_->IsKnown(1, 0));
  EXPECT_EQ(localization_->LastNodeBeforeLost(1, 0), 20);
  EXPECT_FALSE(Plan(36, true).newly_lost);
  // A loop of before does not find it again, one of later does.
  EXPECT_FALSE(Accept(19));
  EXPECT_FALSE(localization_->IsKnown(1, 0));
  EXPECT_TRUE(Accept(38));
  EXPECT_FALSE(Accept(39));
  EXPECT_TRUE(localization_->IsKnown(1, 0));
  EXPECT_TRUE(Plan(39, true).around_prediction);
}

TEST_F(MapLocalizationTest, DecisionsTellThatThePlaceIsAnotherOne) {
  Plan(0, false);
  // Before the place is known they say nothing.
  Decided(0, false);
  Decided(0, false);
  Accept(0);
  Decided(1, false);
  Decided(2, true);
  Decided(3, true);
  Decided(4, false);
  // One of the last three.
  EXPECT_FALSE(Plan(5, true).newly_lost);
  Accept(5);
  Decided(6, false);
  const MapLocalization::Plan plan = Plan(7, true);
  EXPECT_TRUE(plan.newly_lost);
  EXPECT_TRUE(plan.by_decisions);
  EXPECT_EQ(localization_->LastNodeBeforeLost(1, 0), 5);
  // And begins with a clean slate.
  Accept(8);
  EXPECT_FALSE(Plan(9, true).newly_lost);
}

TEST_F(MapLocalizationTest, AWayThatIsForgottenIsALongOne) {
  uncertainty::PathUncertainty short_memory(uncertainty::RandomWalk(), 3);
  MapLocalization localization(options_, &short_memory);
  for (int i = 0; i < 6; ++i) {
    short_memory.Add(uncertainty::NodeId{1, i}, Pose2(0.1 * i, 0., 0.));
    localization.PlanNode(uncertainty::NodeId{1, i}, 0, true);
    if (i == 0) localization.AddAcceptedLoop(uncertainty::NodeId{1, 0}, 0);
  }
  EXPECT_FALSE(localization.IsKnown(1, 0));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
