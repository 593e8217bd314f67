// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/graph_families.h"

#include "cartographer_ext/experiments/sweep_graphs.h"
#include "gmock/gmock.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using ::testing::HasSubstr;

TEST(GraphFamiliesTest, GraphsAreValidAndRepeatable) {
  for (const std::string& family : FamilyNames()) {
    for (const uint64_t seed : {1, 2, 3}) {
      const auto first = GenerateFamilyGraph(family, seed);
      const auto again = GenerateFamilyGraph(family, seed);
      ASSERT_TRUE(first.ok() && again.ok());
      EXPECT_TRUE(optimization::ValidatePoseGraph(first->graph).ok())
          << family << " " << seed;
      EXPECT_EQ(first->truth.size(), first->graph.poses.size());
      ASSERT_EQ(first->graph.edges.size(), again->graph.edges.size());
      EXPECT_EQ(first->graph.edges.back().measurement.x,
                again->graph.edges.back().measurement.x);
    }
  }
  EXPECT_THAT(std::string(GenerateFamilyGraph("moon", 1).status().message()),
              HasSubstr("unknown family 'moon'"));
}

TEST(GraphFamiliesTest, NoiseIsAsTheMatricesSay) {
  for (const std::string& family : FamilyNames()) {
    double sum = 0.;
    int count = 0;
    for (const uint64_t seed : {4, 5, 6}) {
      const auto generated = GenerateFamilyGraph(family, seed);
      ASSERT_TRUE(generated.ok());
      for (const auto& edge : optimization::Whiten(generated->graph.edges)) {
        const double confidence = edge.is_loop ? generated->loop_confidence
                                               : generated->odometry_confidence;
        sum += optimization::Chi2(edge, generated->truth[edge.from],
                                  generated->truth[edge.to]) /
               confidence;
        ++count;
      }
    }
    EXPECT_NEAR(sum / count, 3., 0.3) << family;
  }
}

TEST(GraphFamiliesTest, IdsTellLoopsFromOdometry) {
  for (const std::string& family : FamilyNames()) {
    auto generated = GenerateFamilyGraph(family, 7);
    ASSERT_TRUE(generated.ok());
    optimization::PoseGraph graph = generated->graph;
    optimization::MarkLoops(&graph);
    for (size_t i = 0; i != graph.edges.size(); ++i) {
      EXPECT_EQ(graph.edges[i].is_loop, generated->graph.edges[i].is_loop)
          << family << " " << i;
    }
  }
}

// The right map of a graph that holds a pose holds it, too.
TEST(GraphFamiliesTest, OptimumHoldsTheFixedPoses) {
  int graphs = 0;
  for (int seed = 1; seed != 40 && graphs != 2; ++seed) {
    const auto sweep = MakeFamilyGraph("road", seed);
    ASSERT_TRUE(sweep.ok()) << sweep.status();
    if (sweep->graph.fixed.size() < 2) continue;
    ++graphs;
    const int first = sweep->graph.fixed[0], other = sweep->graph.fixed[1];
    const Pose2 held =
        Between(sweep->graph.poses[first], sweep->graph.poses[other]);
    const Pose2 found = Between(sweep->optimum[first], sweep->optimum[other]);
    EXPECT_NEAR(found.x, held.x, 1e-3);
    EXPECT_NEAR(found.y, held.y, 1e-3);
    EXPECT_NEAR(found.theta, held.theta, 1e-3);
  }
  EXPECT_EQ(graphs, 2);
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
