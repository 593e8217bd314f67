// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/revisit_displacement.h"

#include <algorithm>
#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/map/verdict/box_world.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr int kNever = 1000;

RevisitDisplacements Displacements(const test::BoxWorld& world) {
  DisplacementOptions options;
  options.free_length = -1.;  // the path has 2 m
  return FindDisplacements(world.graph, world.contents,
                           FindContradictions(world.graph, world.contents, {}),
                           options);
}

// Leaves two parallel walls, as in a corridor along x without doors.
void KeepTheWallsAlongX(test::BoxWorld* const world) {
  for (auto& scan : world->contents.scans) {
    const Pose2& pose = world->graph.nodes.at(scan.first).local_pose;
    auto& points = scan.second;
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&pose](const Eigen::Vector2d& point) {
                                  return std::abs((pose * point).x()) > 2.;
                                }),
                 points.end());
  }
}

TEST(RevisitDisplacementTest, ARightMapIsInPlace) {
  const RevisitDisplacements result =
      Displacements(test::MakeBoxWorld(kNever, Pose2()));
  EXPECT_GT(result.judged_nodes, 40);
  EXPECT_EQ(result.displaced_nodes, 0);
  EXPECT_TRUE(result.pieces.empty());
  EXPECT_EQ(result.displaced_share(), 0.);
  EXPECT_EQ(result.tied_share, 1.);
  ASSERT_EQ(static_cast<int>(result.ties.size()), result.judged_nodes);
  for (const RevisitTie& tie : result.ties) {
    // Nodes 0 to 9 and 90 to 99 were inserted.
    EXPECT_TRUE(tie.anchor_id.index < 10 || tie.anchor_id.index >= 90);
    EXPECT_GT(tie.information(0, 0), 10.);
    EXPECT_GT(tie.information(1, 1), 10.);
  }
}

// Nodes 60 to 99 lie 0.6 m from where they belong, with the second submap: they
// do not fit the first one, and nodes 0 to 49 do not fit the second one.
TEST(RevisitDisplacementTest, FindsHowFarTheMapIsDisplaced) {
  const RevisitDisplacements result =
      Displacements(test::MakeBoxWorld(60, Pose2(0., 0.6, 0.)));
  // Between nodes 49 and 60 scans of both kinds are judged together.
  EXPECT_GE(result.displaced_nodes, result.judged_nodes - 5);
  ASSERT_EQ(result.pieces.size(), 2u);
  EXPECT_EQ(result.pieces[0].first_node, (GraphId{0, 0}));
  EXPECT_EQ(result.pieces[1].first_node, (GraphId{0, 60}));
  for (const PathPiece& piece : result.pieces) {
    // Walls are 0.2 m thick, and a return meets one at 0.1 m.
    EXPECT_GT(piece.displacement, 0.3);
    EXPECT_LT(piece.displacement, 0.65);
    EXPECT_EQ(piece.fraction, 0.);
  }
  // Those between that agree tie less than the whole.
  EXPECT_LT(result.tied_share, 0.6);
  EXPECT_LE(result.ties.size(), 5u);
}

TEST(RevisitDisplacementTest, ABlankCorridorDoesNotTell) {
  test::BoxWorld world = test::MakeBoxWorld(60, Pose2(0.6, 0., 0.));
  KeepTheWallsAlongX(&world);
  RevisitDisplacements result = Displacements(world);
  EXPECT_GT(result.judged_nodes, 40);
  EXPECT_EQ(result.displaced_nodes, 0);
  ASSERT_FALSE(result.ties.empty());
  for (const RevisitTie& tie : result.ties) {
    EXPECT_LT(tie.information(0, 0), 1.);
    EXPECT_GT(tie.information(1, 1), 10.);
  }
  // Across the corridor it does.
  world = test::MakeBoxWorld(60, Pose2(0., 0.6, 0.));
  KeepTheWallsAlongX(&world);
  result = Displacements(world);
  EXPECT_GE(result.displaced_nodes, result.judged_nodes - 5);
}

TEST(RevisitDisplacementTest, ScansOfAnotherPlaceSayNothing) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  for (auto& scan : world.contents.scans) {
    for (Eigen::Vector2d& point : scan.second) point *= 0.5;
  }
  const RevisitDisplacements result = Displacements(world);
  EXPECT_GT(result.nodes.size(), 40u);
  EXPECT_EQ(result.judged_nodes, 0);
  EXPECT_EQ(result.displaced_share(), 0.);
}

TEST(RevisitDisplacementTest, LoopsTieThePathToo) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  world.contents.scans.clear();
  EXPECT_EQ(Displacements(world).tied_share, 0.);
  for (int i = 0; i < 10; ++i) {
    GraphConstraint loop;
    loop.submap_id = {0, 0};  // nodes 0 to 9
    loop.node_id = {0, 60 + i};
    loop.is_loop = true;
    world.graph.constraints.push_back(loop);
  }
  // One tie is enough where no node is looked at.
  EXPECT_NEAR(Displacements(world).tied_share, 0.70, 1e-9);
}

TEST(RevisitDisplacementTest, LooksAtFewerNodesOfLargeMaps) {
  const test::BoxWorld world = test::MakeBoxWorld(60, Pose2(0., 0.6, 0.));
  const Contradictions contradictions =
      FindContradictions(world.graph, world.contents, {});
  DisplacementOptions options;
  options.max_nodes = 20;
  const RevisitDisplacements result =
      FindDisplacements(world.graph, world.contents, contradictions, options);
  EXPECT_LE(result.nodes.size(), 22u);  // a run begins with the first node
  EXPECT_GT(result.displaced_share(), 0.7);
}

TEST(RevisitDisplacementTest, AShortPathNeedsNoTies) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  world.contents.scans.clear();
  EXPECT_EQ(FindDisplacements(world.graph, world.contents, {}, {}).tied_share,
            1.);
}

TEST(RevisitDisplacementTest, EmptyMap) {
  const RevisitDisplacements result = Displacements({});
  EXPECT_TRUE(result.nodes.empty());
  EXPECT_EQ(result.tied_share, 0.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
