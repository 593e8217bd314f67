// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/g2o.h"

#include <cmath>
#include <string>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

std::string ErrorOf(const std::string& text) {
  test::TemporaryFile file(".g2o");
  test::WriteBytes(file.path(), text);
  const auto graph = ReadG2o(file.path());
  EXPECT_EQ(graph.status().code(), absl::StatusCode::kInvalidArgument) << text;
  const std::string message(graph.status().message());
  EXPECT_THAT(message, HasSubstr(file.path()));
  return message.substr(std::min(message.size(), file.path().size()));
}

TEST(G2oTest, ReadsASquare) {
  const auto graph = ReadG2o(test::OwnData("square.g2o"));
  ASSERT_TRUE(graph.ok()) << graph.status();
  ASSERT_EQ(graph->vertices.size(), 4u);
  EXPECT_EQ(graph->vertices.at(2).y, 1.);
  EXPECT_EQ(graph->fixed, std::set<int64_t>{0});
  ASSERT_EQ(graph->edges.size(), 4u);
  const G2oEdge& edge = graph->edges[0];
  EXPECT_EQ(edge.from, 0);
  EXPECT_EQ(edge.to, 1);
  EXPECT_EQ(edge.line, 7);
  EXPECT_EQ(edge.measurement.x, 1.);
  EXPECT_NEAR(edge.measurement.theta, kPi / 2., 1e-15);
  Eigen::Matrix3d information;
  information << 100., 1., 2., 1., 110., 3., 2., 3., 400.;
  EXPECT_EQ(edge.information, information);
}

TEST(G2oTest, ReadsEdgesWithoutVerticesAndSkipsLandmarks) {
  test::TemporaryFile file(".g2o");
  test::WriteBytes(file.path(),
                   "EDGE_SE2 4 5 1 0 0 1 0 0 1 0 1\n"
                   "EDGE_SE2 7 5 1 0 0 1 0 0 1 0 1\n"
                   "VERTEX_XY 100 3 4\nEDGE_SE2_XY 4 100 1 2 1 0 1\n");
  const auto graph = ReadG2o(file.path());
  ASSERT_TRUE(graph.ok()) << graph.status();
  EXPECT_TRUE(graph->lacks_vertices);
  EXPECT_EQ(graph->vertices.size(), 3u);
  EXPECT_EQ(graph->vertices.count(7), 1u);
  EXPECT_EQ(graph->skipped.at("VERTEX_XY"), 1);
  EXPECT_EQ(graph->skipped.at("EDGE_SE2_XY"), 1);
}

TEST(G2oTest, ReadsBothOrdersOfEdge2) {
  const std::string vertices = "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\n";
  Eigen::Matrix3d information;
  information << 100., 1., 2., 1., 110., 3., 2., 3., 400.;
  test::TemporaryFile file(".graph");
  for (const char* const diagonal_and_full :
       {"1 0 0 2 0 3\nEDGE2 1 0 -1 0 0 100 1 2 110 3 400\n",     // iSAM
        "1 0 2 3 0 0\nEDGE2 1 0 -1 0 0 100 1 110 400 2 3\n"}) {  // TORO
    test::WriteBytes(file.path(),
                     vertices + "EDGE2 0 1 1 0 0 " + diagonal_and_full);
    const auto graph = ReadG2o(file.path());
    ASSERT_TRUE(graph.ok()) << graph.status();
    ASSERT_EQ(graph->edges.size(), 2u);
    EXPECT_EQ(graph->edges[0].information.diagonal(),
              Eigen::Vector3d(1., 2., 3.));
    EXPECT_EQ(graph->edges[1].information, information);
  }
  // The line whose matrix is right in neither order.
  EXPECT_THAT(ErrorOf(vertices + "EDGE2 0 1 1 0 0 1 0 2 3 0 0\n" +
                      "EDGE2 1 0 1 0 0 1 0 0 2 0 0\n"),
              HasSubstr(":4: the information matrix is not positive"));
}

TEST(G2oTest, ReadsSwitchableEdges) {
  test::TemporaryFile file(".g2o");
  test::WriteBytes(file.path(),
                   "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"
                   "VERTEX_SWITCH 9 1\nEDGE_SWITCH_PRIOR 9 1 1\n"
                   "EDGE_SE2_SWITCHABLE 0 1 9 1 2 0.5 10 0 0 20 0 30\n"
                   "EDGE_SE2_MAXMIX 0 1 1e-5 3 4 0.25 10 0 0 20 0 30\n");
  const auto graph = ReadG2o(file.path());
  ASSERT_TRUE(graph.ok()) << graph.status();
  ASSERT_EQ(graph->edges.size(), 2u);
  EXPECT_EQ(graph->edges[0].measurement.y, 2.);
  EXPECT_EQ(graph->edges[1].measurement.theta, 0.25);
  EXPECT_EQ(graph->edges[1].information(2, 2), 30.);
  EXPECT_EQ(graph->skipped.at("VERTEX_SWITCH"), 1);
  EXPECT_EQ(graph->skipped.at("EDGE_SWITCH_PRIOR"), 1);
}

TEST(G2oTest, RoundTripIsExact) {
  Random random(3);
  G2oGraph graph;
  for (int i = 0; i < 100; ++i) {
    graph.vertices[7 * i] = Pose2(random.Normal(0., 1e3), random.Normal(),
                                  random.Uniform(-3.1, 3.1));
  }
  graph.fixed = {0, 21};
  for (int i = 0; i < 99; ++i) {
    G2oEdge edge;
    edge.from = 7 * i;
    edge.to = 7 * (i + 1);
    edge.measurement =
        Pose2(random.Normal(), random.Normal(), random.Uniform(-3.1, 3.1));
    Eigen::Matrix3d root;
    for (int k = 0; k < 9; ++k) root(k) = random.Normal();
    edge.information =
        root * root.transpose() + 1e-3 * Eigen::Matrix3d::Identity();
    edge.information =
        Eigen::Matrix3d(edge.information.selfadjointView<Eigen::Upper>());
    graph.edges.push_back(edge);
  }
  test::TemporaryFile file(".g2o");
  ASSERT_TRUE(WriteG2o(graph, file.path()).ok());
  const auto again = ReadG2o(file.path());
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->fixed, graph.fixed);
  ASSERT_EQ(again->vertices.size(), 100u);
  for (const auto& vertex : graph.vertices) {
    EXPECT_EQ(again->vertices.at(vertex.first).x, vertex.second.x);
    EXPECT_EQ(again->vertices.at(vertex.first).y, vertex.second.y);
    EXPECT_EQ(again->vertices.at(vertex.first).theta, vertex.second.theta);
  }
  ASSERT_EQ(again->edges.size(), 99u);
  for (int i = 0; i < 99; ++i) {
    EXPECT_EQ(again->edges[i].from, graph.edges[i].from);
    EXPECT_EQ(again->edges[i].measurement.theta,
              graph.edges[i].measurement.theta);
    EXPECT_EQ(again->edges[i].information, graph.edges[i].information);
  }
}

TEST(G2oTest, ErrorsNameTheLine) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 2 1 0 0 1 0 0 1 0 1\n"),
              HasSubstr(":3: vertex 2 is not defined"));
  EXPECT_THAT(ErrorOf(vertices + "\nFIX 5\n"),
              HasSubstr(":4: vertex 5 is not defined"));
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n"),
              HasSubstr(":3: edge from vertex 1 to itself"));
  EXPECT_THAT(ErrorOf(vertices + "VERTEX_SE2 1 2 2 2\n"),
              HasSubstr(":3: vertex 1 was defined before"));
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n"),
              HasSubstr(":3: an edge needs three finite numbers up to 1e9"));
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 1 1e308 0 0 1 0 0 1 0 1\n"),
              HasSubstr(":3: an edge needs three finite numbers up to 1e9"));
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 1 1 0 0 1e308 0 0 1 0 1\n"),
              HasSubstr(":3: an edge needs six finite numbers up to 1e100"));
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n"),
              HasSubstr(":3: an edge needs six finite numbers up to 1e100"));
  for (const char* information :
       {"0 0 0 1 0 1", "1 0 0 -1 0 1", "1 2 0 1 0 1", "1 0 0 1 0 0"}) {
    EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 1 1 0 0 " + information),
                HasSubstr(":3: the information matrix is not positive"));
  }
  EXPECT_THAT(ErrorOf(vertices + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1 7\n"),
              HasSubstr(":3: too many words"));
  EXPECT_THAT(ErrorOf("VERTEX_SE2 0 0 inf 0\n"), HasSubstr(":1: a vertex"));
  EXPECT_THAT(ErrorOf("VERTEX_SE2 a 0 0 0\n"), HasSubstr(":1: the id"));
  EXPECT_THAT(ErrorOf("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"),
              HasSubstr(":1: unknown element \"VERTEX_SE3:QUAT\""));
  EXPECT_THAT(ErrorOf(""), HasSubstr("neither VERTEX_SE2 nor EDGE_SE2 found"));
  EXPECT_THAT(ErrorOf(vertices + "FIX\n"), HasSubstr(":3: FIX needs"));
}

TEST(G2oTest, UnwritableAndMissing) {
  EXPECT_FALSE(WriteG2o(G2oGraph(), "/nonexistent/a.g2o").ok());
  EXPECT_EQ(ReadG2o("/nonexistent/a.g2o").status().code(),
            absl::StatusCode::kNotFound);
  if (!test::Exists("/dev/full")) return;
  G2oGraph graph;
  graph.vertices[0] = Pose2();
  EXPECT_EQ(WriteG2o(graph, "/dev/full").code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(G2oTest, PosesByIdFromEverything) {
  const auto from_graph = ReadPosesById(test::OwnData("square.g2o"));
  ASSERT_TRUE(from_graph.ok());
  EXPECT_EQ(from_graph->at(3).y, 1.);

  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(), "# x y theta\n1 2 0.5\n3 4 -0.5\n");
  const auto plain = ReadPosesById(file.path());
  ASSERT_TRUE(plain.ok()) << plain.status();
  ASSERT_EQ(plain->size(), 2u);
  EXPECT_EQ(plain->at(1).x, 3.);

  // Edges only: 4 -> 5 ahead by one metre, then 6 -> 5 given backwards.
  test::WriteBytes(file.path(),
                   "EDGE2 4 5 1 0 1.5707963267948966 50 0 0 50 0 100\n"
                   "EDGE2 6 5 -2 0 0 50 0 0 50 0 100\n"
                   "EDGE2 4 6 9 9 9 50 0 0 50 0 100\n");
  const auto chained = ReadPosesById(file.path());
  ASSERT_TRUE(chained.ok()) << chained.status();
  ASSERT_EQ(chained->size(), 3u);
  EXPECT_EQ(chained->at(4).x, 0.);
  EXPECT_NEAR(chained->at(6).x, 1., 1e-12);
  EXPECT_NEAR(chained->at(6).y, 2., 1e-12);

  test::WriteBytes(file.path(), "EDGE2 4 6 1 0 0 50 0 0 50 0 100\n");
  EXPECT_THAT(std::string(ReadPosesById(file.path()).status().message()),
              HasSubstr("no edge leads from 4 to 6"));
  test::WriteBytes(file.path(), "1 2 3 4\n");
  EXPECT_FALSE(ReadPosesById(file.path()).ok());
  test::WriteBytes(file.path(), "1 2 3\nVERTEX_SE2 0 0 0 0\n");
  EXPECT_FALSE(ReadPosesById(file.path()).ok());
  test::WriteBytes(file.path(), "# nothing\n");
  EXPECT_FALSE(ReadPosesById(file.path()).ok());
}

TEST(G2oTest, SurvivesMutations) {
  const std::string sample = test::ReadBytes(test::OwnData("square.g2o"));
  test::TemporaryFile file(".g2o");
  test::ForEachMutation(sample, [&](const std::string& damaged) {
    test::WriteBytes(file.path(), damaged);
    const auto graph = ReadG2o(file.path());
    ReadPosesById(file.path()).status().IgnoreError();
    if (!graph.ok()) return;
    for (const G2oEdge& edge : graph->edges) {
      EXPECT_TRUE(edge.information.allFinite());
      EXPECT_EQ(graph->vertices.count(edge.from), 1u);
      EXPECT_EQ(graph->vertices.count(edge.to), 1u);
    }
  });
}

TEST(G2oTest, SharedGraphs) {
  const struct {
    const char* name;
    size_t vertices, edges;
  } kGraphs[] = {{"manhattan_g2o.g2o.xz", 3500, 5598},
                 {"manhattan_olson.g2o.xz", 3500, 5598},
                 {"intel.g2o.xz", 943, 1837},
                 {"city10000.g2o.xz", 10000, 20687},
                 {"ring.g2o.xz", 434, 459},
                 {"bicocca25b_0.800.g2o.xz", 8358, 8405}};
  for (const auto& expected : kGraphs) {
    const std::string file =
        test::SharedData(std::string("g2o/") + expected.name);
    CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
    const auto graph = ReadG2o(file);
    ASSERT_TRUE(graph.ok()) << graph.status();
    EXPECT_EQ(graph->vertices.size(), expected.vertices) << expected.name;
    EXPECT_EQ(graph->edges.size(), expected.edges) << expected.name;
  }
  EXPECT_EQ(
      ReadPosesById(test::SharedData("g2o/city10000_truth.txt.xz"))->size(),
      10000u);
  EXPECT_EQ(ReadPosesById(test::SharedData("g2o/manhattan_truth_nodes.dat.xz"))
                ->size(),
            3500u);
  EXPECT_EQ(ReadPosesById(test::SharedData("g2o/ring_truth.g2o.xz"))->size(),
            434u);
  EXPECT_EQ(
      ReadPosesById(test::SharedData("g2o/bicocca25b_truth.g2o.xz"))->size(),
      6580u);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
