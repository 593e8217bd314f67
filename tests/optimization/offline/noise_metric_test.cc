// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise_metric.h"

#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

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
  EXPECT_FALSE(FindLargerNoise(graph, map, &portfolio, &found));
  ASSERT_TRUE(FindNoiseRatio(NoiseMetric(), map, portfolio, &found));
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
      FindNoiseRatio(applied, MeasureNoise(&portfolio), portfolio, &found));
  EXPECT_NEAR(found.metric.odometry, 1., 0.2);
  EXPECT_NEAR(found.metric.loops, 6., 1.2);
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
  EXPECT_FALSE(FindLargerNoise(world.graph, map, &portfolio, &found));
  EXPECT_FALSE(FindNoiseRatio(NoiseMetric(), map, portfolio, &found));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
