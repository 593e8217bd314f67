// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pose_graph_export.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

MapGraph SmallGraph() {
  MapGraph graph;
  graph.submaps[{0, 0}].global_pose = Pose2(1., 2., 0.5);
  graph.submaps[{1, 3}].global_pose = Pose2(3., 4., 0.);
  graph.nodes[{0, 7}].global_pose = Pose2(5., 6., 0.);
  graph.constraints.resize(1);
  graph.constraints[0].submap_id = {1, 3};
  graph.constraints[0].node_id = {0, 7};
  graph.constraints[0].relative_pose = Pose2(2., 2., 0.);
  graph.constraints[0].translation_weight = 10.;
  graph.constraints[0].rotation_weight = 20.;
  return graph;
}

TEST(PoseGraphExportTest, NumbersVerticesAndSquaresWeights) {
  const auto g2o = ToG2o(SmallGraph());
  ASSERT_TRUE(g2o.ok());
  ASSERT_EQ(g2o->vertices.size(), 3u);
  EXPECT_EQ(g2o->vertices.at(0).theta, 0.5);
  EXPECT_EQ(g2o->vertices.at(2000003).x, 3.);
  EXPECT_EQ(g2o->vertices.at(1000007).y, 6.);
  ASSERT_EQ(g2o->edges.size(), 1u);
  EXPECT_EQ(g2o->edges[0].from, 2000003);
  EXPECT_EQ(g2o->edges[0].to, 1000007);
  EXPECT_EQ(g2o->edges[0].measurement.x, 2.);
  EXPECT_EQ(g2o->edges[0].information(0, 0), 100.);
  EXPECT_EQ(g2o->edges[0].information(1, 1), 100.);
  EXPECT_EQ(g2o->edges[0].information(2, 2), 400.);
  EXPECT_EQ(g2o->edges[0].information(0, 1), 0.);
  EXPECT_EQ(g2o->fixed, std::set<int64_t>{0});
}

TEST(PoseGraphExportTest, LeavesOutWhatCannotBeAnEdge) {
  MapGraph graph = SmallGraph();
  graph.constraints[0].translation_weight = 0.;
  EXPECT_TRUE(ToG2o(graph)->edges.empty());
  graph = SmallGraph();
  graph.constraints[0].node_id = {0, 8};
  EXPECT_TRUE(ToG2o(graph)->edges.empty());
}

TEST(PoseGraphExportTest, RefusesIndicesThatWouldMeet) {
  MapGraph graph;
  graph.nodes[{0, 1000000}];
  EXPECT_FALSE(ToG2o(graph).ok());
  graph.nodes.clear();
  graph.submaps[{0, -1}];
  EXPECT_FALSE(ToG2o(graph).ok());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
