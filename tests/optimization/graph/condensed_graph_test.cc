// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/condensed_graph.h"

#include "Eigen/LU"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPoses = 40;

Eigen::Matrix3d Diagonal(const double x, const double y, const double theta) {
  return Eigen::Vector3d(x, y, theta).asDiagonal();
}

// A chain on an arc, with a loose pose ("submap") for every ten of its poses:
// pose kPoses + k, tied to poses 10 k to 10 k + 14.
struct World {
  PoseGraph graph;
  std::vector<int> neighbours;
};

World MakeWorld() {
  World world;
  PoseGraph& graph = world.graph;
  Pose2 pose;
  for (int i = 0; i != kPoses; ++i) {
    graph.poses.push_back(pose);
    pose = pose * Pose2(0.4, 0.01, 0.07);
  }
  const auto add = [&](const int from, const int to,
                       const Eigen::Matrix3d& information) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.measurement = Between(graph.poses[from], graph.poses[to]);
    edge.information = information;
    graph.edges.push_back(edge);
  };
  for (int i = 0; i + 1 != kPoses; ++i) {
    world.neighbours.push_back(i);
    add(i, i + 1, Diagonal(4e4, 1e4, 9e4));
  }
  for (int k = 0; 10 * k != kPoses; ++k) {
    graph.poses.push_back(graph.poses[10 * k]);
    for (int i = 10 * k; i != std::min(10 * k + 15, kPoses); ++i) {
      add(kPoses + k, i, Diagonal(0.2, 0.2, 0.5));
    }
  }
  for (size_t i = 0; i != graph.poses.size(); ++i) graph.ids.push_back(i);
  return world;
}

void AddLoop(const int from, const int to, const Pose2& error,
             PoseGraph* const graph) {
  PoseGraphEdge edge;
  edge.from = from;
  edge.to = to;
  edge.is_loop = true;
  edge.measurement = Between(graph->poses[from], graph->poses[to]) * error;
  edge.information = Diagonal(100., 100., 400.);
  graph->edges.push_back(edge);
}

std::vector<Pose2> Optimum(const PoseGraph& graph) {
  SolverOptions options;
  options.cost_tolerance = 1e-12;
  std::vector<Pose2> poses = graph.poses;
  SolveRobust(Whiten(graph.edges), options, &poses);
  return poses;
}

TEST(CondensedGraphTest, KeepsLoopsEndsAndSpacing) {
  World world = MakeWorld();
  AddLoop(kPoses, 37, Pose2(), &world.graph);
  const CondensedGraph condensed = Condense(world.graph, world.neighbours, 15);
  // Ends of the chain, of the loop, one in between for the spacing, one more
  // before the next end; and the four off the chain.
  EXPECT_EQ(condensed.pose_of_vertex,
            (std::vector<int>{0, 15, 30, 37, 39, 40, 41, 42, 43}));
  EXPECT_TRUE(ValidatePoseGraph(condensed.graph).ok())
      << ValidatePoseGraph(condensed.graph);
  EXPECT_EQ(condensed.chain_steps, (std::vector<int>{15, 15, 7, 2}));
  ASSERT_EQ(condensed.loop_of_edge.size(), condensed.graph.edges.size());
  int loops = 0;
  for (size_t i = 0; i != condensed.graph.edges.size(); ++i) {
    const PoseGraphEdge& edge = condensed.graph.edges[i];
    EXPECT_EQ(edge.is_loop, condensed.loop_of_edge[i] >= 0);
    loops += edge.is_loop;
    // What agreed before agrees now.
    EXPECT_LT(Chi2(Whiten(edge), condensed.graph.poses[edge.from],
                   condensed.graph.poses[edge.to]),
              1e-12);
  }
  EXPECT_EQ(loops, 1);
  EXPECT_LT(condensed.graph.edges.size(), 20u);
}

TEST(CondensedGraphTest, StretchHasTheInformationOfItsSteps) {
  // Two steps of one metre with a right angle between: by hand. Errors of the
  // first turn move the end across by one metre a radian.
  PoseGraph graph;
  graph.poses = {Pose2(), Pose2(1., 0., kPi / 2.), Pose2(1., 1., kPi / 2.)};
  graph.ids = {0, 1, 2};
  for (int i = 0; i != 2; ++i) {
    PoseGraphEdge edge;
    edge.from = i;
    edge.to = i + 1;
    edge.measurement = Between(graph.poses[i], graph.poses[i + 1]);
    edge.information = Diagonal(1. / 4., 1., 1. / 9.);
    graph.edges.push_back(edge);
  }
  const CondensedGraph condensed = Condense(graph, {0, 1}, 10);
  ASSERT_EQ(condensed.graph.edges.size(), 1u);
  const PoseGraphEdge& edge = condensed.graph.edges[0];
  EXPECT_NEAR(edge.measurement.x, 1., 1e-12);
  EXPECT_NEAR(edge.measurement.y, 1., 1e-12);
  EXPECT_NEAR(edge.measurement.theta, kPi / 2., 1e-12);
  // In the frame of the first pose the first step has covariance (1, 4, 9), its
  // matrix being given in the turned frame; the second has (1, 4) as well. The
  // angle of the first moves the end by (-1, 0).
  Eigen::Matrix3d covariance;
  covariance << 1. + 9. + 1., 0., -9., 0., 4. + 4., 0., -9., 0., 18.;
  Eigen::Matrix3d rotation;
  rotation << 0., -1., 0., 1., 0., 0., 0., 0., 1.;
  const Eigen::Matrix3d expected =
      rotation.transpose() * covariance.inverse() * rotation;
  EXPECT_LT((edge.information - expected).norm(), 1e-12);
}

TEST(CondensedGraphTest, OptimumIsThatOfTheWholeGraph) {
  World world = MakeWorld();
  AddLoop(kPoses, 37, Pose2(0.3, -0.2, 0.05), &world.graph);
  AddLoop(kPoses + 1, 32, Pose2(-0.1, 0.1, -0.02), &world.graph);
  AddLoop(kPoses + 3, 4, Pose2(0.2, 0.2, 0.03), &world.graph);
  const CondensedGraph condensed = Condense(world.graph, world.neighbours, 10);
  EXPECT_LT(2 * condensed.graph.poses.size(), world.graph.poses.size());
  const std::vector<Pose2> whole = Optimum(world.graph);
  const std::vector<Pose2> small = Optimum(condensed.graph);
  for (size_t i = 0; i != small.size(); ++i) {
    const Pose2& expected = whole[condensed.pose_of_vertex[i]];
    EXPECT_NEAR(small[i].x, expected.x, 0.01);
    EXPECT_NEAR(small[i].y, expected.y, 0.01);
    EXPECT_NEAR(small[i].theta, expected.theta, 0.005);
  }
  // So are the decisions: chi2 of the loops.
  for (size_t i = 0; i != condensed.graph.edges.size(); ++i) {
    const int loop = condensed.loop_of_edge[i];
    if (loop < 0) continue;
    const PoseGraphEdge& edge = world.graph.edges[loop];
    const double expected =
        Chi2(Whiten(edge), whole[edge.from], whole[edge.to]);
    const PoseGraphEdge& other = condensed.graph.edges[i];
    EXPECT_NEAR(Chi2(Whiten(other), small[other.from], small[other.to]),
                expected, 0.03 * expected);
  }
}

TEST(CondensedGraphTest, WithoutAChainNothingChanges) {
  World world = MakeWorld();
  AddLoop(kPoses, 37, Pose2(), &world.graph);
  const CondensedGraph condensed = Condense(world.graph, {}, 10);
  EXPECT_EQ(condensed.graph.poses.size(), world.graph.poses.size());
  EXPECT_EQ(condensed.graph.edges.size(), world.graph.edges.size());
  EXPECT_TRUE(condensed.chain.empty());
}

TEST(CondensedGraphTest, ParallelEdgesBecomeTheirMean) {
  PoseGraph graph;
  graph.poses = {Pose2(), Pose2(1., 0., 0.)};
  graph.ids = {0, 1};
  for (const double x : {1., 1.4}) {
    PoseGraphEdge edge;
    edge.to = 1;
    edge.measurement = Pose2(x, 0., 0.);
    edge.information = (x == 1. ? 3. : 1.) * Eigen::Matrix3d::Identity();
    graph.edges.push_back(edge);
  }
  const CondensedGraph condensed = Condense(graph, {}, 10);
  ASSERT_EQ(condensed.graph.edges.size(), 1u);
  EXPECT_NEAR(condensed.graph.edges[0].measurement.x, 1.1, 1e-12);
  EXPECT_NEAR(condensed.graph.edges[0].information(0, 0), 4., 1e-12);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
