// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise_scale.h"

#include <algorithm>
#include <cmath>

#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

TEST(NoiseScaleTest, FindsTheFactorsOfBothKinds) {
  const test::GridWorld world = test::MakeGridWorld(500, 5, 9);
  for (const double odometry : {0.2, 1., 3.}) {
    for (const double loops : {0.5, 1., 4.}) {
      // Matrices that claim less noise by these factors.
      const PoseGraph graph =
          WithNoiseScale(world.graph, 1. / odometry, 1. / loops);
      // Solved with the right weights, which are those of the noise found.
      const PoseGraph right = WithNoiseScale(graph, odometry, loops);
      const std::vector<WhitenedEdge> edges = Whiten(right.edges);
      RobustSolver solver(edges);
      std::vector<Pose2> poses = graph.poses;
      solver.Solve(SolverOptions(), &poses);
      const std::vector<double> weights(edges.size(), 1.);
      const NoiseScale scale = EstimateNoiseScale(poses, weights, &solver);
      EXPECT_NEAR(scale.odometry.factor, 1., 0.1);
      EXPECT_NEAR(scale.loops.factor, 1., 0.1);
      EXPECT_LT(scale.loops.low, 1.);
      EXPECT_GT(scale.loops.high, 1.);
      const std::vector<WhitenedEdge> as_given = Whiten(graph.edges);
      for (size_t i = 0; i < edges.size(); i += 50) {
        const double factor = edges[i].is_loop ? loops : odometry;
        EXPECT_NEAR(
            Chi2(as_given[i], poses[edges[i].from], poses[edges[i].to]),
            factor * factor *
                Chi2(edges[i], poses[edges[i].from], poses[edges[i].to]),
            1e-6);
      }
    }
  }
}

TEST(NoiseScaleTest, SaysSoWhereTheDataAreSilent) {
  test::GridWorld world = test::MakeGridWorld(60, 5, 2);
  std::vector<PoseGraphEdge>& list = world.graph.edges;
  list.erase(
      std::remove_if(list.begin(), list.end(),
                     [](const PoseGraphEdge& edge) { return edge.is_loop; }),
      list.end());
  const std::vector<WhitenedEdge> edges = Whiten(list);
  RobustSolver solver(edges);
  const NoiseScale scale = EstimateNoiseScale(
      world.graph.poses, std::vector<double>(edges.size(), 1.), &solver);
  EXPECT_NEAR(scale.odometry.factor, 1., 1e-6);
  EXPECT_LT(scale.odometry.degrees_of_freedom, 1e-6);
  EXPECT_GT(scale.odometry.high, 3.);
  EXPECT_LT(scale.odometry.low, 0.6);
}

// The 99 % quantile of F with 10 and 20 degrees of freedom, three of each the
// prior's, and that of its inverse.
TEST(NoiseScaleTest, TheRatioOfFactorsIsDistributedAsF) {
  ScaleEstimate a, b;
  a.degrees_of_freedom = 7.;
  b.degrees_of_freedom = 17.;
  a.factor = 2. * std::sqrt(3.368);
  b.factor = 2.;
  EXPECT_NEAR(DeviateOfRatio(a, b), 2.326, 0.02);
  EXPECT_NEAR(DeviateOfRatio(b, a), -2.326, 0.02);
  a.factor = 2.;
  EXPECT_LT(std::abs(DeviateOfRatio(a, b)), 0.1);
  // Few data say less, many more.
  a.factor = 4.;
  const double with_seven = DeviateOfRatio(a, b);
  a.degrees_of_freedom = 0.;
  EXPECT_LT(DeviateOfRatio(a, b), with_seven);
  a.degrees_of_freedom = b.degrees_of_freedom = 1000.;
  EXPECT_GT(DeviateOfRatio(a, b), 10.);
}

TEST(NoiseScaleTest, InnovationsAreChi2ForHonestMatricesOnly) {
  const test::GridWorld world = test::MakeGridWorld(500, 5, 9);
  for (const double factor : {1., 0.4}) {
    const std::vector<WhitenedEdge> edges =
        Whiten(WithNoiseScale(world.graph, factor, factor).edges);
    RobustSolver solver(edges);
    std::vector<Pose2> poses = world.graph.poses;
    solver.Solve(SolverOptions(), &poses);
    const std::vector<double> values = LeaveOneOutInnovations(
        poses, std::vector<double>(edges.size(), 1.), 300, &solver);
    EXPECT_GT(values.size(), 100u);
    EXPECT_EQ(IsLikeChi2(values), factor == 1.);
    EXPECT_EQ(IsCutByGate(values, kChi2Gate), factor != 1.);
  }
  EXPECT_FALSE(IsLikeChi2({1., 2., 3.}));
}

TEST(NoiseScaleTest, TellsWhatIsLessThanChi2) {
  EXPECT_TRUE(IsBelowChi2(std::vector<double>(9, 0.25)));
  // As they are in the mean, half of that, and too few of them.
  EXPECT_FALSE(IsBelowChi2(std::vector<double>(9, 3.)));
  EXPECT_FALSE(IsBelowChi2(std::vector<double>(9, 1.5)));
  EXPECT_FALSE(IsBelowChi2({0.25, 0.25}));
  EXPECT_FALSE(IsBelowChi2({}));
}

// Loops across stretches of odometry that gives way to them: whatever noise the
// loops have, little of it is left in their chi2.
TEST(NoiseScaleTest, ChiSquaredOfASparseGraphDoesNotShowTheNoise) {
  constexpr int kLoops = 40, kStretch = 12;
  for (const double factor : {1., 0.3}) {
    Random random(4);
    PoseGraph graph;
    graph.poses = {Pose2()};
    for (int i = 0; i != kLoops * kStretch; ++i) {
      for (const bool is_loop : {false, true}) {
        if (is_loop && i % kStretch != 0) continue;
        const double sigma = is_loop ? 0.03 : 0.05;
        const auto noise = [&] { return random.Normal(0., factor * sigma); };
        PoseGraphEdge edge;
        edge.is_loop = is_loop;
        edge.from = i;
        edge.to = is_loop ? i + kStretch : i + 1;
        edge.measurement = Pose2(is_loop ? kStretch : 1., 0., 0.) *
                           Pose2(noise(), noise(), noise());
        edge.information = Eigen::Matrix3d::Identity() / (sigma * sigma);
        graph.edges.push_back(edge);
        if (!is_loop) {
          graph.poses.push_back(graph.poses.back() * edge.measurement);
        }
      }
    }
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    RobustSolver solver(edges);
    std::vector<Pose2> poses = graph.poses;
    solver.Solve(SolverOptions(), &poses);
    EXPECT_LT(AdaptiveGate(edges, poses), 0.7 * kChi2Gate);
    const std::vector<double> innovations = LeaveOneOutInnovations(
        poses, std::vector<double>(edges.size(), 1.), 300, &solver);
    EXPECT_EQ(ClaimTooMuchNoise(innovations), factor < 0.5);
    const double typical = TypicalNoise(innovations);
    EXPECT_NEAR(typical, factor, 0.25 * factor);
    // A fifth of wrong loops moves the mean far and the median little.
    std::vector<double> contaminated = innovations;
    contaminated.insert(contaminated.end(), innovations.size() / 4, 14.);
    EXPECT_NEAR(TypicalNoise(contaminated), typical, 0.35 * typical);
  }
  EXPECT_FALSE(ClaimTooMuchNoise({0.1, 0.1, 0.1}));
  EXPECT_EQ(TypicalNoise({0.1, 0.1, 0.1}), 1.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
