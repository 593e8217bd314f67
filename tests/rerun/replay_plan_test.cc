// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/replay_plan.h"

#include <algorithm>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A trajectory whose submaps take `size` nodes each and begin every half of it,
// as local SLAM makes them.
MapGraph Chain(const int num_nodes, const int size, const int trajectory_id = 0,
               const io::TimeNs start = 0) {
  MapGraph graph;
  for (int i = 0; i < num_nodes; ++i) {
    graph.nodes[{trajectory_id, i}].time = start + i;
    for (int submap = 0; submap <= i / (size / 2); ++submap) {
      const int first = submap * size / 2;
      if (i < first || i >= first + size) continue;
      GraphConstraint constraint;
      constraint.submap_id = {trajectory_id, submap};
      constraint.node_id = {trajectory_id, i};
      graph.constraints.push_back(constraint);
      GraphSubmap& stored = graph.submaps[constraint.submap_id];
      ++stored.num_range_data;
      stored.finished = stored.num_range_data == size;
    }
  }
  return graph;
}

void RemoveSubmap(const GraphId& id, MapGraph* graph) {
  graph->submaps.erase(id);
  auto& constraints = graph->constraints;
  constraints.erase(std::remove_if(constraints.begin(), constraints.end(),
                                   [&](const GraphConstraint& constraint) {
                                     return constraint.submap_id == id;
                                   }),
                    constraints.end());
}

TEST(ReplayPlanTest, FollowsTheInsertions) {
  const auto plan = MakeReplayPlan(Chain(7, 4));
  ASSERT_TRUE(plan.ok()) << plan.status();
  ASSERT_EQ(plan->steps.size(), 7u);
  EXPECT_THAT(plan->steps[0].submaps, ElementsAre(0));
  EXPECT_THAT(plan->steps[1].submaps, ElementsAre(0));
  EXPECT_THAT(plan->steps[2].submaps, ElementsAre(0, 1));
  EXPECT_THAT(plan->steps[3].submaps, ElementsAre(0, 1));
  EXPECT_THAT(plan->steps[4].submaps, ElementsAre(1, 2));
  EXPECT_EQ(plan->num_placeholders, 0);
  EXPECT_TRUE(plan->submaps[0].finished);
  EXPECT_EQ(plan->submaps[0].first_step, 0u);
  EXPECT_EQ(plan->submaps[0].last_step, 3u);
  EXPECT_TRUE(plan->submaps[1].finished);
  EXPECT_FALSE(plan->submaps[2].finished);
}

TEST(ReplayPlanTest, PlaceholdersStandForUnfinishedSubmaps) {
  MapGraph graph = Chain(9, 4);  // submaps 0 to 4, of which 0 to 2 are finished
  RemoveSubmap({0, 3}, &graph);
  RemoveSubmap({0, 4}, &graph);
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  ASSERT_EQ(plan->submaps.size(), 5u);
  EXPECT_EQ(plan->num_placeholders, 2);
  EXPECT_TRUE(plan->submaps[3].is_placeholder());
  EXPECT_FALSE(plan->submaps[3].finished);
  EXPECT_THAT(plan->steps[6].submaps, ElementsAre(2, 3));
  EXPECT_THAT(plan->steps[8].submaps, ElementsAre(3, 4));
}

TEST(ReplayPlanTest, OneFinishedSubmapHasASuccessorInTime) {
  MapGraph graph = Chain(6, 4);
  RemoveSubmap({0, 1}, &graph);
  RemoveSubmap({0, 2}, &graph);
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_THAT(plan->steps[1].submaps, ElementsAre(0));
  EXPECT_THAT(plan->steps[2].submaps, ElementsAre(0, 1));
  EXPECT_THAT(plan->steps[4].submaps, ElementsAre(1, 2));
}

TEST(ReplayPlanTest, NodesThatWereNotInsertedDoNotBringASuccessorForward) {
  MapGraph graph = Chain(7, 4);
  // Half of the nodes that count as inserted are not in the grid.
  graph.submaps.at({0, 0}).num_range_data = 2;
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->num_placeholders, 0);
  EXPECT_THAT(plan->steps[1].submaps, ElementsAre(0));
  EXPECT_THAT(plan->steps[2].submaps, ElementsAre(0, 1));
}

TEST(ReplayPlanTest, ParallelTrajectoriesAreInterleaved) {
  MapGraph graph = Chain(4, 4, 0, 0);
  const MapGraph second = Chain(4, 4, 1, 2);
  graph.nodes.insert(second.nodes.begin(), second.nodes.end());
  graph.submaps.insert(second.submaps.begin(), second.submaps.end());
  graph.constraints.insert(graph.constraints.end(), second.constraints.begin(),
                           second.constraints.end());
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->steps[2].node_id, (GraphId{0, 2}));
  EXPECT_EQ(plan->steps[3].node_id, (GraphId{1, 0}));
  EXPECT_EQ(plan->steps[7].node_id, (GraphId{1, 3}));
}

TEST(ReplayPlanTest, LaterTrajectoriesFollow) {
  // The second was recorded before the first, but mapped after it.
  MapGraph graph = Chain(2, 4, 0, 100);
  const MapGraph second = Chain(2, 4, 1, 0);
  graph.nodes.insert(second.nodes.begin(), second.nodes.end());
  graph.submaps.insert(second.submaps.begin(), second.submaps.end());
  graph.constraints.insert(graph.constraints.end(), second.constraints.begin(),
                           second.constraints.end());
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->steps[0].node_id, (GraphId{0, 0}));
  EXPECT_EQ(plan->steps[2].node_id, (GraphId{1, 0}));
}

TEST(ReplayPlanTest, PlaceholdersFillGaps) {
  MapGraph graph = Chain(12, 4);
  RemoveSubmap({0, 1}, &graph);
  RemoveSubmap({0, 2}, &graph);
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->num_placeholders, 2);
  EXPECT_EQ(plan->submaps[3].stored_index, 3);
  EXPECT_THAT(plan->steps[6].submaps, ElementsAre(2, 3));
}

TEST(ReplayPlanTest, GapsOfSubmapsAndNodesAreBridged) {
  MapGraph graph = Chain(12, 4);
  RemoveSubmap({0, 1}, &graph);
  RemoveSubmap({0, 2}, &graph);
  for (int i = 2; i < 6; ++i) graph.nodes.erase({0, i});
  auto& constraints = graph.constraints;
  constraints.erase(
      std::remove_if(constraints.begin(), constraints.end(),
                     [&](const GraphConstraint& constraint) {
                       return graph.nodes.count(constraint.node_id) == 0;
                     }),
      constraints.end());
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  // Nodes 0 and 1 were in submap 0, 6 and 7 in submap 3, which count as in 0,
  // too; 8 and 9 in 3 and 4, and so on.
  EXPECT_EQ(plan->num_guessed, 2);
  EXPECT_EQ(plan->num_placeholders, 0);
  EXPECT_THAT(plan->steps[1].submaps, ElementsAre(0));
  EXPECT_THAT(plan->steps[2].submaps, ElementsAre(0, 1));
  EXPECT_EQ(plan->submaps[1].stored_index, 3);
  EXPECT_EQ(plan->submaps[0].last_step, 3u);
  EXPECT_THAT(plan->steps[4].submaps, ElementsAre(1, 2));
  // Every step goes on where the one before ended.
  for (size_t i = 1; i < plan->steps.size(); ++i) {
    EXPECT_THAT(plan->steps[i].submaps,
                testing::Contains(plan->steps[i - 1].submaps.back()));
  }
}

TEST(ReplayPlanTest, NodesWithoutSubmapsAreBridged) {
  MapGraph graph = Chain(12, 4);
  // As a map whose constraints were thinned out.
  auto& constraints = graph.constraints;
  constraints.erase(std::remove_if(constraints.begin(), constraints.end(),
                                   [](const GraphConstraint& constraint) {
                                     return constraint.node_id.index == 5;
                                   }),
                    constraints.end());
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_GT(plan->num_guessed, 0);
  for (size_t i = 1; i < plan->steps.size(); ++i) {
    EXPECT_THAT(plan->steps[i].submaps,
                testing::Contains(plan->steps[i - 1].submaps.back()));
  }
}

TEST(ReplayPlanTest, OlderSubmapsAreRefused) {
  MapGraph graph = Chain(12, 4);
  for (GraphConstraint& constraint : graph.constraints) {
    if (constraint.node_id.index == 11) constraint.submap_id.index -= 4;
  }
  const auto plan = MakeReplayPlan(graph);
  ASSERT_FALSE(plan.ok());
  EXPECT_THAT(std::string(plan.status().message()),
              HasSubstr("node (0, 11) was inserted into an older submap"));
}

TEST(ReplayPlanTest, WithoutConstraintsEverythingIsInOnePlaceholder) {
  MapGraph graph = Chain(12, 4);
  graph.constraints.clear();
  const auto plan = MakeReplayPlan(graph);
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->steps.size(), 12u);
  EXPECT_EQ(plan->submaps.size(), 1u);
}

TEST(ReplayPlanTest, ThreeSubmapsForANodeAreRefused) {
  MapGraph graph = Chain(6, 4);
  GraphConstraint constraint;
  constraint.submap_id = {0, 2};
  constraint.node_id = {0, 2};
  graph.constraints.push_back(constraint);
  const auto plan = MakeReplayPlan(graph);
  ASSERT_FALSE(plan.ok());
  EXPECT_THAT(std::string(plan.status().message()),
              HasSubstr("node (0, 2) was inserted into 3 submaps"));
}

TEST(ReplayPlanTest, NothingIsFine) {
  const auto plan = MakeReplayPlan(MapGraph());
  ASSERT_TRUE(plan.ok());
  EXPECT_TRUE(plan->steps.empty());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
