// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_contents.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/map/host_types.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"
#include "tests/map/probability_grid.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::Grid2D;
using cartographer_ext::test::FreeGrid;
using cartographer_ext::test::SetCell;

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

// Of a file grid by grid, as of the whole file.
TEST(MapContentsTest, ReadsAFileInPieces) {
  const std::string filename = testing::TempDir() + "/map_contents.pbstream";
  io::Pbstream example = io::ExamplePbstream();
  for (auto& submap : example.submaps) {
    auto* const grid = submap.mutable_submap_2d()->mutable_grid();
    grid->set_min_correspondence_cost(0.1f);
    grid->set_max_correspondence_cost(0.9f);
  }
  ASSERT_TRUE(io::WritePbstream(example, filename).ok());
  const MapContents whole = ReadMapContents(example, {});
  for (const bool keep_grids : {false, true}) {
    MapContentsOptions options;
    options.keep_grids = keep_grids;
    const auto map = ReadMapFile(filename, options);
    ASSERT_TRUE(map.ok()) << map.status();
    EXPECT_EQ(map->contents.scans, whole.scans);
    ASSERT_EQ(map->contents.submaps.size(), 2u);
    for (const auto& submap : map->contents.submaps) {
      const SubmapGrid& grid = submap.second.grid();
      const SubmapGrid& other = whole.submaps.at(submap.first).grid();
      ASSERT_EQ(grid.num_x(), other.num_x());
      ASSERT_EQ(grid.num_y(), other.num_y());
      EXPECT_EQ(grid.num_known(), other.num_known());
      EXPECT_EQ(grid.max_corner(), other.max_corner());
    }
    const auto& grid = map->pbstream.submaps[0].submap_2d().grid();
    EXPECT_EQ(grid.cells_size() > 0, keep_grids);
    EXPECT_GT(grid.limits().resolution(), 0.);
  }
  std::remove(filename.c_str());
  EXPECT_TRUE(absl::IsNotFound(ReadMapFile(filename, {}).status()));
}

// Of a map that is to be painted alone.
TEST(MapContentsTest, TakesTheGrids) {
  Grid2D grid = FreeGrid();
  SetCell(2, 1, 1, &grid);
  MapContents contents;
  contents.submaps.emplace(GraphId{0, 3},
                           SubmapCells(*SubmapGrid::Make(grid), 0.1));
  MapGraph graph;
  graph.submaps[{0, 3}].global_pose = Pose2(10., 0., 0.);
  const auto expected = PaintContents(graph, contents, 0.05);
  ASSERT_TRUE(expected.ok()) << expected.status();
  const MapGrids grids = TakeGrids(std::move(contents));
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_GT(grids.at({0, 3}).num_known(), 0);
  const auto painted = PaintGrids(graph, grids, 0.05);
  ASSERT_TRUE(painted.ok()) << painted.status();
  ASSERT_EQ(painted->occupancy.size(), expected->occupancy.size());
  for (size_t i = 0; i < expected->occupancy.size(); ++i) {
    if (std::isnan(expected->occupancy[i])) {
      EXPECT_TRUE(std::isnan(painted->occupancy[i]));
    } else {
      EXPECT_EQ(painted->occupancy[i], expected->occupancy[i]);
    }
  }
  EXPECT_FALSE(PaintGrids(MapGraph(), grids, 0.05).ok());
}

TEST(MapContentsTest, PaintsWhatGraphAndContentsShare) {
  Grid2D grid = FreeGrid();
  SetCell(2, 1, 1, &grid);
  MapContents contents;
  for (const int i : {0, 1}) {
    contents.submaps.emplace(GraphId{0, i},
                             SubmapCells(*SubmapGrid::Make(grid), 0.1));
  }
  MapGraph graph;
  graph.submaps[{0, 0}].global_pose = Pose2(10., 0., 0.);
  graph.submaps[{0, 7}];
  const auto map = PaintContents(graph, contents, 0.1);
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_NEAR(map->width, 10, 1);
  EXPECT_NEAR(map->height, 6, 1);
  const auto at = [&map](const double x, const double y) {
    return map->at(static_cast<int>((x - map->origin.x) / 0.1),
                   static_cast<int>((y - map->origin.y) / 0.1));
  };
  EXPECT_NEAR(at(11.85, 2.75), 0.9, 1e-6);
  EXPECT_NEAR(at(11.65, 2.75), 0.1, 1e-6);
  EXPECT_FALSE(PaintContents(MapGraph(), contents, 0.1).ok());
}

TEST(MapContentsTest, LoopsAreScoredAtTheirOwnPose) {
  Grid2D grid = FreeGrid();
  SetCell(2, 1, 1, &grid);
  MapContents contents;
  contents.submaps.emplace(GraphId{0, 0},
                           SubmapCells(*SubmapGrid::Make(grid), 0.1));
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
