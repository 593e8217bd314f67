// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/outliers/outlier_generator.h"

#include <cmath>

#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

std::vector<PoseGraphEdge> Generate(const OutlierType type, const int count,
                                    const uint64_t seed) {
  OutlierOptions options;
  options.type = type;
  options.count = count;
  options.seed = seed;
  return *GenerateOutliers(test::MakeGridWorld(300, 8, 1).graph, options);
}

TEST(OutlierGeneratorTest, CountsAndSpans) {
  for (const OutlierType type :
       {OutlierType::kRandom, OutlierType::kLocal, OutlierType::kRandomGrouped,
        OutlierType::kLocalGrouped}) {
    const bool local =
        type == OutlierType::kLocal || type == OutlierType::kLocalGrouped;
    const std::vector<PoseGraphEdge> edges = Generate(type, 505, 3);
    ASSERT_EQ(edges.size(), 505u);
    int longest = 0;
    for (const PoseGraphEdge& edge : edges) {
      EXPECT_TRUE(edge.is_loop);
      EXPECT_GE(edge.from, 0);
      EXPECT_LT(edge.to, 300);
      EXPECT_GE(edge.to - edge.from, 2);
      if (local) {
        EXPECT_LE(edge.to - edge.from, 20);
      }
      longest = std::max(longest, edge.to - edge.from);
      // That of the graph's first loop.
      EXPECT_DOUBLE_EQ(edge.information(0, 0), 2500.);
    }
    if (!local) {
      EXPECT_GT(longest, 200);
    }
  }
}

TEST(OutlierGeneratorTest, GroupsShareTheMeasurementOnConsecutivePoses) {
  const std::vector<PoseGraphEdge> edges =
      Generate(OutlierType::kRandomGrouped, 100, 2);
  for (size_t i = 0; i != edges.size(); ++i) {
    const PoseGraphEdge& head = edges[i - i % 10];
    EXPECT_EQ(edges[i].from, head.from + static_cast<int>(i % 10));
    EXPECT_EQ(edges[i].to, head.to + static_cast<int>(i % 10));
    EXPECT_DOUBLE_EQ(edges[i].measurement.x, head.measurement.x);
    EXPECT_DOUBLE_EQ(edges[i].measurement.theta, head.measurement.theta);
  }
  EXPECT_NE(edges[0].measurement.x, edges[10].measurement.x);
}

TEST(OutlierGeneratorTest, MeasurementsAreNormal) {
  const std::vector<PoseGraphEdge> edges =
      Generate(OutlierType::kRandom, 20000, 5);
  double sum[3] = {0., 0., 0.}, squares[3] = {0., 0., 0.};
  for (const PoseGraphEdge& edge : edges) {
    const double values[3] = {edge.measurement.x, edge.measurement.y,
                              edge.measurement.theta};
    for (int k = 0; k != 3; ++k) {
      sum[k] += values[k];
      squares[k] += values[k] * values[k];
    }
  }
  const double sigma[3] = {0.3, 0.3, 10. * kPi / 180.};
  const int n = edges.size();
  for (int k = 0; k != 3; ++k) {
    EXPECT_NEAR(sum[k] / n, 0., 4. * sigma[k] / std::sqrt(1. * n));
    EXPECT_NEAR(std::sqrt(squares[k] / n), sigma[k],
                4. * sigma[k] / std::sqrt(2. * n));
  }
}

TEST(OutlierGeneratorTest, SameSeedSameOutliers) {
  const auto a = Generate(OutlierType::kLocal, 50, 11);
  const auto b = Generate(OutlierType::kLocal, 50, 11);
  const auto c = Generate(OutlierType::kLocal, 50, 12);
  bool differs = false;
  for (size_t i = 0; i != a.size(); ++i) {
    EXPECT_EQ(a[i].from, b[i].from);
    EXPECT_EQ(a[i].to, b[i].to);
    EXPECT_EQ(a[i].measurement.y, b[i].measurement.y);
    differs = differs || a[i].from != c[i].from;
  }
  EXPECT_TRUE(differs);
}

TEST(OutlierGeneratorTest, Errors) {
  PoseGraph tiny;
  tiny.ids = {0, 1, 2};
  tiny.poses.resize(3);
  OutlierOptions options;
  EXPECT_FALSE(GenerateOutliers(tiny, options).ok());
  options.count = 0;
  EXPECT_TRUE(GenerateOutliers(tiny, options)->empty());
  options.count = -1;
  EXPECT_FALSE(GenerateOutliers(tiny, options).ok());
  EXPECT_EQ(*OutlierTypeFromName("LG"), OutlierType::kLocalGrouped);
  EXPECT_EQ(OutlierTypeName(OutlierType::kRandomGrouped), "RG");
  EXPECT_FALSE(OutlierTypeFromName("X").ok());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
