// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_contents.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_ext/map/host_types.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;

// Ten by six cells of 0.1 m in x and y, corner at (2, 3): x from 1 to 2, y from
// 2.4 to 3. Cell (ix, iy) is ix from the top and iy from the right.
Grid2D FreeGrid() {
  Grid2D grid;
  grid.mutable_limits()->set_resolution(0.1);
  grid.mutable_limits()->mutable_max()->set_x(2.);
  grid.mutable_limits()->mutable_max()->set_y(3.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(6);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(10);
  grid.mutable_probability_grid_2d();
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  for (int i = 0; i < 60; ++i) grid.add_cells(32767);
  return grid;
}

void Set(const int ix, const int iy, const int value, Grid2D* const grid) {
  grid->set_cells(6 * iy + ix, value);
}

TEST(MapContentsTest, CellsSayWhatIsSure) {
  Grid2D grid = FreeGrid();
  Set(2, 1, 1, &grid);      // x 1.8 to 1.9, y 2.7 to 2.8: occupied
  Set(2, 5, 16384, &grid);  // x 1.4 to 1.5: as likely as not
  Set(2, 8, 0, &grid);      // x 1.1 to 1.2: unknown
  const SubmapCells cells(grid, 0.1);
  EXPECT_EQ(cells.resolution(), 0.1);
  EXPECT_EQ(cells.num_x(), 6);
  EXPECT_EQ(cells.num_y(), 10);
  EXPECT_NEAR(cells.min_corner().x(), 1., 1e-12);
  EXPECT_NEAR(cells.min_corner().y(), 2.4, 1e-12);
  EXPECT_NEAR(cells.max_corner().y(), 3., 1e-12);
  EXPECT_EQ(cells.At({1.85, 2.75}), CellEvidence::kOccupied);
  // Within the margin of what is not free.
  EXPECT_EQ(cells.At({1.75, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.75, 2.65}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.45, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.15, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.65, 2.45}), CellEvidence::kFree);
  // Outside.
  EXPECT_EQ(cells.At({2.05, 2.75}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({1.5, 3.05}), CellEvidence::kUnsure);
  EXPECT_EQ(cells.At({std::nan(""), 2.5}), CellEvidence::kUnsure);
  EXPECT_TRUE(cells.NearOccupied({1.85, 2.75}));
  EXPECT_TRUE(cells.NearOccupied({1.95, 2.85}));
  EXPECT_FALSE(cells.NearOccupied({1.65, 2.75}));
  EXPECT_FALSE(cells.NearOccupied({1.15, 2.75}));
  EXPECT_FALSE(cells.NearOccupied({5., 5.}));
  ASSERT_EQ(cells.OccupiedCells().size(), 1u);
  EXPECT_NEAR((cells.OccupiedCells()[0] - Eigen::Vector2d(1.85, 2.75)).norm(),
              0., 1e-9);
}

TEST(MapContentsTest, WithoutMarginEveryCellStandsForItself) {
  Grid2D grid = FreeGrid();
  Set(2, 1, 1, &grid);
  const SubmapCells cells(grid, 0.);
  EXPECT_EQ(cells.At({1.75, 2.75}), CellEvidence::kFree);
  EXPECT_FALSE(cells.NearOccupied({1.75, 2.75}));
}

// In grids with some occupied cells, a walk of clear steps from anywhere never
// ends in one of them, and most steps are clear in the middle of an empty grid.
TEST(MapContentsTest, ClearStepsMeetNoWall) {
  std::mt19937 random(7);
  const auto uniform = [&](const double from, const double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int skipped = 0;
  for (int round = 0; round < 300; ++round) {
    Grid2D grid = FreeGrid();
    for (int i = round % 4; i > 0; --i) {
      Set(static_cast<int>(uniform(0., 6.)), static_cast<int>(uniform(0., 10.)),
          1, &grid);
    }
    const SubmapCells cells(grid, 0.1);
    const Eigen::Vector2d from(uniform(0., 3.), uniform(1.5, 4.));
    const double angle = uniform(-kPi, kPi);
    const Eigen::Vector2d step(0.1 * std::cos(angle), 0.1 * std::sin(angle));
    const CellView view = cells.View(from);
    EXPECT_EQ(view.evidence, cells.At(from));
    for (int i = 1; i <= std::min(view.clear_steps, 100); ++i) {
      EXPECT_NE(cells.At(from + i * step), CellEvidence::kOccupied);
      ++skipped;
    }
  }
  EXPECT_GT(skipped, 1000);
  const SubmapCells cells(FreeGrid(), 0.1);
  EXPECT_EQ(cells.View({std::nan(""), 2.5}).clear_steps, 0);
}

TEST(MapContentsTest, ScoresAreMeansOfProbabilities) {
  Grid2D grid = FreeGrid();
  Set(2, 1, 1, &grid);      // 0.9
  Set(2, 5, 16384, &grid);  // 0.5
  const SubmapCells cells(grid, 0.1);
  const Pose2 at_corner(1., 2.4, 0.);
  EXPECT_EQ(cells.Score({}, at_corner), 0.);
  EXPECT_NEAR(cells.Score({{0.85, 0.35}}, at_corner), 0.9, 3e-3);
  // Occupied, half, free (0.1), outside (0.1).
  EXPECT_NEAR(cells.Score({{0.85, 0.35}, {0.45, 0.35}, {0.25, 0.05}, {9., 9.}},
                          at_corner),
              (0.9 + 0.5 + 0.1 + 0.1) / 4., 3e-3);
  // Turned by a quarter: (0.35, -0.85) comes to lie at (0.85, 0.35).
  EXPECT_NEAR(cells.Score({{0.35, -0.85}}, Pose2(1., 2.4, kPi / 2.)), 0.9,
              3e-3);
}

// A node whose robot is turned by `yaw` in the local frame, while its cloud
// keeps to the frame that gravity alignment leaves.
void AddNode(const int index, const double yaw, const int num_points,
             io::Pbstream* const pbstream) {
  cartographer::mapping::TrajectoryNode::Data data;
  data.time = ToHostTime(index + 1);
  data.gravity_alignment =
      Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  data.local_pose = cartographer::transform::Rigid3d(
      Eigen::Vector3d(1., 2., 0.),
      Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())));
  for (int i = 0; i < num_points; ++i) {
    data.filtered_gravity_aligned_point_cloud.push_back(
        {Eigen::Vector3f(1.f + 0.01f * static_cast<float>(i), 0.f, 0.f)});
  }
  pbstream->nodes.emplace_back();
  pbstream->nodes.back().mutable_node_id()->set_node_index(index);
  *pbstream->nodes.back().mutable_node_data() =
      cartographer::mapping::ToProto(data);
}

TEST(MapContentsTest, ReadsScansAndGrids) {
  io::Pbstream pbstream;
  AddNode(0, 0., 3, &pbstream);
  AddNode(1, kPi / 2., 3, &pbstream);
  AddNode(2, 0., 25, &pbstream);
  pbstream.submaps.resize(3);
  for (int i = 0; i < 3; ++i) {
    pbstream.submaps[i].mutable_submap_id()->set_submap_index(i);
  }
  *pbstream.submaps[0].mutable_submap_2d()->mutable_grid() = FreeGrid();
  // One without a grid, and one whose grid has too few cells.
  *pbstream.submaps[2].mutable_submap_2d()->mutable_grid() = FreeGrid();
  pbstream.submaps[2].mutable_submap_2d()->mutable_grid()->clear_cells();
  MapContentsOptions options;
  options.max_points = 10;
  const MapContents contents = ReadMapContents(pbstream, options);
  ASSERT_EQ(contents.scans.size(), 3u);
  ASSERT_EQ(contents.submaps.size(), 1u);
  EXPECT_EQ(contents.submaps.begin()->first, (GraphId{0, 0}));
  // Clouds are stored to the millimetre.
  const auto& straight = contents.scans.at({0, 0});
  ASSERT_EQ(straight.size(), 3u);
  EXPECT_NEAR((straight[0] - Eigen::Vector2d(1., 0.)).norm(), 0., 2e-3);
  // In the robot's frame the point is to the right.
  const auto& turned = contents.scans.at({0, 1});
  ASSERT_EQ(turned.size(), 3u);
  EXPECT_NEAR((turned[0] - Eigen::Vector2d(0., -1.)).norm(), 0., 2e-3);
  // Every third of 25.
  EXPECT_EQ(contents.scans.at({0, 2}).size(), 9u);
}

TEST(MapContentsTest, LoopsAreScoredAtTheirOwnPose) {
  Grid2D grid = FreeGrid();
  Set(2, 1, 1, &grid);
  MapContents contents;
  contents.submaps.emplace(GraphId{0, 0}, SubmapCells(grid, 0.1));
  contents.scans[{0, 5}] = {{0.85, 0.35}};
  MapGraph graph;
  graph.submaps[{0, 0}].local_pose = Pose2(1., 2.4, 0.);
  graph.submaps[{0, 1}];
  const auto add = [&graph](const int submap, const int node, const Pose2& pose,
                            const bool is_loop) {
    GraphConstraint constraint;
    constraint.submap_id = {0, submap};
    constraint.node_id = {0, node};
    constraint.relative_pose = pose;
    constraint.is_loop = is_loop;
    graph.constraints.push_back(constraint);
  };
  add(0, 5, Pose2(), false);
  add(0, 5, Pose2(), true);
  add(0, 5, Pose2(-0.3, 0., 0.), true);
  add(1, 5, Pose2(), true);  // no grid
  add(0, 6, Pose2(), true);  // no scan
  const std::vector<double> scores = LoopScores(graph, contents);
  ASSERT_EQ(scores.size(), 4u);
  EXPECT_NEAR(scores[0], 0.9, 3e-3);
  EXPECT_NEAR(scores[1], 0.1, 3e-3);
  EXPECT_EQ(scores[2], -1.);
  EXPECT_EQ(scores[3], -1.);
}

TEST(MapContentsTest, TheMapSeesTheLocalFrameThroughASubmap) {
  GraphSubmap submap;
  submap.local_pose = Pose2(1., 2., 0.);
  submap.global_pose = Pose2(5., 5., kPi / 2.);
  const Pose2 map_from_local = MapFromLocal(submap);
  // The submap's origin, and a point one metre along its x axis.
  EXPECT_NEAR(
      (map_from_local * Eigen::Vector2d(1., 2.) - Eigen::Vector2d(5., 5.))
          .norm(),
      0., 1e-12);
  EXPECT_NEAR(
      (map_from_local * Eigen::Vector2d(2., 2.) - Eigen::Vector2d(5., 6.))
          .norm(),
      0., 1e-12);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
