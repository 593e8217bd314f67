// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/portfolio.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

double TruncatedCostOf(const PoseGraph& graph, const std::string& method) {
  OptimizeOptions options;
  options.method = method;
  const auto result = Optimize(graph, options);
  return result.ok() ? result->truncated_chi2_as_given : 1e300;
}

TEST(PortfolioTest, IsNeverAboveAnySolver) {
  for (const uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    test::GridWorld world = seed % 2 == 0 ? test::MakeGridWorld(120, 5, seed)
                                          : test::MakeWeakRing(seed);
    test::AddOutliers(test::Outliers(seed * 5, OutlierType::kRandom, seed),
                      &world.graph);
    Portfolio portfolio(world.graph, PortfolioOptions());
    portfolio.Run();
    for (const char* method :
         {"none", "huber", "gm", "dcs", "acs", "gnc_tls", "r_isam"}) {
      EXPECT_LE(portfolio.best().cost,
                TruncatedCostOf(world.graph, method) * (1. + 1e-6))
          << method << " " << seed;
    }
    EXPECT_NEAR(portfolio.best().cost,
                TruncatedCost(portfolio.edges(), portfolio.best().poses), 1e-9);
  }
}

// The supported loops lead to the map that the whole search finds.
TEST(PortfolioTest, ALargeGraphIsSettledByLoopsThatAgree) {
  for (const uint64_t seed : {1, 2, 3}) {
    test::GridWorld world = test::MakeGridWorld(500, 8, seed);
    test::AddOutliers(test::Outliers(60, OutlierType::kRandom, seed),
                      &world.graph);
    // As careful as the matrices of large public graphs.
    for (PoseGraphEdge& edge : world.graph.edges) edge.information /= 100.;
    PortfolioOptions options;
    Portfolio whole(world.graph, options);
    whole.Run();
    options.large_search = 0.;
    Portfolio settled(world.graph, options);
    settled.Run();
    EXPECT_LT(settled.members().size(), whole.members().size());
    EXPECT_EQ(settled.members().front().name, "supported, dcs");
    EXPECT_NEAR(settled.best().cost, whole.best().cost,
                1e-6 * whole.best().cost);
  }
}

// Wrong loops that agree with each other fill the factor. Odometry contradicts
// those over short stretches; what leads anywhere is left to a replay.
TEST(PortfolioTest, ALargeGraphWithWrongGroupsIsSettledAtOnce) {
  for (const bool local : {false, true}) {
    test::GridWorld world = test::MakeGridWorld(900, 10, 1);
    OutlierOptions outliers = test::Outliers(
        local ? 12000 : 3000,
        local ? OutlierType::kLocalGrouped : OutlierType::kRandomGrouped);
    outliers.group_size = local ? 3 : 10;
    test::AddOutliers(outliers, &world.graph);
    for (PoseGraphEdge& edge : world.graph.edges) edge.information /= 100.;
    PortfolioOptions options;
    options.large_search = 0.;
    Portfolio portfolio(world.graph, options);
    ASSERT_FALSE(portfolio.CanKeepAllLoops());
    portfolio.Run();
    EXPECT_EQ(portfolio.members().front().name,
              local ? "supported, dcs" : "r_isam, short");
    EXPECT_FALSE(portfolio.ran_all_solvers());
    EXPECT_LT(AbsoluteTrajectoryError(portfolio.best().poses, world.truth),
              0.2);
  }
}

bool HasMember(const Portfolio& portfolio, const std::string& name) {
  return std::any_of(
      portfolio.members().begin(), portfolio.members().end(),
      [&](const Portfolio::Member& member) { return member.name == name; });
}

// Where rejected loops agree with each other, the map that the kernels agree on
// is compared with that of the supported loops, and only where wrong groups
// spoil these with a replay.
TEST(PortfolioTest, AReplayIsAskedWhereSupportedLoopsAreNoStart) {
  for (const bool local : {false, true}) {
    test::GridWorld world = test::MakeGridWorld(900, 10, 1);
    test::AddOutliers(test::Outliers(4000, local ? OutlierType::kLocal
                                                 : OutlierType::kRandomGrouped),
                      &world.graph);
    for (PoseGraphEdge& edge : world.graph.edges) edge.information /= 100.;
    Portfolio portfolio(world.graph, PortfolioOptions());
    ASSERT_GT(portfolio.Size(), kMaxGrowthWork);
    portfolio.Run();
    EXPECT_EQ(HasMember(portfolio, "supported, dcs"), local);
    EXPECT_EQ(HasMember(portfolio, "r_isam, short"), !local);
    EXPECT_FALSE(HasMember(portfolio, "r_isam"));
    EXPECT_LT(AbsoluteTrajectoryError(portfolio.best().poses, world.truth),
              0.2);
  }
}

// Seven laps of an eight, 1400 poses, the heading of which is lost within a lap, with
// 1600 loops between laps.
test::GridWorld MakeLapsOfAnEight(const uint64_t seed) {
  constexpr int kLap = 200, kLaps = 7;
  Random random(seed);
  test::GridWorld world;
  const auto position = [](const int k) {
    const double angle = 2. * kPi * k / kLap;
    return Eigen::Vector2d(40. * std::sin(angle), 20. * std::sin(2. * angle));
  };
  const auto add = [&](const int from, const int to, const double sigma_theta) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = to != from + 1;
    edge.measurement = Between(world.truth[from], world.truth[to]) *
                       Pose2(random.Normal(0., 0.05), random.Normal(0., 0.05),
                             random.Normal(0., sigma_theta));
    edge.information =
        Eigen::Vector3d(400., 400., 1. / (sigma_theta * sigma_theta))
            .asDiagonal();
    world.graph.edges.push_back(edge);
  };
  for (int k = 0; k != kLap * kLaps; ++k) {
    const Eigen::Vector2d here = position(k), step = position(k + 1) - here;
    world.truth.push_back(
        Pose2(here.x(), here.y(), std::atan2(step.y(), step.x())));
    world.graph.ids.push_back(k);
    if (k > 0) add(k - 1, k, 0.04);
  }
  for (int loop = 0; loop != 1600; ++loop) {
    const int place = random.UniformInt(0, kLap - 1);
    const int early = random.UniformInt(0, kLaps - 2);
    const int late = random.UniformInt(early + 1, kLaps - 1);
    add(place + kLap * early, place + kLap * late, 0.01);
  }
  world.graph.poses.assign(world.truth.size(), Pose2());
  world.graph.poses = DeadReckoning(world.graph);
  return world;
}

// Quick kernels reject nearly all loops, from the given poses and from a replay. That
// they agree on that settles nothing (4: softer kernels have found a better map by
// then), and where no loop is certain (5), groups are grown.
TEST(PortfolioTest, IsNotSettledByKernelsThatRejectNearlyAllLoops) {
  for (const uint64_t seed : {4, 5}) {
    test::GridWorld world = MakeLapsOfAnEight(seed);
    test::AddOutliers(test::Outliers(1600, OutlierType::kRandomGrouped, 1),
                      &world.graph);
    Portfolio portfolio(world.graph, PortfolioOptions());
    portfolio.Run();
    ASSERT_GT(portfolio.Size(), kMaxGrowthWork);
    const std::vector<double> decisions =
        DecideLoops(portfolio.edges(), portfolio.best().poses, kChi2Gate);
    EXPECT_GT(CountLoopsInForce(portfolio.edges(), decisions), 0.97 * 1600)
        << seed;
    std::vector<Pose2> right = world.truth;
    PolishTruncated(kChi2Gate, kFullPolishRounds, portfolio.solver(), &right,
                    nullptr);
    EXPECT_LT(AbsoluteTrajectoryError(portfolio.best().poses, right), 0.2)
        << seed;
  }
}

// A start that folds such a graph is noticed by starts that do not depend on it,
// and what keeps all loops is not waited for.
TEST(PortfolioTest, UnfoldsALargerGraphWithoutAllSolvers) {
  test::GridWorld world = test::MakeGridWorld(900, 10, 1);
  test::AddOutliers(test::Outliers(4000), &world.graph);
  for (PoseGraphEdge& edge : world.graph.edges) edge.information /= 100.;
  // The second half is turned over.
  for (size_t i = world.graph.poses.size() / 2; i != world.graph.poses.size();
       ++i) {
    world.graph.poses[i] = Pose2(20., 10., 2.) * world.graph.poses[i];
  }
  Portfolio portfolio(world.graph, PortfolioOptions());
  ASSERT_GT(portfolio.Size(), kMaxGrowthWork);
  portfolio.Run();
  EXPECT_LT(AbsoluteTrajectoryError(portfolio.best().poses, world.truth), 0.2);
  EXPECT_FALSE(HasMember(portfolio, "none"));
  EXPECT_FALSE(HasMember(portfolio, "chordal, gnc_tls"));
}

// Where the gate is nearly as wide as the map, many maps fit; that solvers agree
// on one is no reason to stop.
TEST(PortfolioTest, SearchesOnWhereWrongLoopsFitByChance) {
  for (const double share : {1e-2, 1e-3}) {
    test::GridWorld world = test::MakeGridWorld(500, 5, 1);
    test::AddOutliers(test::Outliers(300), &world.graph);
    for (PoseGraphEdge& edge : world.graph.edges) edge.information *= share;
    Portfolio portfolio(world.graph, PortfolioOptions());
    portfolio.Run();
    EXPECT_EQ(portfolio.ran_all_solvers(), share < 1e-2);
  }
}

TEST(PortfolioTest, KeepsAllLoopsOfACleanGraphFromAPoorStart) {
  test::GridWorld world = test::MakeWeakRing(3);
  Portfolio portfolio(world.graph, PortfolioOptions());
  portfolio.Run();
  int loops = 0, in_force = 0;
  for (const WhitenedEdge& edge : portfolio.edges()) {
    loops += edge.is_loop;
    in_force +=
        edge.is_loop && Chi2(edge, portfolio.best().poses[edge.from],
                             portfolio.best().poses[edge.to]) < kChi2Gate;
  }
  EXPECT_GE(in_force, loops - 1);
}

TEST(PortfolioTest, TakesWhatIsAdded) {
  test::GridWorld world = test::MakeGridWorld(100, 5, 1);
  Portfolio portfolio(world.graph, PortfolioOptions());
  portfolio.Add("truth", world.truth);
  ASSERT_EQ(portfolio.members().size(), 1u);
  EXPECT_EQ(portfolio.best().name, "truth");
  portfolio.Run();
  EXPECT_LE(portfolio.best().cost, portfolio.members()[0].cost);
}

// In another metric, from what is known: the map of a search from nothing, for
// less.
TEST(PortfolioTest, ContinuesInAnotherMetric) {
  for (const uint64_t seed : {1, 2, 3}) {
    test::GridWorld world = seed == 1 ? test::MakeGridWorld(250, 5, seed)
                                      : test::MakeWeakRing(seed);
    test::AddOutliers(test::Outliers(60, OutlierType::kRandom, seed),
                      &world.graph);
    Portfolio first(world.graph, PortfolioOptions());
    first.Run();
    const PoseGraph scaled = WithNoiseScale(world.graph, 0.5, 1.);
    Portfolio whole(scaled, PortfolioOptions());
    whole.Run();
    Portfolio continued(scaled, PortfolioOptions());
    continued.Continue(first.members());
    EXPECT_LE(continued.best().cost, whole.best().cost * (1. + 1e-6)) << seed;
    EXPECT_LT(continued.iterations(), 0.7 * whole.iterations()) << seed;
  }
}

// A robot that walks straight on for thousands of poses, and loops to another
// that does the same: what bends both has hardly any curvature.
TEST(PortfolioTest, TakesOverWhatSolversFoundWithOtherNoise) {
  test::GridWorld world = test::MakeGridWorld(120, 5, 2);
  test::AddOutliers(test::Outliers(20), &world.graph);
  Portfolio first(world.graph, PortfolioOptions());
  first.Run();
  EXPECT_TRUE(first.ran_all_solvers());
  const PoseGraph scaled = WithNoiseScale(world.graph, 1., 2.);
  Portfolio second(scaled, PortfolioOptions());
  second.Add("given", scaled.poses);
  second.AddSolversOf(first);
  double dcs = 1e300;
  for (const Portfolio::Member& member : first.members()) {
    if (member.name == "dcs") dcs = TruncatedCost(second.edges(), member.poses);
  }
  EXPECT_LE(second.lowest_of_solvers(), dcs * 1.01);
  EXPECT_LE(second.best().cost, second.lowest_of_solvers());
  // Not with the noise of the second.
  EXPECT_FALSE(second.ran_all_solvers());
}

TEST(PortfolioTest, SolvesFlatValleysToTheEnd) {
  constexpr int kLength = 1200;
  Random random(1);
  PoseGraph graph;
  std::vector<Pose2> truth;
  Pose2 pose;
  for (int i = 0; i != 2 * kLength; ++i) {
    graph.ids.push_back(i);
    truth.push_back(pose);
    pose = pose * Pose2(1., 0., i == kLength - 1 ? kPi : 0.);
  }
  const auto add = [&](const int from, const int to, const double sigma) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = to != from + 1;
    edge.measurement = Between(truth[from], truth[to]) *
                       Pose2(random.Normal(0., sigma), random.Normal(0., sigma),
                             random.Normal(0., sigma));
    edge.information = Eigen::Matrix3d::Identity() / (sigma * sigma);
    graph.edges.push_back(edge);
  };
  for (int i = 1; i != 2 * kLength; ++i) add(i - 1, i, 0.01);
  for (int i = 0; i < kLength; i += 200) add(i, 2 * kLength - 1 - i, 0.1);
  graph.poses.assign(2 * kLength, Pose2());
  graph.poses = DeadReckoning(graph);
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  std::vector<Pose2> poses = portfolio.best().poses;
  SolverOptions options;
  options.edge_weights = DecideLoops(portfolio.edges(), poses, kChi2Gate);
  options.cost_tolerance = 1e-12;
  options.max_iterations = 1000;
  portfolio.solver()->Solve(options, &poses);
  EXPECT_LT(AbsoluteTrajectoryError(portfolio.best().poses, poses), 1e-3);
}

TEST(PortfolioTest, KnowsWhatAllLoopsCost) {
  test::GridWorld world = test::MakeGridWorld(400, 5, 1);
  EXPECT_TRUE(Portfolio(world.graph, PortfolioOptions()).CanKeepAllLoops());
  test::AddOutliers(test::Outliers(4000), &world.graph);
  EXPECT_FALSE(Portfolio(world.graph, PortfolioOptions()).CanKeepAllLoops());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
