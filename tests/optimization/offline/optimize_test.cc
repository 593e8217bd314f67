// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/optimize.h"

#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::HasSubstr;

TEST(OptimizeTest, EveryMethodRuns) {
  test::GridWorld world = test::MakeGridWorld(120, 6, 2);
  test::AddOutliers(test::Outliers(20), &world.graph);
  for (const std::string& method : MethodNames()) {
    OptimizeOptions options;
    options.method = method;
    const auto result = Optimize(world.graph, options);
    ASSERT_TRUE(result.ok()) << method << ": " << result.status();
    EXPECT_EQ(result->poses.size(), world.graph.poses.size());
    EXPECT_EQ(result->weights.size(), world.graph.edges.size());
    EXPECT_EQ(result->accepted.size(), world.graph.edges.size());
    EXPECT_EQ(result->chi2.size(), world.graph.edges.size());
    for (size_t i = 0; i != world.graph.edges.size(); ++i) {
      EXPECT_GE(result->weights[i], 0.);
      EXPECT_LE(result->weights[i], 1.);
      if (!world.graph.edges[i].is_loop) {
        EXPECT_TRUE(result->accepted[i]);
      }
    }
    EXPECT_NEAR(result->truncated_chi2,
                TruncatedCost(Whiten(world.graph.edges), result->poses), 1e-6);
  }
}

TEST(OptimizeTest, AutoIsRightAndChoosesTheLowestTruncatedCost) {
  for (const OutlierType type :
       {OutlierType::kRandom, OutlierType::kLocal, OutlierType::kRandomGrouped,
        OutlierType::kLocalGrouped}) {
    test::GridWorld world = test::MakeGridWorld(250, 8, 5);
    std::vector<Pose2> optimum = world.graph.poses;
    SolveRobust(Whiten(world.graph.edges), SolverOptions(), &optimum);
    test::AddOutliers(test::Outliers(200, type), &world.graph);
    OptimizeOptions options;
    const auto result = Optimize(world.graph, options);
    ASSERT_TRUE(result.ok());
    EXPECT_LT(AbsoluteTrajectoryError(result->poses, optimum), 0.05)
        << OutlierTypeName(type);
    for (const char* method : {"dcs", "gm", "acs", "r_isam"}) {
      options.method = method;
      const auto single = Optimize(world.graph, options);
      EXPECT_LE(result->member_truncated_chi2, single->truncated_chi2 + 1e-6)
          << method;
    }
  }
}

TEST(OptimizeTest, FixedPosesStay) {
  test::GridWorld world = test::MakeGridWorld(120, 6, 2);
  // True poses in another frame; the rest of the file is dead reckoning.
  const Pose2 frame(30., -12., 2.);
  PoseGraph& graph = world.graph;
  graph.fixed = {40, 90};
  for (const int pose : graph.fixed) {
    graph.poses[pose] = frame * world.truth[pose];
  }
  for (const char* method : {"auto", "r_isam"}) {
    OptimizeOptions options;
    options.method = method;
    const auto result = Optimize(graph, options);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result->weights.size(), graph.edges.size());
    EXPECT_EQ(result->chi2.size(), graph.edges.size());
    for (const int pose : graph.fixed) {
      EXPECT_EQ(result->poses[pose].x, graph.poses[pose].x);
      EXPECT_EQ(result->poses[pose].theta, graph.poses[pose].theta);
    }
    for (size_t i = 0; i != graph.poses.size(); ++i) {
      const Pose2 expected = frame * world.truth[i];
      EXPECT_NEAR(result->poses[i].x, expected.x, 0.3) << method;
      EXPECT_NEAR(result->poses[i].y, expected.y, 0.3) << method;
    }
  }
}

TEST(OptimizeTest, EdgesHoldFixedPoses) {
  PoseGraph graph = test::MakeGridWorld(60, 4, 5).graph;
  EXPECT_TRUE(FixedPoseEdges(graph).empty());
  graph.fixed = {40};
  EXPECT_TRUE(FixedPoseEdges(graph).empty());
  graph.fixed = {40, 10, 40, 50};
  const std::vector<PoseGraphEdge> edges = FixedPoseEdges(graph);
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges[0].from, 10);
  EXPECT_EQ(edges[0].to, 40);
  EXPECT_EQ(edges[1].from, 40);
  EXPECT_EQ(edges[1].to, 50);
  EXPECT_FALSE(edges[0].is_loop);
  EXPECT_LT(AbsoluteTrajectoryError(
                {graph.poses[40] * edges[1].measurement, graph.poses[40]},
                {graph.poses[50], graph.poses[40]}),
            1e-9);
}

TEST(OptimizeTest, MeasuresWithBothNoises) {
  const PoseGraph graph =
      WithNoiseScale(test::MakeGridWorld(200, 5, 3).graph, 0.25, 0.25);
  for (const char* method : {"auto", "huber"}) {
    OptimizeOptions options;
    options.method = method;
    options.measure_with_estimated_noise = true;
    const auto result = Optimize(graph, options);
    ASSERT_TRUE(result.ok());
    EXPECT_GT(result->applied_loop_scale, 2.);
    const PoseGraph scaled = WithNoiseScale(
        graph, result->applied_odometry_scale, result->applied_loop_scale);
    EXPECT_NEAR(result->truncated_chi2,
                TruncatedCost(Whiten(scaled.edges), result->poses,
                              result->applied_gate),
                1e-6);
    EXPECT_NEAR(result->truncated_chi2_as_given,
                TruncatedCost(Whiten(graph.edges), result->poses), 1e-6);
  }
}

TEST(OptimizeTest, StartsFromGivenPoses) {
  const test::GridWorld world = test::MakeGridWorld(120, 6, 2);
  OptimizeOptions options;
  options.method = "none";
  const auto from_graph = Optimize(world.graph, options);
  ASSERT_TRUE(from_graph.ok());
  // The optimum is where the solver already is.
  options.start = from_graph->poses;
  options.max_iterations = 1;
  const auto from_optimum = Optimize(world.graph, options);
  ASSERT_TRUE(from_optimum.ok());
  EXPECT_NEAR(from_optimum->truncated_chi2, from_graph->truncated_chi2,
              1e-6 * from_graph->truncated_chi2);
  options.start.pop_back();
  EXPECT_THAT(std::string(Optimize(world.graph, options).status().message()),
              HasSubstr("119 poses to start from"));
}

// Loops that end just behind the gate of a replay, or in groups that it has
// lost, come back at the end of the data.
TEST(OptimizeTest, ReplayEndsNearTheLowestCost) {
  for (const uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}) {
    test::GridWorld world = test::MakeWeakRing(seed);
    test::AddOutliers(test::Outliers(60, OutlierType::kRandom, seed),
                      &world.graph);
    OptimizeOptions options;
    options.estimate_noise = false;
    options.adaptive_gate = false;
    const auto automatic = Optimize(world.graph, options);
    options.method = "r_isam";
    const auto replayed = Optimize(world.graph, options);
    ASSERT_TRUE(automatic.ok() && replayed.ok());
    EXPECT_LT(replayed->truncated_chi2,
              automatic->truncated_chi2 + 3. * kChi2Gate)
        << seed;
  }
}

// A replay whose map shows that the matrices claim too little noise is repeated
// with what it shows.
TEST(OptimizeTest, ReplayTakesTheNoiseThatItFinds) {
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  std::vector<Pose2> optimum = world.graph.poses;
  SolveRobust(Whiten(world.graph.edges), SolverOptions(), &optimum);
  const PoseGraph graph = WithNoiseScale(world.graph, 0.2, 0.2);
  OptimizeOptions options;
  options.method = "r_isam";
  for (const bool estimate : {true, false}) {
    options.estimate_noise = estimate;
    const auto result = Optimize(graph, options);
    ASSERT_TRUE(result.ok()) << result.status();
    int loops = 0, accepted = 0;
    for (size_t i = 0; i != graph.edges.size(); ++i) {
      loops += graph.edges[i].is_loop;
      accepted += graph.edges[i].is_loop && result->accepted[i];
    }
    EXPECT_EQ(accepted >= 0.98 * loops, estimate) << accepted << "/" << loops;
    if (!estimate) continue;
    EXPECT_NEAR(result->applied_loop_scale, 5., 1.5);
    EXPECT_LT(AbsoluteTrajectoryError(result->poses, optimum), 0.01);
  }
}

// The gate of 99 % is one that all right loops pass then, as with `auto`.
TEST(OptimizeTest, ARepeatedReplayKeepsTheWorstRightLoops) {
  OptimizeOptions options;
  options.method = "r_isam";
  int beyond = 0;
  for (const int seed : {3, 4, 5}) {
    const PoseGraph graph =
        WithNoiseScale(test::MakeGridWorld(300, 5, seed).graph, 0.2, 0.2);
    const auto result = Optimize(graph, options);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_GT(result->applied_loop_scale, 1.);
    beyond += result->applied_gate > kChi2Gate;
    for (size_t i = 0; i != graph.edges.size(); ++i) {
      EXPECT_TRUE(result->accepted[i]) << seed << " " << i;
      if (graph.edges[i].is_loop) {
        EXPECT_LT(result->chi2[i], result->applied_gate);
      }
    }
  }
  EXPECT_GT(beyond, 0);
}

TEST(OptimizeTest, Errors) {
  const test::GridWorld world = test::MakeGridWorld(30, 4, 1);
  OptimizeOptions options;
  options.method = "magic";
  EXPECT_THAT(std::string(Optimize(world.graph, options).status().message()),
              HasSubstr("unknown kernel 'magic'"));
  options.method = "auto";
  PoseGraph broken = world.graph;
  broken.edges[3].information.setZero();
  EXPECT_FALSE(Optimize(broken, options).ok());
  // A replay needs odometry to earlier poses.
  PoseGraph loops_only = world.graph;
  for (PoseGraphEdge& edge : loops_only.edges) edge.is_loop = true;
  options.method = "r_isam";
  EXPECT_FALSE(Optimize(loops_only, options).ok());
  options.method = "auto";  // does without
  EXPECT_TRUE(Optimize(loops_only, options).ok());
}

TEST(OptimizeDataTest, IntelWithAThousandOutliers) {
  const std::string file =
      cartographer_ext::test::SharedData("g2o/intel.g2o.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  PoseGraph graph = test::ReadGraph(file);
  std::vector<Pose2> optimum = graph.poses;
  SolveRobust(Whiten(graph.edges), SolverOptions(), &optimum);
  const size_t clean = graph.edges.size();
  test::AddOutliers(OutlierOptions(), &graph);
  for (const char* method : {"auto", "r_isam", "dcs", "acs"}) {
    OptimizeOptions options;
    options.method = method;
    const auto result = Optimize(graph, options);
    ASSERT_TRUE(result.ok());
    EXPECT_LT(AbsoluteTrajectoryError(result->poses, optimum), 0.01) << method;
    const LoopScore score =
        ScoreLoops(Whiten(graph.edges), clean, result->poses, optimum);
    EXPECT_GE(score.recall, 0.99) << method;
    EXPECT_GE(score.precision, 0.98) << method;
  }
}

// All kernels agree on a map that lacks 110 loops; a replay does not.
TEST(OptimizeDataTest, KernelsThatAgreeOnALargeGraphMayBeWrong) {
  const std::string file =
      cartographer_ext::test::SharedData("g2o/manhattan_olson.g2o.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  PoseGraph graph = test::ReadGraph(file);
  test::AddOutliers(test::Outliers(4000, OutlierType::kRandomGrouped, 3),
                    &graph);
  const auto automatic = Optimize(graph, OptimizeOptions());
  OptimizeOptions options;
  options.method = "r_isam";
  const auto replayed = Optimize(graph, options);
  ASSERT_TRUE(automatic.ok() && replayed.ok());
  EXPECT_LE(automatic->truncated_chi2_as_given,
            replayed->truncated_chi2_as_given * (1. + 1e-6));
}

// All kernels find the right map. Ten wrong loops in force cost a little less as
// long as the matrices claim six times the noise, and much more without.
TEST(OptimizeDataTest, AGroupThatFitsNoiseWhichIsNotThereIsRefused) {
  const std::string file =
      cartographer_ext::test::SharedData("g2o/manhattan_g2o.g2o.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  PoseGraph graph = test::ReadGraph(file);
  std::vector<Pose2> optimum = graph.poses;
  SolveRobust(Whiten(graph.edges), SolverOptions(), &optimum);
  test::AddOutliers(test::Outliers(1000, OutlierType::kRandomGrouped, 173),
                    &graph);
  const auto automatic = Optimize(graph, OptimizeOptions());
  ASSERT_TRUE(automatic.ok());
  EXPECT_LT(automatic->applied_loop_scale, 0.5);
  EXPECT_LT(AbsoluteTrajectoryError(automatic->poses, optimum), 0.05);
}

// They reject nearly all loops of a right map; softer ones keep all.
TEST(OptimizeDataTest, KernelsThatAgreeOnNothingEndTheSearchOfAGoodGraph) {
  const std::string file =
      cartographer_ext::test::SharedData("g2o/bicocca25b_0.800.g2o.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  const PoseGraph graph = test::ReadGraph(file);
  OptimizeOptions options;
  const auto automatic = Optimize(graph, options);
  ASSERT_TRUE(automatic.ok());
  int loops = 0;
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    EXPECT_TRUE(automatic->accepted[i]);
    loops += graph.edges[i].is_loop;
  }
  EXPECT_EQ(loops, 48);
  // A search from all starts takes four times as many.
  EXPECT_LT(automatic->iterations, 250);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
