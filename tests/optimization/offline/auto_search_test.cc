// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/auto_search.h"

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

int CountAccepted(const PoseGraph& graph, const AutoResult& result) {
  int count = 0;
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    count += graph.edges[i].is_loop && result.accepted[i];
  }
  return count;
}

TEST(AutoSearchTest, OverconfidentMatricesKeepTheirLoops) {
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  const PoseGraph graph = WithNoiseScale(world.graph, 0.25, 0.25);
  int loops = 0;
  for (const PoseGraphEdge& edge : graph.edges) loops += edge.is_loop;
  const AutoResult result = SearchAutomatically(graph, AutoOptions());
  EXPECT_GE(CountAccepted(graph, result), 0.99 * loops);
  EXPECT_NEAR(result.noise.odometry.factor, 4., 0.6);
  EXPECT_NEAR(result.noise.loops.factor, 4., 0.6);
  EXPECT_GT(result.applied_loop_scale, 3.);
  AutoOptions at_their_word;
  at_their_word.estimate_noise = false;
  EXPECT_LT(CountAccepted(graph, SearchAutomatically(graph, at_their_word)),
            0.9 * loops);
}

TEST(AutoSearchTest, HonestMatricesAreTakenAtTheirWord) {
  for (const uint64_t seed : {1, 2, 3}) {
    test::GridWorld world = test::MakeGridWorld(250, 5, seed);
    test::AddOutliers(test::Outliers(150, seed == 1 ? OutlierType::kLocal
                                                    : OutlierType::kRandom),
                      &world.graph);
    const AutoResult result = SearchAutomatically(world.graph, AutoOptions());
    EXPECT_EQ(result.applied_odometry_scale, 1.);
    EXPECT_EQ(result.applied_loop_scale, 1.);
    EXPECT_LT(result.noise.odometry.low, 1.05);
    EXPECT_GT(result.noise.odometry.high, 0.95);
    EXPECT_LT(AbsoluteTrajectoryError(result.poses, world.truth), 0.3);
  }
}

TEST(AutoSearchTest, LoopsThatClaimTooLittleCountAsTheyAre) {
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  const AutoResult honest = SearchAutomatically(world.graph, AutoOptions());
  const AutoResult result =
      SearchAutomatically(WithNoiseScale(world.graph, 1., 5.), AutoOptions());
  EXPECT_EQ(result.applied_odometry_scale, 1.);
  EXPECT_NEAR(result.applied_loop_scale, 0.2, 0.05);
  EXPECT_NEAR(result.noise.loops.factor, 0.2, 0.03);
  EXPECT_LT(AbsoluteTrajectoryError(result.poses, honest.poses), 0.02);
  // Where both claim too little there is no other map to be had.
  const AutoResult both =
      SearchAutomatically(WithNoiseScale(world.graph, 5., 5.), AutoOptions());
  EXPECT_EQ(both.applied_odometry_scale, 1.);
  EXPECT_EQ(both.applied_loop_scale, 1.);
}

// Most loops agree five times better than they claim, one in twenty as it claims:
// the smaller noise does not cost these.
TEST(AutoSearchTest, ASmallerNoiseKeepsLoopsAsNoisyAsTheyClaim) {
  test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  const size_t right = world.graph.edges.size();
  test::AddOutliers(test::Outliers(100), &world.graph);
  PoseGraph graph = WithNoiseScale(world.graph, 1., 5.);
  std::vector<size_t> noisy;
  int loops = 0;
  for (size_t i = 0; i != right; ++i) {
    if (!graph.edges[i].is_loop || ++loops % 20 != 0) continue;
    noisy.push_back(i);
    graph.edges[i].measurement.y += loops % 40 == 0 ? 0.2 : -0.2;
  }
  ASSERT_GT(noisy.size(), 10u);
  const AutoResult result = SearchAutomatically(graph, AutoOptions());
  EXPECT_NEAR(result.applied_loop_scale, 0.2, 0.05);
  EXPECT_GT(result.gate, 50.);
  for (const size_t i : noisy) EXPECT_TRUE(result.accepted[i]) << i;
  int wrong = 0;
  for (size_t i = right; i != graph.edges.size(); ++i) {
    wrong += result.accepted[i];
  }
  EXPECT_LE(wrong, 1);
  EXPECT_LT(AbsoluteTrajectoryError(result.poses, world.truth), 0.1);
}

// Matrices that claim sixteen times the noise let one or two wrong loops into every
// map that is offered. What loops say of each other shows the noise, and the narrower
// gate costs no right loop.
TEST(AutoSearchTest, LoopsAmongThemselvesShowThatTooMuchNoiseIsClaimed) {
  for (const uint64_t seed : {1, 5, 11}) {
    test::GridWorld world = test::MakeGridWorld(100, 6, seed);
    const size_t right = world.graph.edges.size();
    const int loops = CountLoops(world.graph.edges);
    test::AddOutliers(test::Outliers(100 - loops, OutlierType::kRandom, 5),
                      &world.graph);
    const AutoResult result = SearchAutomatically(
        WithNoiseScale(world.graph, 16., 16.), AutoOptions());
    EXPECT_NEAR(result.applied_odometry_scale, 1. / 16., 0.02);
    EXPECT_NEAR(result.applied_loop_scale, 1. / 16., 0.02);
    for (size_t i = 0; i != result.accepted.size(); ++i) {
      EXPECT_EQ(result.accepted[i], i < right) << i;
    }
    EXPECT_LT(AbsoluteTrajectoryError(result.poses, world.truth), 0.03);
  }
}

// The second search knows what the first has found.
TEST(AutoSearchTest, AnotherRatioCostsLessThanAnotherSearch) {
  test::GridWorld world = test::MakeGridWorld(250, 5, 1);
  test::AddOutliers(test::Outliers(150), &world.graph);
  const PoseGraph graph = WithNoiseScale(world.graph, 1., 5.);
  AutoOptions options;
  const AutoResult result = SearchAutomatically(graph, options);
  EXPECT_NEAR(result.applied_loop_scale, 0.2, 0.05);
  EXPECT_LT(AbsoluteTrajectoryError(result.poses, world.truth), 0.3);
  const PoseGraph scaled = WithNoiseScale(graph, 1., result.applied_loop_scale);
  Portfolio whole(scaled, options.portfolio);
  whole.Run();
  EXPECT_LE(result.member_cost, whole.best().cost * (1. + 1e-6));
  EXPECT_LT(result.iterations, 0.7 * whole.iterations());
}

// Too narrow by a factor that leaves most loops inside the gate.
TEST(AutoSearchTest, LoopsJustBehindTheGateAreKept) {
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  int loops = 0;
  for (const PoseGraphEdge& edge : world.graph.edges) loops += edge.is_loop;
  const PoseGraph graph = WithNoiseScale(world.graph, 1., 1. / 1.7);
  const AutoResult result = SearchAutomatically(graph, AutoOptions());
  EXPECT_NEAR(result.applied_loop_scale, 1.7, 0.3);
  EXPECT_GE(CountAccepted(graph, result), 0.98 * loops);
}

// One right loop of a hundred lies beyond a gate that most samples pass, wherever
// its value is likely for the largest of so many. What is kept is solved with.
TEST(AutoSearchTest, TheWorstOfManyRightLoopsIsKept) {
  const test::GridWorld world = test::MakeGridWorld(250, 5, 1);
  for (const bool likely : {true, false}) {
    PoseGraph graph = world.graph;
    const int last = graph.edges.size() - 1;
    ASSERT_TRUE(graph.edges[last].is_loop);
    graph.edges[last].measurement.x += likely ? 0.145 : 0.18;
    const AutoResult result = SearchAutomatically(graph, AutoOptions());
    EXPECT_EQ(result.accepted[last], likely);
    EXPECT_EQ(result.weights[last] > 0.5, likely);
    EXPECT_TRUE(!likely || result.gate > kChi2Gate);
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    RobustSolver solver(edges);
    SolverOptions options;
    options.edge_weights.assign(graph.edges.size(), 1.);
    options.edge_weights[last] = likely ? 1. : 0.;
    std::vector<Pose2> optimum = result.poses;
    solver.Solve(options, &optimum);
    EXPECT_LT(AbsoluteTrajectoryError(result.poses, optimum), 1e-5);
    options.edge_weights[last] = 0.;
    solver.Solve(options, &optimum);
    const double innovation =
        PredictLoops({last}, options.edge_weights, optimum, &solver)[0].chi2;
    EXPECT_EQ(innovation < 24., likely) << innovation;
    EXPECT_GT(innovation, 17.) << innovation;
  }
}

// A right loop beyond the gate that all right loops pass may be within it once
// others are in force, or both of two.
TEST(AutoSearchTest, TheLowestCostOfAWiderGateIsFound) {
  const test::GridWorld world = test::MakeGridWorld(250, 5, 1);
  std::vector<int> loops;
  for (size_t i = 0; i != world.graph.edges.size(); ++i) {
    if (world.graph.edges[i].is_loop) loops.push_back(i);
  }
  struct Errors {
    int from_last;
    double first, second;  // metres
  };
  for (const Errors& errors :
       {Errors{25, 0.205, 0.185}, Errors{26, 0.155, 0.135},
        Errors{29, 0.14, 0.12}, Errors{33, 0.135, 0.115}}) {
    PoseGraph graph = world.graph;
    const size_t first = loops.size() - errors.from_last;
    graph.edges[loops[first]].measurement.x += errors.first;
    graph.edges[loops[first - 1]].measurement.x += errors.second;
    const AutoResult result = SearchAutomatically(graph, AutoOptions());
    EXPECT_GT(result.gate, kChi2Gate);
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    std::vector<Pose2> with_all = result.poses;
    SolveRobust(edges, SolverOptions(), &with_all);
    EXPECT_LE(TruncatedCost(edges, result.poses, result.gate),
              TruncatedCost(edges, with_all, result.gate) * (1. + 1e-6))
        << errors.from_last;
    EXPECT_EQ(result.weights, DecideLoops(edges, result.poses, result.gate));
  }
}

// Where kernels that agree end the search, the map of the narrower gate, which
// careful matrices ask for, may cost more than that of a solver left out.
TEST(AutoSearchTest, IsNotAboveSolversThatTookNoPart) {
  test::GridWorld world = test::MakeGridWorld(400, 5, 3);
  test::AddOutliers(test::Outliers(30), &world.graph);
  const PoseGraph graph = WithNoiseScale(world.graph, 5., 5.);
  const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
  std::vector<Pose2> graduated = graph.poses;
  SolveGnc(edges, GncOptions(), &graduated, nullptr);
  const AutoResult result = SearchAutomatically(graph, AutoOptions());
  EXPECT_EQ(result.applied_loop_scale, 1.);
  EXPECT_LE(TruncatedCost(edges, result.poses),
            TruncatedCost(edges, graduated) * (1. + 1e-6));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
