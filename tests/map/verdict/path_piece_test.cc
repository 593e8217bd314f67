// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/path_piece.h"

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

TEST(PathPieceTest, TrajectoriesAreNotJoined) {
  MapGraph graph = Line(0);
  for (const auto& node : Line(1).nodes) graph.nodes.insert(node);
  const std::vector<PieceNode> nodes = {{{0, 19}, {0, 0}, 1., 0.},
                                        {{1, 19}, {0, 0}, 1., 0.}};
  EXPECT_EQ(JoinToPieces(graph, nodes, {1, 5}).size(), 2u);
  EXPECT_TRUE(JoinToPieces(graph, nodes, {2, 5}).empty());
  EXPECT_TRUE(JoinToPieces(graph, {}, {0, 5}).empty());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
