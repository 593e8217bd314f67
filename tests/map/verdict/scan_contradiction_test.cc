// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/scan_contradiction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

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

// Nodes from 60 on are displaced; the inserted nodes of both submaps have
// headings off by `heading_error`, in turn to either side.
test::BoxWorld WorldOfHeadings(const double heading_error, const Pose2& wrong) {
  test::BoxWorld world = test::MakeBoxWorld(60, wrong, 0.);
  for (int i = 0; i < 100; ++i) {
    if (10 <= i && i < 90) continue;
    world.graph.nodes.at({0, i}).global_pose.theta +=
        i % 2 == 0 ? heading_error : -heading_error;
  }
  return world;
}

int64_t NodesInConflict(const test::BoxWorld& world) {
  ContradictionOptions options;
  options.visit_distance = -10.;  // no two places are of one visit
  return FindContradictions(world.graph, world.contents, options)
      .conflict_nodes;
}

TEST(ScanContradictionTest, HeadingsThatAreNotKnownExplainATurnButNoShift) {
  const Pose2 turned(0., 0., DegToRad(-16.));
  EXPECT_GT(NodesInConflict(WorldOfHeadings(0., turned)), 20);
  EXPECT_EQ(NodesInConflict(WorldOfHeadings(DegToRad(4.), turned)), 0);
  const Pose2 moved(1.5, 1.2, 0.);
  EXPECT_GT(NodesInConflict(WorldOfHeadings(DegToRad(4.), moved)), 20);
  // More than half a metre at the walls is a conflict in any case.
  const Pose2 far_turned(0., 0., DegToRad(20.));
  EXPECT_GT(NodesInConflict(WorldOfHeadings(DegToRad(10.), far_turned)), 20);
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
  EXPECT_NEAR(last.metres, 39 * std::hypot(0.02, 2. * test::kSway), 1e-9);
  EXPECT_NEAR(io::ToSeconds(last.begin), 60., 1e-9);
  EXPECT_GT(result.node_fraction(), 0.5);
}

// However long it stands in the wrong place.
TEST(ScanContradictionTest, ARobotThatStandsIsCountedOnce) {
  test::BoxWorld world = test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)));
  const Contradictions moving =
      FindContradictions(world.graph, world.contents, {});
  for (int i = 61; i < 90; ++i) {
    world.graph.nodes.at({0, i}).global_pose =
        world.graph.nodes.at({0, 60}).global_pose;
    world.contents.scans.at({0, i}) = world.contents.scans.at({0, 60});
  }
  const Contradictions standing =
      FindContradictions(world.graph, world.contents, {});
  EXPECT_EQ(standing.nodes.size(), moving.nodes.size());
  EXPECT_EQ(standing.distinct_nodes, moving.distinct_nodes - 29);
  EXPECT_EQ(standing.judged_nodes, moving.judged_nodes - 29);
  EXPECT_EQ(standing.revisit_nodes, moving.revisit_nodes - 29);
  EXPECT_EQ(standing.conflict_nodes, moving.conflict_nodes - 29);
  EXPECT_EQ(standing.pieces.back().num_nodes, 11);
}

// On one visit local SLAM has aligned scans and submaps.
TEST(ScanContradictionTest, OneVisitIsToldApart) {
  const Pose2 wrong(1.5, 1.2, DegToRad(20.));
  const Contradictions passing =
      FindContradictions(test::MakeBoxWorld(60, wrong, 0.).graph,
                         test::MakeBoxWorld(60, wrong, 0.).contents, {});
  const test::BoxWorld world = test::MakeBoxWorld(60, wrong);
  const Contradictions revisit =
      FindContradictions(world.graph, world.contents, {});
  EXPECT_EQ(passing.revisit_nodes, 0);
  EXPECT_EQ(passing.conflict_nodes, 0);
  EXPECT_TRUE(passing.pieces.empty());
  ASSERT_GE(passing.passing_pieces.size(), 1u);
  // Of 40, every second one: two steps are more than a degree.
  EXPECT_EQ(passing.passing_pieces.back().num_nodes, 20);
  EXPECT_TRUE(passing.conflicts.front().is_one_visit);
  EXPECT_GT(revisit.conflict_nodes, 50);
  EXPECT_EQ(revisit.revisit_nodes, revisit.judged_nodes);
  EXPECT_TRUE(revisit.passing_pieces.empty());
  EXPECT_FALSE(revisit.conflicts.front().is_one_visit);
}

// The last 40 nodes see a person beside the robot, a circle of 0.56 m, 0.3 m away.
test::BoxWorld WorldWithPerson(const double sway) {
  constexpr double kAway = 0.3, kRadius = 0.28;
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2(), sway);
  for (int i = 60; i < 100; ++i) {
    for (Eigen::Vector2d& point : world.contents.scans.at({0, i})) {
      const double along = point.normalized().x() * kAway;
      const double beside = kAway * kAway - along * along;
      if (along <= 0. || beside >= kRadius * kRadius) continue;
      point =
          (along - std::sqrt(kRadius * kRadius - beside)) * point.normalized();
    }
  }
  return world;
}

TEST(ScanContradictionTest, APersonBesideTheRobotIsNoLostLocalSlam) {
  const auto found = [](const test::BoxWorld& world) {
    return FindContradictions(world.graph, world.contents, {});
  };
  EXPECT_TRUE(found(WorldWithPerson(0.)).passing_pieces.empty());
  // On another visit it counts: parts of the map may be in the wrong place.
  EXPECT_EQ(found(WorldWithPerson(test::kSway)).pieces.size(), 1u);
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

// The definition: along each ray every cell is looked at, one by one.
bool PlainlyCrossesWall(const SubmapCells& cells, const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to, const double margin) {
  const double length = (to - from).norm() - margin;
  const double step = cells.resolution();
  if (!(length > step)) return false;
  const Eigen::Vector2d start = cells.Cell(from);
  const Eigen::Vector2d direction = (cells.Cell(to) - start).normalized();
  bool in_wall = false;
  for (int i = 1; i < length / step; ++i) {
    const CellEvidence evidence =
        cells.ViewOfCell(start + i * direction).evidence;
    if (evidence == CellEvidence::kOccupied) in_wall = true;
    if (in_wall && evidence == CellEvidence::kFree) return true;
  }
  return false;
}

ScanConflict PlainlyHold(const std::vector<Eigen::Vector2d>& scan,
                         const Pose2& pose, const SubmapCells& cells,
                         const ContradictionOptions& options) {
  ScanConflict result;
  for (const Eigen::Vector2d& point : scan) {
    const Eigen::Vector2d end = pose * point;
    if (PlainlyCrossesWall(cells, pose.translation(), end,
                           options.ray_margin)) {
      ++result.judged;
      ++result.crossings;
    } else if (cells.NearOccupied(end)) {
      ++result.judged;
    } else if (cells.At(end) == CellEvidence::kFree) {
      ++result.judged;
      ++result.free_hits;
    }
  }
  return result;
}

// Rooms, pillars and patches of what is not known, cells of 0.1 m.
cartographer::mapping::proto::Grid2D RandomGrid(std::mt19937* const random) {
  const auto uniform = [random](const int from, const int to) {
    return std::uniform_int_distribution<int>(from, to)(*random);
  };
  cartographer::mapping::proto::Grid2D grid = test::BoxGrid();
  const bool is_small = uniform(0, 5) == 0;
  const int num_x = is_small ? uniform(1, 20) : uniform(60, 160);
  const int num_y = is_small ? uniform(1, 20) : uniform(60, 160);
  auto& limits = *grid.mutable_limits()->mutable_cell_limits();
  limits.set_num_x_cells(num_x);
  limits.set_num_y_cells(num_y);
  grid.clear_cells();
  grid.mutable_cells()->Resize(num_x * num_y, uniform(0, 3) == 0 ? 0 : 30000);
  for (int patch = uniform(0, 16); patch > 0; --patch) {
    const int values[] = {0, 1000, 1000, 16384, 30000, 30000, 30000};
    const int value = values[uniform(0, 6)];
    const bool is_wall = value == 1000;
    const int x = uniform(0, num_x - 1), y = uniform(0, num_y - 1);
    const int length = uniform(1, 90), width = uniform(1, is_wall ? 3 : 60);
    const bool along_x = uniform(0, 1) == 0;
    for (int iy = y; iy < std::min(num_y, y + (along_x ? width : length));
         ++iy) {
      for (int ix = x; ix < std::min(num_x, x + (along_x ? length : width));
           ++ix) {
        grid.set_cells(iy * num_x + ix, value);
      }
    }
  }
  return grid;
}

TEST(ScanContradictionTest, RaysMeetWhatAPlainWalkMeets) {
  std::mt19937 random(5);
  const auto uniform = [&random](const double from, const double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int64_t crossings = 0, free_hits = 0, judged = 0, dropped = 0;
  for (int round = 0; round < 3000; ++round) {
    const SubmapCells cells(*SubmapGrid::Make(RandomGrid(&random)),
                            uniform(0., 0.3));
    // In the grid or beside it, also at its corners, and along its axes.
    Pose2 pose(uniform(-9., 6.), uniform(-9., 6.), uniform(-kPi, kPi));
    if (round % 7 == 0) pose = Pose2(5. - 0.1 * (round % 50), 5., 0.5 * kPi);
    std::vector<Eigen::Vector2d> scan;
    for (int i = 0; i < 120; ++i) {
      const double angle = i * kPi / 60.;
      const double range = std::pow(uniform(0., 1.), 2.) * 15.;
      scan.emplace_back(range * std::cos(angle), range * std::sin(angle));
    }
    scan.emplace_back(0., 0.);
    ContradictionOptions options;
    options.ray_margin = round % 3 == 0 ? 0. : uniform(0., 1.);
    options.min_judged = round % 2 == 0 ? 0 : 25;
    const ScanConflict result = HoldAgainst(scan, pose, cells, options);
    const ScanConflict expected = PlainlyHold(scan, pose, cells, options);
    if (expected.judged < options.min_judged) {
      EXPECT_LT(result.judged, options.min_judged) << round;
      ++dropped;
      continue;
    }
    EXPECT_EQ(result.judged, expected.judged) << round;
    EXPECT_EQ(result.crossings, expected.crossings) << round;
    EXPECT_EQ(result.free_hits, expected.free_hits) << round;
    crossings += result.crossings;
    free_hits += result.free_hits;
    judged += result.judged;
  }
  EXPECT_GT(crossings, 2000);
  EXPECT_GT(free_hits, 20000);
  EXPECT_GT(judged - crossings - free_hits, 2000);
  EXPECT_GT(dropped, 30);
}

TEST(ScanContradictionTest, ARayOfAnyLengthIsSoonAtItsEnd) {
  const SubmapCells cells(*SubmapGrid::Make(test::BoxGrid()), 0.15);
  ContradictionOptions options;
  options.min_judged = 0;
  // Out of the box without free space behind its wall, and into it from afar.
  EXPECT_EQ(HoldAgainst({{9e8, -2e8}}, Pose2(), cells, options).judged, 0);
  EXPECT_EQ(
      HoldAgainst({{9e6, 0.}}, Pose2(-9e6, 0., 0.), cells, options).crossings,
      1);
  EXPECT_EQ(HoldAgainst({{std::numeric_limits<double>::infinity(), 0.}},
                        Pose2(), cells, options)
                .judged,
            0);
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
