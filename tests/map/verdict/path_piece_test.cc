// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/path_piece.h"

#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::ElementsAre;

// A node every second and every half metre along x.
MapGraph Line(const int trajectory_id) {
  MapGraph graph;
  for (int i = 0; i < 20; ++i) {
    GraphNode node;
    node.time = i * 1000000000LL;
    node.global_pose = Pose2(0.5 * i, 0., 0.);
    graph.nodes[{trajectory_id, i}] = node;
  }
  return graph;
}

TEST(PathPieceTest, JoinsNodesUpToTheGap) {
  const std::vector<PieceNode> nodes = {{{0, 1}, {0, 7}, 0.5, 0.1},
                                        {{0, 2}, {0, 3}, 0.7, 0.3},
                                        {{0, 5}, {0, 3}, 0.9, 0.2},
                                        {{0, 9}, {0, 3}, 0.9, 0.2}};
  const auto pieces = JoinToPieces(Line(0), nodes, {3, 3});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].first_node, (GraphId{0, 1}));
  EXPECT_EQ(pieces[0].last_node, (GraphId{0, 5}));
  EXPECT_EQ(pieces[0].begin, 1000000000LL);
  EXPECT_EQ(pieces[0].end, 5000000000LL);
  EXPECT_EQ(pieces[0].num_nodes, 3);
  EXPECT_NEAR(pieces[0].metres, 2., 1e-12);
  EXPECT_NEAR(pieces[0].center.x(), 0.5 * (1 + 2 + 5) / 3., 1e-12);
  EXPECT_NEAR(pieces[0].fraction, 0.7, 1e-12);
  EXPECT_NEAR(pieces[0].displacement, 0.2, 1e-12);
  EXPECT_THAT(pieces[0].submaps, ElementsAre(GraphId{0, 3}, GraphId{0, 7}));
  EXPECT_EQ(JoinToPieces(Line(0), nodes, {1, 3}).size(), 2u);
  EXPECT_EQ(JoinToPieces(Line(0), nodes, {1, 4}).size(), 1u);
}

TEST(PathPieceTest, OnlyDistinctNodesCount) {
  const std::vector<PieceNode> nodes = {{{0, 1}, {0, 3}, 0.5, 0., true},
                                        {{0, 2}, {0, 3}, 0.7, 0., false},
                                        {{0, 3}, {0, 3}, 0.9, 0., true}};
  const auto pieces = JoinToPieces(Line(0), nodes, {2, 3});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].num_nodes, 2);
  EXPECT_EQ(pieces[0].last_node, (GraphId{0, 3}));
  EXPECT_NEAR(pieces[0].fraction, 0.7, 1e-12);
  EXPECT_TRUE(JoinToPieces(Line(0), nodes, {3, 3}).empty());
}

TEST(PathPieceTest, TrajectoriesAreNotJoined) {
  MapGraph graph = Line(0);
  for (const auto& node : Line(1).nodes) graph.nodes.insert(node);
  const std::vector<PieceNode> nodes = {{{0, 19}, {0, 0}, 1., 0.},
                                        {{1, 19}, {0, 0}, 1., 0.}};
  EXPECT_EQ(JoinToPieces(graph, nodes, {1, 5}).size(), 2u);
  EXPECT_TRUE(JoinToPieces(graph, nodes, {2, 5}).empty());
  EXPECT_TRUE(JoinToPieces(graph, {}, {0, 5}).empty());
}

MapGraph Path(const int trajectory_id, const std::vector<Pose2>& poses) {
  MapGraph graph;
  for (const Pose2& pose : poses) {
    graph.nodes[{trajectory_id, static_cast<int>(graph.nodes.size())}]
        .global_pose = pose;
  }
  return graph;
}

TEST(DistinctNodesTest, SmallStepsCountOnceTheyAddUp) {
  const MapGraph graph = Path(0, {{0., 0., 0.},
                                  {0.06, 0., 0.},
                                  {0.12, 0., 0.},
                                  {0.12, 0.01, 0.05},
                                  {0.12, 0., 0.15},
                                  {0.12, 0., 0.16}});
  EXPECT_THAT(DistinctNodes(graph, {0.1, 0.1}),
              ElementsAre(GraphId{0, 0}, GraphId{0, 2}, GraphId{0, 4}));
}

TEST(DistinctNodesTest, TurnsAreTakenTheShorterWay) {
  const MapGraph graph =
      Path(0, {{0., 0., kPi - 0.02}, {0., 0., 0.02 - kPi}, {0., 0., -3.}});
  EXPECT_THAT(DistinctNodes(graph, {0.1, 0.1}),
              ElementsAre(GraphId{0, 0}, GraphId{0, 2}));
}

TEST(DistinctNodesTest, EachTrajectoryBegins) {
  MapGraph graph = Path(0, {{0., 0., 0.}, {0., 0., 0.}});
  for (const auto& node : Path(1, {{0., 0., 0.}, {0., 0., 0.}}).nodes) {
    graph.nodes.insert(node);
  }
  EXPECT_THAT(DistinctNodes(graph, {0.1, 0.1}),
              ElementsAre(GraphId{0, 0}, GraphId{1, 0}));
  EXPECT_TRUE(DistinctNodes(MapGraph(), {0.1, 0.1}).empty());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
