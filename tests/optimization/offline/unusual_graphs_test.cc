// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// All methods on graphs unlike the data sets: they end, with finite poses and
// weights in [0, 1], and where the answer is clear they find it.
#include <algorithm>
#include <cmath>

#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

struct World {
  PoseGraph graph;
  std::vector<Pose2> truth;
  std::vector<Pose2> optimum;  // without wrong loops
};

// Three rounds of a ring of 40 poses, each recognised in the next round.
World Ring(const double noise, const Eigen::Matrix3d& information,
           const uint64_t seed) {
  Random random(seed);
  World world;
  Pose2 pose;
  for (int i = 0; i != 120; ++i) {
    world.truth.push_back(pose);
    world.graph.ids.push_back(i);
    pose = pose * Pose2(1., 0., kPi / 20.);
  }
  const auto add = [&](const int from, const int to) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = to != from + 1;
    edge.measurement = Between(world.truth[from], world.truth[to]) *
                       Pose2(random.Normal(0., noise), random.Normal(0., noise),
                             random.Normal(0., 0.5 * noise));
    edge.information = information;
    world.graph.edges.push_back(edge);
  };
  for (int i = 0; i + 1 != 120; ++i) add(i, i + 1);
  for (int i = 0; i + 40 < 120; i += 2) add(i, i + 40);
  world.graph.poses = world.truth;
  world.graph.poses = DeadReckoning(world.graph);
  world.optimum = world.graph.poses;
  SolveRobust(Whiten(world.graph.edges), SolverOptions(), &world.optimum);
  return world;
}

Eigen::Matrix3d Diagonal(const double xy, const double theta) {
  return Eigen::Vector3d(xy, xy, theta).asDiagonal();
}

void AddWrongLoops(const int count, const Eigen::Matrix3d& information,
                   PoseGraph* const graph) {
  const size_t first = graph->edges.size();
  test::AddOutliers(test::Outliers(count), graph);
  for (size_t i = first; i != graph->edges.size(); ++i) {
    graph->edges[i].information = information;
  }
}

// The results of all methods but one; every one of them is sane.
std::vector<std::pair<std::string, OptimizeResult>> RunAll(
    const PoseGraph& graph, const std::string& without = "") {
  std::vector<std::pair<std::string, OptimizeResult>> results;
  for (const std::string& method : MethodNames()) {
    if (method == without) continue;
    OptimizeOptions options;
    options.method = method;
    options.max_seconds = 5.;
    const auto result = Optimize(graph, options);
    EXPECT_TRUE(result.ok()) << method << ": " << result.status();
    if (!result.ok()) continue;
    EXPECT_EQ(result->poses.size(), graph.poses.size());
    for (const Pose2& pose : result->poses) {
      EXPECT_TRUE(std::isfinite(pose.x) && std::isfinite(pose.y) &&
                  std::isfinite(pose.theta))
          << method;
    }
    for (const double weight : result->weights) {
      EXPECT_GE(weight, 0.) << method;
      EXPECT_LE(weight, 1.) << method;
    }
    results.push_back({method, *result});
  }
  return results;
}

const char* const kRobust[] = {"auto", "r_isam", "dcs", "gm", "acs"};

bool IsRobust(const std::string& method) {
  for (const char* name : kRobust) {
    if (method == name) return true;
  }
  return false;
}

void ExpectRight(const World& world, const double limit) {
  for (const auto& result : RunAll(world.graph)) {
    if (!IsRobust(result.first)) continue;
    EXPECT_LT(AbsoluteTrajectoryError(result.second.poses, world.optimum),
              limit)
        << result.first;
  }
}

TEST(UnusualGraphsTest, RingWithWrongLoops) {
  const Eigen::Matrix3d information = Diagonal(1e4, 4e4);
  // Some of the wrong loops are nearly right on a ring. A fold is metres.
  World world = Ring(0.01, information, 1);
  AddWrongLoops(40, information, &world.graph);
  ExpectRight(world, 0.3);
}

// The drift of a round is many standard deviations of a loop.
TEST(UnusualGraphsTest, ReplayOfARingKeepsItsLoops) {
  const Eigen::Matrix3d information = Diagonal(1e4, 4e4);
  for (const uint64_t seed : {1, 2, 3, 4, 5}) {
    World world = Ring(0.01, information, seed);
    const size_t num_right = world.graph.edges.size();
    AddWrongLoops(15, information, &world.graph);
    OptimizeOptions options;
    options.method = "r_isam";
    const auto result = Optimize(world.graph, options);
    ASSERT_TRUE(result.ok());
    int lost = 0;
    for (size_t i = 0; i != num_right; ++i) lost += !result->accepted[i];
    EXPECT_LE(lost, 2) << seed;
    EXPECT_LT(AbsoluteTrajectoryError(result->poses, world.optimum), 0.1)
        << seed;
  }
}

// Softest waves far below the stiffness of a step: whatever rounding leaves
// asymmetric must not grow.
TEST(UnusualGraphsTest, RingOfTwoThousandPoses) {
  constexpr int kPoses = 5000, kRound = 2000;
  Random random(7);
  PoseGraph graph;
  const auto add = [&](const int from, const int to, const Pose2& measurement) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = to != from + 1;
    edge.measurement =
        measurement * Pose2(random.Normal(0., 0.002), random.Normal(0., 0.002),
                            random.Normal(0., 0.001));
    edge.information = Diagonal(2500., 1e4);
    graph.edges.push_back(edge);
  };
  for (int i = 0; i != kPoses; ++i) {
    graph.ids.push_back(i);
    graph.poses.push_back(Pose2());
    if (i > 0) add(i - 1, i, Pose2(1., 0., 2. * kPi / kRound));
    if (i >= kRound && i % 7 == 0) add(i - kRound, i, Pose2());
  }
  OptimizeOptions options;
  options.method = "r_isam";
  const auto result = Optimize(graph, options);
  ASSERT_TRUE(result.ok()) << result.status();
  const auto off =
      std::count(result->accepted.begin(), result->accepted.end(), false);
  EXPECT_EQ(off, 0);
}

TEST(UnusualGraphsTest, WithoutNoise) {
  World world = Ring(0., Diagonal(1e4, 4e4), 1);
  ExpectRight(world, 1e-9);
  AddWrongLoops(40, Diagonal(1e4, 4e4), &world.graph);
  ExpectRight(world, 0.01);
}

TEST(UnusualGraphsTest, OdometryAlone) {
  World world = Ring(0., Diagonal(1e4, 4e4), 1);
  world.graph.edges.resize(119);
  for (const auto& result : RunAll(world.graph)) {
    EXPECT_LT(AbsoluteTrajectoryError(result.second.poses, world.truth), 1e-6)
        << result.first;
  }
}

TEST(UnusualGraphsTest, CorrelatedInformation) {
  Eigen::Matrix3d information;
  information << 9e3, 6e3, -400., 6e3, 8e3, 700., -400., 700., 3e4;
  World world = Ring(0.01, information, 2);
  AddWrongLoops(40, information, &world.graph);
  ExpectRight(world, 0.1);
}

TEST(UnusualGraphsTest, InformationOfAnyScale) {
  for (const double scale : {1e-50, 1e-20, 1e20, 1e50}) {
    World world = Ring(0.01, scale * Diagonal(1e4, 4e4), 3);
    AddWrongLoops(10, scale * Diagonal(1e4, 4e4), &world.graph);
    RunAll(world.graph);
  }
  // Beyond the range of a double's cube.
  for (const double scale : {1e-280, 1e-90, 1e90, 1e280}) {
    const World world = Ring(0.01, scale * Diagonal(1e4, 4e4), 3);
    const absl::Status status = ValidatePoseGraph(world.graph);
    EXPECT_NE(status.message().find("out of range"), absl::string_view::npos)
        << status;
    EXPECT_FALSE(Optimize(world.graph, OptimizeOptions()).ok());
  }
}

// R-iSAM may have to give up, and then says so.
TEST(UnusualGraphsTest, InformationOfManyScales) {
  Random random(4);
  World world = Ring(0.01, Diagonal(1., 1.), 4);
  AddWrongLoops(10, Diagonal(1., 1.), &world.graph);
  OptimizeOptions options;
  options.method = "r_isam";
  for (const double exponent : {6., 12., 50.}) {
    for (PoseGraphEdge& edge : world.graph.edges) {
      edge.information = std::pow(10., random.Uniform(-exponent, exponent)) *
                         Eigen::Matrix3d::Identity();
    }
    RunAll(world.graph, "r_isam");
    const auto result = Optimize(world.graph, options);
    if (!result.ok()) {
      EXPECT_NE(result.status().message().find("too uneven"),
                absl::string_view::npos)
          << result.status();
    }
  }
}

TEST(UnusualGraphsTest, FarFromTheOrigin) {
  World world = Ring(0.01, Diagonal(1e4, 4e4), 5);
  AddWrongLoops(40, Diagonal(1e4, 4e4), &world.graph);
  PoseGraph far = world.graph;
  for (Pose2& pose : far.poses) pose = Pose2(5e5, 5.5e6, -3.) * pose;
  for (const char* method : {"auto", "r_isam", "dcs"}) {
    OptimizeOptions options;
    options.method = method;
    const auto near_result = Optimize(world.graph, options);
    const auto far_result = Optimize(far, options);
    ASSERT_TRUE(near_result.ok() && far_result.ok());
    EXPECT_EQ(near_result->accepted, far_result->accepted) << method;
    EXPECT_LT(AbsoluteTrajectoryError(far_result->poses, near_result->poses),
              1e-4)
        << method;
  }
}

TEST(UnusualGraphsTest, SmallestGraphs) {
  PoseGraph graph;
  graph.ids = {5};
  graph.poses = {Pose2(1., 2., 3.)};
  for (const auto& result : RunAll(graph)) {
    EXPECT_EQ(result.second.poses[0].y, 2.) << result.first;
  }
  graph.ids = {5, 6};
  graph.poses.push_back(Pose2());
  PoseGraphEdge edge;
  edge.to = 1;
  edge.measurement = Pose2(0., 1., 0.);
  graph.edges.push_back(edge);
  for (const auto& result : RunAll(graph)) {
    EXPECT_NEAR(result.second.poses[1].x, 1. - std::sin(3.), 1e-6)
        << result.first;
  }
  // Nothing but a loop, which all agree with.
  graph.edges[0].is_loop = true;
  graph.poses[1] = graph.poses[0] * edge.measurement;
  for (const char* method : {"auto", "dcs", "gnc_tls", "sc", "none"}) {
    OptimizeOptions options;
    options.method = method;
    EXPECT_TRUE(Optimize(graph, options).ok()) << method;
  }
}

// Two trajectories which only loops join, one of them wrong; and odometry that
// is missing in one place.
TEST(UnusualGraphsTest, TrajectoriesJoinedByLoops) {
  const Eigen::Matrix3d information = Diagonal(1e4, 4e4);
  World world = Ring(0.01, information, 6);
  PoseGraph& graph = world.graph;
  std::vector<PoseGraphEdge> edges;
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.is_loop || edge.from != 59) edges.push_back(edge);
  }
  graph.edges = edges;
  PoseGraphEdge wrong = edges.back();
  wrong.from = 10;
  wrong.to = 100;
  wrong.measurement = Pose2(0.1, 0.2, 0.3);
  graph.edges.push_back(wrong);
  // R-iSAM needs odometry to an earlier pose, and says so.
  OptimizeOptions options;
  options.method = "r_isam";
  EXPECT_FALSE(Optimize(graph, options).ok());
  for (const auto& result : RunAll(graph, "r_isam")) {
    if (!IsRobust(result.first)) continue;
    EXPECT_LT(AbsoluteTrajectoryError(result.second.poses, world.truth), 0.2)
        << result.first;
    EXPECT_FALSE(result.second.accepted.back()) << result.first;
  }
}

// Two trajectories with wrong loops of their own, and three right loops and a
// wrong one between them: no member alone is right for all of these.
TEST(UnusualGraphsTest, TrajectoriesJoinedByFewLoops) {
  const Eigen::Matrix3d information = Diagonal(1e4, 4e4);
  for (const uint64_t seed : {1, 2, 3}) {
    const World first = Ring(0.01, information, seed);
    const World second = Ring(0.01, information, seed + 10);
    PoseGraph graph = first.graph;
    AddWrongLoops(30, information, &graph);
    const int offset = graph.poses.size();
    for (size_t i = 0; i != second.truth.size(); ++i) {
      graph.ids.push_back(offset + 10000 + i);
      graph.poses.push_back(Pose2(100., 0., 0.) * second.graph.poses[i]);
    }
    for (PoseGraphEdge edge : second.graph.edges) {
      edge.from += offset;
      edge.to += offset;
      if (!edge.is_loop) graph.edges.push_back(edge);
    }
    const auto join = [&](const int from, const int to, const Pose2& z) {
      PoseGraphEdge edge;
      edge.from = from;
      edge.to = offset + to;
      edge.is_loop = true;
      edge.measurement = z;
      edge.information = information;
      graph.edges.push_back(edge);
    };
    for (const int k : {3, 50, 90}) {
      join(k, k,
           Between(first.truth[k], Pose2(100., 0., 0.) * second.truth[k]));
    }
    join(10, 70, Pose2());
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    OptimizeOptions options;
    options.adaptive_gate = false;
    const auto best = Optimize(graph, options);
    ASSERT_TRUE(best.ok());
    EXPECT_FALSE(best->accepted.back());
    for (size_t i = 2; i != 5; ++i) {
      EXPECT_TRUE(best->accepted[graph.edges.size() - i]) << seed;
    }
    for (const auto& result : RunAll(graph, "r_isam")) {
      EXPECT_LE(best->truncated_chi2,
                (1. + 1e-9) * TruncatedCost(edges, result.second.poses,
                                            best->applied_gate))
          << result.first << " " << seed;
    }
  }
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
