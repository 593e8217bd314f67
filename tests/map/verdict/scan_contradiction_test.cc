// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/scan_contradiction.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/map/verdict/box_world.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::ElementsAre;

constexpr int kNever = 1000;

TEST(MapContentsTest, CellsSayWhatTheGridSays) {
  const SubmapCells cells(*SubmapGrid::Make(test::BoxGrid()), 0.15);
  EXPECT_EQ(cells.At({0., 0.}), CellEvidence::kFree);
  EXPECT_EQ(cells.At({4., 1.}), CellEvidence::kOccupied);
  EXPECT_EQ(cells.At({3.75, 1.}), CellEvidence::kUnsure);  // beside the wall
  EXPECT_EQ(cells.At({4.5, 1.}), CellEvidence::kUnsure);   // not known
  EXPECT_EQ(cells.At({40., 1.}), CellEvidence::kUnsure);   // outside
  EXPECT_TRUE(cells.NearOccupied({3.75, 1.}));
  EXPECT_FALSE(cells.NearOccupied({3., 1.}));
  EXPECT_EQ(cells.min_corner(), Eigen::Vector2d(-5., -5.));
  // Four sides of 82 cells, two thick: 82^2 - 78^2.
  EXPECT_EQ(cells.OccupiedCells().size(), 640u);
}

TEST(MapContentsTest, CountsPointsNearWallsUnderShifts) {
  const SubmapCells cells(*SubmapGrid::Make(test::BoxGrid()), 0.15);
  // Walls from 3.9 to 4.1 m in cells of 0.1 m; the grid ends at 5 m.
  const std::vector<Eigen::Vector2d> points = {
      {3.95, 0.}, {3.75, 0.}, {3., 0.}, {-3.95, 0.}};
  const std::vector<Eigen::Vector2d> shifts = {
      {0., 0.}, {0.1, 0.}, {0.9, 0.}, {0., -8.}, {2., 2.}};
  EXPECT_THAT(cells.CountNearOccupied(points, shifts, 0.1),
              ElementsAre(2, 3, 1, 0, 0));
  EXPECT_THAT(cells.CountNearOccupied(points, shifts, 0.2),
              ElementsAre(3, 3, 1, 0, 0));
  EXPECT_THAT(cells.CountNearOccupied({}, {{0., 0.}}, 0.1), ElementsAre(0));
}

TEST(MapContentsTest, ScoresWhereTheScanFits) {
  const SubmapCells cells(*SubmapGrid::Make(test::BoxGrid()), 0.15);
  const Pose2 pose(1., -0.5, 0.3);
  const auto scan = test::BoxScan(pose);
  EXPECT_GT(cells.Score(scan, pose), 0.85);
  EXPECT_LT(cells.Score(scan, pose * Pose2(0.5, 0.4, 0.)), 0.3);
  EXPECT_EQ(cells.Score({}, pose), 0.);
}

TEST(ScanContradictionTest, ARightMapHasNone) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  const Contradictions result =
      FindContradictions(world.graph, world.contents, {});
  EXPECT_GT(result.judged_nodes, 90);
  EXPECT_EQ(result.conflict_nodes, 0);
  EXPECT_LT(result.ray_fraction(), 0.01);
  EXPECT_TRUE(result.pieces.empty());
  EXPECT_EQ(result.nodes.size(), 100u);
}

TEST(ScanContradictionTest, NodesMovedAwayContradictTheFirstSubmap) {
  const test::BoxWorld world =
      test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)));
  const Contradictions result =
      FindContradictions(world.graph, world.contents, {});
  ASSERT_GE(result.pieces.size(), 1u);
  // Those are nodes 60 to 99, and nodes 0 to 49 against the second submap.
  const PathPiece& last = result.pieces.back();
  EXPECT_EQ(last.first_node, (GraphId{0, 60}));
  EXPECT_EQ(last.last_node, (GraphId{0, 99}));
  EXPECT_EQ(last.num_nodes, 40);
  EXPECT_THAT(last.submaps, ElementsAre(GraphId{0, 0}));
  EXPECT_GT(last.fraction, 0.6);
  EXPECT_NEAR(last.metres, 39 * 0.02, 1e-9);
  EXPECT_NEAR(io::ToSeconds(last.begin), 60., 1e-9);
  EXPECT_GT(result.node_fraction(), 0.5);
}

// What is judged are the poses of the nodes, not where the submap, which may be
// bent, is drawn.
TEST(ScanContradictionTest, SubmapsArePlacedByTheirNodes) {
  const Pose2 wrong(1.5, 1.2, DegToRad(20.));
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  world.graph.submaps.at({0, 1}).global_pose = wrong;
  EXPECT_EQ(FindContradictions(world.graph, world.contents, {}).conflict_nodes,
            0);
  world = test::MakeBoxWorld(90, wrong);
  world.graph.submaps.at({0, 1}).global_pose = Pose2();
  const Contradictions result =
      FindContradictions(world.graph, world.contents, {});
  ASSERT_EQ(result.pieces.size(), 2u);
  EXPECT_EQ(result.pieces.front().first_node, (GraphId{0, 0}));
  EXPECT_THAT(result.pieces.front().submaps, ElementsAre(GraphId{0, 1}));
  EXPECT_EQ(result.pieces.back().num_nodes, 10);
}

// Of the nodes inserted in a submap the nearest one places it.
TEST(ScanContradictionTest, ABentSubmapIsPlacedPieceByPiece) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  for (int i = 95; i < 100; ++i) {
    auto& pose = world.graph.nodes.at({0, i}).global_pose;
    pose = Pose2(0., 40., 0.) * pose;  // far from all others
  }
  const Contradictions result =
      FindContradictions(world.graph, world.contents, {});
  EXPECT_GT(result.judged_nodes, 40);
  EXPECT_EQ(result.conflict_nodes, 0);
}

TEST(ScanContradictionTest, OwnAndNeighbouringSubmapsDoNotCount) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  ContradictionOptions options;
  options.min_node_gap = 200;
  EXPECT_EQ(
      FindContradictions(world.graph, world.contents, options).judged_nodes, 0);
}

TEST(ScanContradictionTest, EmptyMap) {
  const Contradictions result =
      FindContradictions(MapGraph(), MapContents(), {});
  EXPECT_EQ(result.ray_fraction(), 0.);
  EXPECT_EQ(result.node_fraction(), 0.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
