// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/map_sharpness.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// Two visits of a straight wall along x; each sees it as two lines `thickness`
// apart, and the second lies `offset` beside the first.
void MakeWall(const double thickness, const double offset, MapGraph* graph,
              MapContents* contents) {
  for (const int node : {0, 100}) {
    graph->nodes[{0, node}].global_pose =
        Pose2(0., node == 0 ? 0. : offset, 0.);
    auto& scan = contents->scans[{0, node}];
    for (int i = 0; i < 1000; ++i) {
      scan.emplace_back(0.01 * i, i % 2 == 0 ? 0. : thickness);
    }
  }
}

TEST(MapSharpnessTest, ThicknessOfAWall) {
  MapGraph graph;
  MapContents contents;
  MakeWall(0.04, 0., &graph, &contents);
  const Sharpness sharpness = ComputeSharpness(graph, contents, {});
  EXPECT_GT(sharpness.samples, 1000);
  // Half of the points on each line: the standard deviation is half of 0.04.
  EXPECT_NEAR(sharpness.wall_thickness.median, 0.04, 2e-3);
  EXPECT_NEAR(sharpness.single_visit_thickness.median, 0.04, 2e-3);
  EXPECT_NEAR(sharpness.doubling, 1., 1e-2);
}

TEST(MapSharpnessTest, DoubledWallsAreThickerAndLessSharp) {
  MapGraph right, doubled;
  MapContents contents, contents_doubled;
  MakeWall(0.02, 0., &right, &contents);
  MakeWall(0.02, 0.1, &doubled, &contents_doubled);
  const Sharpness good = ComputeSharpness(right, contents, {});
  const Sharpness bad = ComputeSharpness(doubled, contents_doubled, {});
  EXPECT_GT(bad.mean_entropy, good.mean_entropy + 0.5);
  EXPECT_GT(bad.doubling, 3.);
  EXPECT_NEAR(bad.single_visit_thickness.median,
              good.single_visit_thickness.median, 2e-3);
  // Variance: 0.01^2 of the visit and 0.05^2 of the offset.
  EXPECT_NEAR(bad.revisited_thickness.median, 2. * std::hypot(0.01, 0.05),
              5e-3);
}

TEST(MapSharpnessTest, EntropyOfAKnownSpread) {
  MapGraph graph;
  MapContents contents;
  graph.nodes[{0, 0}].global_pose = Pose2();
  auto& scan = contents.scans[{0, 0}];
  for (int i = 0; i < 400; ++i) {
    scan.emplace_back(i % 2 == 0 ? 0.1 : -0.1, i % 4 < 2 ? 0.1 : -0.1);
  }
  const Sharpness sharpness = ComputeSharpness(graph, contents, {});
  // Covariance 0.01 I, so h = 1/2 ln (2 pi e 0.01)^2.
  EXPECT_NEAR(sharpness.mean_entropy, std::log(2. * kPi * std::exp(1.) * 0.01),
              1e-6);
  EXPECT_EQ(sharpness.single_visit_thickness.count, 0);
  EXPECT_EQ(sharpness.doubling, 1.);
}

TEST(MapSharpnessTest, NothingToSee) {
  const Sharpness sharpness = ComputeSharpness(MapGraph(), MapContents(), {});
  EXPECT_EQ(sharpness.samples, 0);
  EXPECT_EQ(sharpness.mean_entropy, 0.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
