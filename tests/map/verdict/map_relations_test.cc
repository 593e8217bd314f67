// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/map_relations.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr int kNodesALap = 80;

// Two laps of a circle with a circumference of 20 m, a node each quarter of a
// metre and each second; a submap has ten nodes.
MapGraph TwoLaps() {
  MapGraph graph;
  for (int i = 0; i < 2 * kNodesALap; ++i) {
    const double angle = 2. * M_PI * i / kNodesALap;
    const double radius = 20. / (2. * M_PI);
    GraphNode node;
    node.time = io::FromSeconds(1000. + i);
    node.global_pose =
        Pose2(radius * std::cos(angle), radius * std::sin(angle), angle);
    node.global_tracking_pose.translation() << node.global_pose.x,
        node.global_pose.y, 0.3;
    node.global_tracking_pose.linear() =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    graph.nodes[{0, i}] = node;
    GraphConstraint insertion;
    insertion.submap_id = {0, i / 10};
    insertion.node_id = {0, i};
    graph.constraints.push_back(insertion);
  }
  return graph;
}

GraphConstraint Loop(const int submap, const int node) {
  GraphConstraint loop;
  loop.submap_id = {0, submap};
  loop.node_id = {0, node};
  loop.is_loop = true;
  return loop;
}

void ExpectAgrees(const MapGraph& graph, const io::StampedRelation& relation) {
  const GraphNode *first = nullptr, *second = nullptr;
  for (const auto& entry : graph.nodes) {
    if (entry.second.time == relation.time1) first = &entry.second;
    if (entry.second.time == relation.time2) second = &entry.second;
  }
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  EXPECT_TRUE((first->global_tracking_pose * relation.relative)
                  .isApprox(second->global_tracking_pose, 1e-12));
}

TEST(MapRelationsTest, NeighboursAlongThePath) {
  const MapGraph graph = TwoLaps();
  const auto relations = MakeMapRelations(graph, {});
  // The chord of a quarter of a metre is a little shorter, so every fifth node.
  ASSERT_EQ(relations.size(), (2 * kNodesALap - 1) / 5);
  for (size_t i = 0; i < relations.size(); ++i) {
    EXPECT_EQ(relations[i].time1, io::FromSeconds(1000. + 5 * i));
    EXPECT_EQ(relations[i].time2, io::FromSeconds(1005. + 5 * i));
    EXPECT_GE(relations[i].relative.translation().norm(), 0.9);
    ExpectAgrees(graph, relations[i]);
  }
}

TEST(MapRelationsTest, LoopsLeadToTheNearestNodeOfTheirSubmap) {
  MapGraph graph = TwoLaps();
  const size_t without = MakeMapRelations(graph, {}).size();
  graph.constraints.push_back(Loop(1, kNodesALap + 14));
  graph.constraints.push_back(Loop(2, kNodesALap + 14));  // farther away
  graph.constraints.push_back(
      Loop(1, kNodesALap + 15));  // too close to the last
  const auto relations = MakeMapRelations(graph, {});
  ASSERT_EQ(relations.size(), without + 1);
  int num_loops = 0;
  for (const auto& relation : relations) {
    ExpectAgrees(graph, relation);
    if (relation.time2 - relation.time1 < io::FromSeconds(60.)) continue;
    ++num_loops;
    EXPECT_EQ(relation.time1, io::FromSeconds(1014.));
    EXPECT_EQ(relation.time2, io::FromSeconds(1094.));
    EXPECT_LT(relation.relative.translation().norm(), 1e-9);
  }
  EXPECT_EQ(num_loops, 1);
}

TEST(MapRelationsTest, LoopsThatSayNothingAreLeftOut) {
  MapGraph graph = TwoLaps();
  const size_t without = MakeMapRelations(graph, {}).size();
  graph.constraints.push_back(Loop(4, 70));  // within a minute
  graph.constraints.push_back(Loop(1, kNodesALap + 14));
  graph.constraints.back().switched_off = true;
  graph.constraints.push_back(Loop(99, kNodesALap + 30));  // no such submap
  EXPECT_EQ(MakeMapRelations(graph, {}).size(), without);
  MapRelationsOptions other;
  other.trajectory_id = 1;
  EXPECT_TRUE(MakeMapRelations(graph, other).empty());
}

TEST(MapRelationsTest, OnlyOfSoundMaps) {
  const MapGraph graph = TwoLaps();
  EXPECT_TRUE(MakeRelationsIfSound(graph, "m", "sound", {}).ok());
  for (const char* const verdict : {"doubtful", "broken", "unknown"}) {
    const auto relations = MakeRelationsIfSound(graph, "m.pb", verdict, {});
    ASSERT_FALSE(relations.ok());
    EXPECT_THAT(std::string(relations.status().message()),
                testing::AllOf(testing::HasSubstr("m.pb"),
                               testing::HasSubstr(verdict)));
  }
  EXPECT_FALSE(MakeRelationsIfSound({}, "m", "sound", {}).ok());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
