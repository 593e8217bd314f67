// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"

#include <cmath>

#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// What a search has found, once and for all questions about the noise.
TEST(NoiseMetricTest, MeasuresTheBestMap) {
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  const PoseGraph graph = WithNoiseScale(world.graph, 1., 5.);
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  const NoiseOfMap map = MeasureNoise(&portfolio);
  EXPECT_EQ(map.accepted, map.loops);
  EXPECT_EQ(map.decisions.size(), graph.edges.size());
  // In a map that weighs the loops too little.
  EXPECT_LT(map.scale.loops.high, 0.5);
  NoiseHypothesis found;
  EXPECT_FALSE(FindLargerNoise(NoiseMetric(), map, &portfolio, &found));
  ASSERT_TRUE(FindNoiseRatio(NoiseMetric(), map, &portfolio, &found));
  EXPECT_EQ(found.metric.odometry, 1.);
  EXPECT_NEAR(found.metric.loops, 0.2, 0.05);
}

// A portfolio in a metric of its own asks for that of the graph all the same.
TEST(NoiseMetricTest, TheRatioRefersToTheGivenMatrices) {
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  const PoseGraph graph = WithNoiseScale(world.graph, 1., 1. / 6.);
  const NoiseMetric applied{4., 6.};
  const PoseGraph scaled =
      WithNoiseScale(graph, applied.odometry, applied.loops);
  Portfolio portfolio(scaled, PortfolioOptions());
  portfolio.Run();
  NoiseHypothesis found;
  ASSERT_TRUE(
      FindNoiseRatio(applied, MeasureNoise(&portfolio), &portfolio, &found));
  EXPECT_NEAR(found.metric.odometry, 1., 0.2);
  EXPECT_NEAR(found.metric.loops, 6., 1.2);
}

// Loops that claim ten times their noise let wrong ones in.
TEST(NoiseMetricTest, WrongLoopsWithinTheGateDoNotHideTheRatio) {
  constexpr double kClaimed = 10.;
  const test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  PoseGraph graph = WithNoiseScale(world.graph, 1., kClaimed);
  int loops = 0;
  for (PoseGraphEdge& edge : graph.edges) {
    if (!edge.is_loop || ++loops % 5 != 0) continue;
    const double sigma = 1. / std::sqrt(edge.information(0, 0));
    edge.measurement.x += (loops % 2 == 0 ? 2.8 : -2.8) * sigma;
  }
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  const NoiseOfMap map = MeasureNoise(&portfolio);
  // By chi2 alone they are as noisy as they claim.
  EXPECT_GT(map.scale.loops.high * 1.25, map.scale.odometry.low);
  NoiseHypothesis found;
  ASSERT_TRUE(FindNoiseRatio(NoiseMetric(), map, &portfolio, &found));
  EXPECT_EQ(found.metric.odometry, 1.);
  EXPECT_NEAR(found.metric.loops, 1. / kClaimed, 0.4 / kClaimed);
  EXPECT_NEAR(found.accepted, 0.8 * map.loops, 0.05 * map.loops);
}

// Right loops beyond a gate that one of a hundred does not pass: three of
// thirteen are too many, two are not.
TEST(NoiseMetricTest, FewLoopsBehindTheGateOfFewAreMany) {
  for (const int num_behind : {2, 3}) {
    PoseGraph graph = test::MakeGridWorld(300, 5, 3).graph;
    std::vector<PoseGraphEdge> edges;
    std::vector<int> behind;
    int loops = 0;
    for (const PoseGraphEdge& edge : graph.edges) {
      if (edge.is_loop && (++loops % 30 != 0 || loops > 13 * 30)) continue;
      if (edge.is_loop && loops % 120 == 0 &&
          static_cast<int>(behind.size()) < num_behind) {
        behind.push_back(edges.size());
      }
      edges.push_back(edge);
    }
    graph.edges = std::move(edges);
    SolverOptions others;
    others.edge_weights.assign(graph.edges.size(), 1.);
    for (const int i : behind) others.edge_weights[i] = 0.;
    const std::vector<WhitenedEdge> as_measured = Whiten(graph.edges);
    RobustSolver solver(as_measured);
    std::vector<Pose2> poses = graph.poses;
    solver.Solve(others, &poses);
    for (const int i : behind) {
      PoseGraphEdge& edge = graph.edges[i];
      const Pose2 predicted = Between(poses[edge.from], poses[edge.to]);
      const auto set = [&](const double error) {
        edge.measurement = predicted * Pose2(error, 0., 0.);
      };
      set(1.);
      const std::vector<WhitenedEdge> far_off = Whiten(graph.edges);
      RobustSolver predictor(far_off);
      set(std::sqrt(
          19. /
          PredictLoops({i}, others.edge_weights, poses, &predictor)[0].chi2));
    }
    Portfolio portfolio(graph, PortfolioOptions());
    portfolio.Run();
    const NoiseOfMap map = MeasureNoise(&portfolio);
    EXPECT_EQ(map.loops, 13);
    EXPECT_EQ(map.accepted, 13 - num_behind);
    NoiseHypothesis found;
    EXPECT_EQ(FindLargerNoise(NoiseMetric(), map, &portfolio, &found),
              num_behind == 3);
  }
}

// Most loops agree a hundred times better than they claim, one in ten as it
// claims: these are not wrong, and the noise of most of them is not that of all.
TEST(NoiseMetricTest, LoopsThatAgreeBetterDoNotMakeTheOthersWrong) {
  test::GridWorld world = test::MakeGridWorld(300, 5, 3);
  Random random(1);
  int loops = 0;
  for (PoseGraphEdge& edge : world.graph.edges) {
    const double factor = !edge.is_loop ? 0. : ++loops % 10 == 0 ? 1. : 0.01;
    if (!edge.is_loop) continue;
    edge.measurement = Between(world.truth[edge.from], world.truth[edge.to]) *
                       Pose2(factor * random.Normal(0., 0.02),
                             factor * random.Normal(0., 0.02),
                             factor * random.Normal(0., 0.01));
  }
  Portfolio portfolio(world.graph, PortfolioOptions());
  portfolio.Run();
  const NoiseOfMap map = MeasureNoise(&portfolio);
  EXPECT_GE(map.accepted, 0.98 * map.loops);
  NoiseHypothesis found;
  EXPECT_FALSE(FindSmallerNoise(NoiseMetric(), map, &portfolio, &found));
  // It is the loops lost that speak against it.
  EXPECT_LT(found.accepted, 0.95 * map.loops);
}

// A sixth of the loops is enough to tell that they claim more of their noise than
// odometry, though the intervals of both factors nearly meet; not a twentieth.
TEST(NoiseMetricTest, ARatioIsAppliedWhereItIsSignificant) {
  constexpr double kOdometry = 1.2, kLoops = 4.;
  for (const int share : {6, 20}) {
    for (const int seed : {2, 3}) {
      PoseGraph graph = WithNoiseScale(test::MakeGridWorld(300, 5, seed).graph,
                                       kOdometry, kLoops);
      int loops = 0;
      std::vector<PoseGraphEdge> edges;
      for (const PoseGraphEdge& edge : graph.edges) {
        if (!edge.is_loop || ++loops % share == 0) edges.push_back(edge);
      }
      graph.edges = std::move(edges);
      Portfolio portfolio(graph, PortfolioOptions());
      portfolio.Run();
      const NoiseOfMap map = MeasureNoise(&portfolio);
      EXPECT_EQ(map.accepted, map.loops);
      EXPECT_LT(map.scale.odometry.low, 1.25 * map.scale.loops.high);
      NoiseHypothesis found;
      EXPECT_EQ(FindNoiseRatio(NoiseMetric(), map, &portfolio, &found),
                share == 6);
      if (share != 6) continue;
      EXPECT_EQ(found.metric.odometry, 1.);
      EXPECT_NEAR(found.metric.loops, kOdometry / kLoops, 0.25);
      EXPECT_EQ(found.accepted, map.accepted);
    }
  }
}

// Wheels that slip once, which three loops tell, do not make these wrong where
// all else is less noisy than claimed: no wrong loop fits so well by chance.
TEST(NoiseMetricTest, ASmallerNoiseThatRejectsRightLoopsIsNotNeeded) {
  constexpr double kClaimed = 4., kSlip = 0.6;
  constexpr int kSlippery = 280, kAfter = 3;
  PoseGraph graph = test::MakeGridWorld(300, 5, 3).graph;
  std::vector<PoseGraphEdge> edges;
  std::vector<double> before;
  int after = 0;
  for (PoseGraphEdge edge : graph.edges) {
    const bool tells = edge.is_loop && edge.to >= kSlippery;
    if (tells && (edge.from >= kSlippery || ++after > kAfter)) continue;
    if (!edge.is_loop && edge.to == kSlippery) edge.measurement.x += kSlip;
    before.push_back(tells ? 0. : 1.);
    edges.push_back(edge);
  }
  graph.edges = std::move(edges);
  graph = WithNoiseScale(graph, kClaimed, kClaimed);
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  SolverOptions options;
  options.edge_weights = before;
  std::vector<Pose2> poses = portfolio.best().poses;
  portfolio.solver()->Solve(options, &poses);
  portfolio.Add("slipped", poses);
  const NoiseOfMap map = MeasureNoise(&portfolio);
  EXPECT_EQ(map.accepted, map.loops);
  NoiseHypothesis found;
  EXPECT_FALSE(FindSmallerNoise(NoiseMetric(), map, &portfolio, &found));
  // It costs less there.
  EXPECT_TRUE(found.valid);
  EXPECT_EQ(found.accepted, map.accepted - kAfter);
}

TEST(NoiseMetricTest, AMapOfFewLoopsSaysNothing) {
  test::GridWorld world = test::MakeGridWorld(60, 5, 2);
  int loops = 0;
  std::vector<PoseGraphEdge> edges;
  for (const PoseGraphEdge& edge : world.graph.edges) {
    loops += edge.is_loop;
    if (!edge.is_loop || loops <= 5) edges.push_back(edge);
  }
  world.graph.edges = edges;
  Portfolio portfolio(world.graph, PortfolioOptions());
  portfolio.Run();
  const NoiseOfMap map = MeasureNoise(&portfolio);
  NoiseHypothesis found;
  EXPECT_FALSE(FindLargerNoise(NoiseMetric(), map, &portfolio, &found));
  EXPECT_FALSE(FindNoiseRatio(NoiseMetric(), map, &portfolio, &found));
}

// A robot walks 200 m straight on and back, with right loops between both ways,
// and a group of wrong ones that says it has come round in a circle. `circle`
// receives the poses of that.
PoseGraph MakeWayAndCircle(const double claimed,
                           std::vector<Pose2>* const circle) {
  constexpr int kLength = 200, kRound = 160;
  Random random(1);
  PoseGraph graph;
  for (int i = 0; i != 2 * kLength; ++i) {
    graph.ids.push_back(i);
    const int along = i < kLength ? i : 2 * kLength - 1 - i;
    const double back = i < kLength ? 0. : kPi;
    const double angle = 2. * kPi * along / kRound;
    const double radius = kRound / (2. * kPi);
    graph.poses.push_back(Pose2(along, 0., back));
    circle->push_back(Pose2(radius * std::sin(angle),
                            radius * (1. - std::cos(angle)),
                            NormalizeAngle(angle + back)));
  }
  const auto add = [&](const int from, const int to, const bool is_loop,
                       const Pose2& measurement) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = is_loop;
    edge.measurement =
        measurement * Pose2(random.Normal(0., 0.02), random.Normal(0., 0.02),
                            random.Normal(0., 0.002));
    const Eigen::Vector3d actual(2500., 2500., 250000.);
    edge.information = (actual / Squared(claimed)).asDiagonal();
    graph.edges.push_back(edge);
  };
  const auto add_right = [&](const int from, const int to, const bool is_loop) {
    add(from, to, is_loop, Between(graph.poses[from], graph.poses[to]));
  };
  for (int i = 1; i != 2 * kLength; ++i) add_right(i - 1, i, false);
  for (int i = 0; i < kLength - 10; i += 8) {
    add_right(i, 2 * kLength - 1 - i, true);
  }
  for (int i = 20; i != 26; ++i) add(i, i + kRound, true, Pose2());
  return graph;
}

// Matrices of sixty times the actual noise let the circle cost less than six
// refused loops; the noise that it shows itself makes it cost more.
TEST(NoiseMetricTest, ASmallerNoiseDecidesBetweenMaps) {
  std::vector<Pose2> circle;
  const PoseGraph graph = MakeWayAndCircle(60., &circle);
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Add("straight", graph.poses);
  NoiseHypothesis noise;
  // There is no other map.
  EXPECT_FALSE(FindSmallerNoise(NoiseMetric(), MeasureNoise(&portfolio),
                                &portfolio, &noise));
  portfolio.Add("circle", circle);
  ASSERT_EQ(portfolio.best().name, "circle");
  ASSERT_TRUE(FindSmallerNoise(NoiseMetric(), MeasureNoise(&portfolio),
                               &portfolio, &noise));
  // With few loops the prior holds it back.
  EXPECT_LT(noise.metric.odometry, 0.1);
  EXPECT_LT(AbsoluteTrajectoryError(noise.poses, graph.poses), 0.5);
  // Nor does it where the matrices are right.
  circle.clear();
  const PoseGraph honest = MakeWayAndCircle(1., &circle);
  Portfolio careful(honest, PortfolioOptions());
  careful.Add("straight", honest.poses);
  careful.Add("circle", circle);
  EXPECT_EQ(careful.best().name, "straight");
  EXPECT_FALSE(FindSmallerNoise(NoiseMetric(), MeasureNoise(&careful), &careful,
                                &noise));
}

// A ring driven twice, with neighbouring loops between the laps; its odometry
// errs `factor` times as much as it claims.
PoseGraph RingOfFewLoops(const int num_loops, const double factor,
                         const uint64_t seed) {
  const test::GridWorld world = test::MakeWeakRing(seed, 0.004);
  PoseGraph graph = WithNoiseScale(world.graph, 1. / factor, 1.);
  int loops = 0;
  std::vector<PoseGraphEdge> edges;
  for (const PoseGraphEdge& edge : graph.edges) {
    loops += edge.is_loop;
    if (!edge.is_loop || loops <= num_loops) edges.push_back(edge);
  }
  graph.edges = edges;
  return graph;
}

bool FindNoiseOfRing(const PoseGraph& graph, NoiseHypothesis* const found) {
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  return FindNoiseOfFewLoops(NoiseMetric(), MeasureNoise(&portfolio),
                             &portfolio, found);
}

TEST(NoiseMetricTest, FewLoopsThatConfirmEachOtherTellTheNoiseOfOdometry) {
  int num_found = 0, num_honest = 0;
  for (int seed = 0; seed != 10; ++seed) {
    NoiseHypothesis found;
    if (FindNoiseOfRing(RingOfFewLoops(2, 4., seed), &found)) {
      ++num_found;
      EXPECT_EQ(found.accepted, 2);
      EXPECT_GT(found.metric.odometry, 1.4);
      EXPECT_LT(found.metric.odometry, 3.1);
      EXPECT_EQ(found.metric.loops, 1.);
    }
    num_honest += FindNoiseOfRing(RingOfFewLoops(2, 1., seed), &found);
    // One says nothing, nor do two that contradict each other.
    EXPECT_FALSE(FindNoiseOfRing(RingOfFewLoops(1, 4., seed), &found));
    PoseGraph contradiction = RingOfFewLoops(2, 4., seed);
    contradiction.edges.back().measurement.x += 30.;
    EXPECT_FALSE(FindNoiseOfRing(contradiction, &found));
  }
  // In four of ten rings chi2 of the odometry with three degrees of freedom is
  // too small to be noticed, or larger than a factor of three explains.
  EXPECT_GE(num_found, 4);
  // One loop in a hundred lies beyond the gate where odometry is as it claims.
  EXPECT_LE(num_honest, 1);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
