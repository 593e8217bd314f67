// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/graph_families.h"

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

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
