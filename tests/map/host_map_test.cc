// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/host_map.h"

#include "cartographer_ext/slam/slam_runner.h"
#include "gtest/gtest.h"
#include "tests/slam/room_source.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(HostMapTest, DescribesAFinishedRun) {
  const auto configuration =
      LoadSlamConfiguration({"configuration_files"}, "stock.lua");
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  test::RoomSource source(60);
  const auto run = RunSlam(*configuration, &source, SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  const auto& pose_graph = *run->map_builder->pose_graph();

  const MapGraph graph = MakeMapGraph(pose_graph);
  ASSERT_EQ(static_cast<int64_t>(graph.nodes.size()), run->nodes);
  ASSERT_EQ(static_cast<int64_t>(graph.submaps.size()), run->submaps);
  const auto inserted = graph.InsertedNodes();
  EXPECT_EQ(inserted.size(), graph.submaps.size());
  io::TimeNs previous = 0;
  for (const auto& entry : graph.nodes) {
    EXPECT_GT(entry.second.time, previous);
    previous = entry.second.time;
  }
  for (const GraphConstraint& constraint : graph.constraints) {
    EXPECT_FALSE(constraint.is_loop);
    EXPECT_EQ(constraint.translation_weight, 500.);
    EXPECT_EQ(constraint.rotation_weight, 1600.);
    const Pose2 residual =
        Residual(constraint, graph.submaps.at(constraint.submap_id),
                 graph.nodes.at(constraint.node_id));
    EXPECT_LT(residual.translation().norm(), 0.05);
    EXPECT_LT(std::abs(residual.theta), 0.02);
  }
  const auto map = PaintHostMap(pose_graph, 0.1);
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->resolution, 0.1);
  EXPECT_GT(map->width, 30);
  EXPECT_FALSE(PaintHostMap(pose_graph, -1.).ok());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
