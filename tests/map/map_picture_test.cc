// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_picture.h"

#include <fstream>
#include <iterator>
#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(MapPictureTest, WritesAPngEvenWithLooseEnds) {
  io::OccupancyMap map =
      io::OccupancyMap::Make(20, 10, 0.1, Pose2(-1., 0., 0.));
  map.at(3, 4) = 0.9f;
  MapGraph graph;
  graph.submaps[{0, 0}];
  graph.nodes[{0, 0}].global_pose = Pose2(0.2, 0.3, 0.);
  graph.nodes[{0, 1}].global_pose = Pose2(0.4, 0.3, 0.);
  graph.constraints.resize(3);
  graph.constraints[0].node_id = {0, 0};
  graph.constraints[1].node_id = {0, 1};
  graph.constraints[1].is_loop = true;
  graph.constraints[1].relative_pose = Pose2(5., 5., 0.);
  graph.constraints[2].node_id = {0, 99};
  graph.constraints[2].is_loop = true;
  const std::string filename = testing::TempDir() + "map_picture.png";
  ASSERT_TRUE(WriteMapPicture(map, graph, "test", filename).ok());
  std::ifstream stream(filename, std::ios::binary);
  const std::string content(std::istreambuf_iterator<char>(stream), {});
  ASSERT_GT(content.size(), 100u);
  EXPECT_EQ(content.substr(1, 3), "PNG");
}

TEST(MapPictureTest, UnwritablePathsAreErrors) {
  const io::OccupancyMap map = io::OccupancyMap::Make(2, 2, 0.1, Pose2());
  EXPECT_FALSE(WriteMapPicture(map, MapGraph(), "", "/nowhere/x.png").ok());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
