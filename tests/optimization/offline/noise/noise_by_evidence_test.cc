// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Seven loops of a weak ring, with the noise that they and odometry claim divided.
PoseGraph MakeFewLoops(const double odometry, const double loops) {
  PoseGraph graph = test::MakeWeakRing(3, 0.003, true).graph;
  std::vector<PoseGraphEdge> kept;
  int count = 0;
  for (const PoseGraphEdge& edge : graph.edges) {
    if (!edge.is_loop || count++ % 8 == 0) kept.push_back(edge);
  }
  graph.edges = kept;
  return WithNoiseScale(graph, 1. / odometry, 1. / loops);
}

TEST(NoiseByEvidenceTest, LoopsThatClaimTooLittleAreBroughtIn) {
  for (const double odometry : {1., 4.}) {
    const PoseGraph graph = MakeFewLoops(odometry, 8.);
    const int loops = CountLoops(graph.edges);
    ASSERT_LT(loops, 10);
    Portfolio portfolio(graph, PortfolioOptions());
    portfolio.Run();
    const NoiseOfMap map = MeasureNoise(&portfolio);
    ASSERT_LT(map.accepted, loops);
    NoiseHypothesis found;
    ASSERT_TRUE(FindLikelierNoise(NoiseMetric(), map, &portfolio, &found));
    EXPECT_EQ(found.accepted, loops);
    EXPECT_GT(found.metric.odometry * found.metric.loops, 1.9);
  }
}

TEST(NoiseByEvidenceTest, WrongLoopsDoNotMakeTheNoiseLarger) {
  PoseGraph graph = MakeFewLoops(1., 1.);
  OutlierOptions outliers;
  outliers.count = 20;
  const auto wrong = GenerateOutliers(graph, outliers);
  ASSERT_TRUE(wrong.ok());
  graph.edges.insert(graph.edges.end(), wrong->begin(), wrong->end());
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  NoiseHypothesis found;
  EXPECT_FALSE(FindLikelierNoise(NoiseMetric(), MeasureNoise(&portfolio),
                                 &portfolio, &found));
}

// With a larger noise wrong loops would fit beside them.
TEST(NoiseByEvidenceTest, LoopsThatAgreeCloselyKeepTheNoiseAsClaimed) {
  PoseGraph graph = MakeFewLoops(0.1, 0.1);
  const int right = CountLoops(graph.edges);
  OutlierOptions outliers;
  outliers.count = 10;
  const auto wrong = GenerateOutliers(graph, outliers);
  ASSERT_TRUE(wrong.ok());
  graph.edges.insert(graph.edges.end(), wrong->begin(), wrong->end());
  Portfolio portfolio(graph, PortfolioOptions());
  portfolio.Run();
  NoiseOfMap map = MeasureNoise(&portfolio);
  ASSERT_GE(map.accepted, right);
  ASSERT_LT(map.accepted, 10);
  EXPECT_TRUE(map.agree_closely);
  NoiseHypothesis found;
  EXPECT_FALSE(FindLargerNoise(NoiseMetric(), map, &portfolio, &found));
  EXPECT_FALSE(FindNoiseOfFewLoops(NoiseMetric(), map, &portfolio, &found));
  EXPECT_FALSE(FindLikelierNoise(NoiseMetric(), map, &portfolio, &found));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
