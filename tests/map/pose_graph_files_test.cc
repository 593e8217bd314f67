// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pose_graph_files.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;

std::string Temporary(const std::string& name) {
  return testing::TempDir() + "pose_graph_files_test_" + name;
}

TEST(PoseGraphFilesTest, ReadsVerticesEdgesAndLoops) {
  const auto graph =
      ReadPoseGraph(cartographer_ext::test::OwnData("square.g2o"));
  ASSERT_TRUE(graph.ok()) << graph.status();
  ASSERT_EQ(graph->poses.size(), 4u);
  ASSERT_EQ(graph->edges.size(), 4u);
  EXPECT_EQ(graph->fixed, std::vector<int>({0}));
  EXPECT_FALSE(graph->edges[0].is_loop);
  EXPECT_TRUE(graph->edges[3].is_loop);
  EXPECT_EQ(graph->edges[0].information(0, 1), 1.);
}

TEST(PoseGraphFilesTest, WritesWhatItReads) {
  const auto graph =
      ReadPoseGraph(cartographer_ext::test::OwnData("square.g2o"));
  ASSERT_TRUE(graph.ok()) << graph.status();
  std::vector<Pose2> poses = graph->poses;
  poses[2].x = 7.25;
  const std::string filename = Temporary("copy.g2o");
  ASSERT_TRUE(WritePoseGraph(*graph, poses, filename).ok());
  const auto copy = ReadPoseGraph(filename);
  ASSERT_TRUE(copy.ok()) << copy.status();
  EXPECT_EQ(copy->poses[2].x, 7.25);
  EXPECT_EQ(copy->ids, graph->ids);
  EXPECT_EQ(copy->fixed, graph->fixed);
  ASSERT_EQ(copy->edges.size(), graph->edges.size());
  EXPECT_TRUE(copy->edges[0].information.isApprox(graph->edges[0].information));
  std::remove(filename.c_str());
}

TEST(PoseGraphFilesTest, ErrorsNameFileAndVertex) {
  const std::string filename = Temporary("dangling.g2o");
  std::ofstream(filename) << "VERTEX_SE2 0 0 0 0\n"
                             "EDGE_SE2 0 5 1 0 0 1 0 0 1 0 1\n";
  const auto graph = ReadPoseGraph(filename);
  ASSERT_FALSE(graph.ok());
  EXPECT_THAT(std::string(graph.status().message()), HasSubstr(filename));
  EXPECT_THAT(std::string(graph.status().message()), HasSubstr("5"));
  std::remove(filename.c_str());
}

TEST(PoseGraphFilesTest, TruthById) {
  const std::string file = cartographer_ext::test::OwnData("square.g2o");
  const auto graph = ReadPoseGraph(file);
  ASSERT_TRUE(graph.ok()) << graph.status();
  const auto truth = ReadTruth(*graph, graph->poses, file);
  ASSERT_TRUE(truth.ok()) << truth.status();
  ASSERT_EQ(truth->size(), 4u);
  EXPECT_EQ((*truth)[1].x, 1.);
}

TEST(PoseGraphFilesTest, VerdictTableListsLoopsOnly) {
  const auto graph =
      ReadPoseGraph(cartographer_ext::test::OwnData("square.g2o"));
  ASSERT_TRUE(graph.ok()) << graph.status();
  const auto result = optimization::Optimize(*graph, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const std::string table = VerdictTable(*graph, *result);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
  EXPECT_THAT(table, HasSubstr("edge,from,to,chi2,weight,accepted\n3,3,0,"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
