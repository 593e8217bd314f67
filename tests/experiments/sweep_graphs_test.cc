// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/sweep_graphs.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "cartographer_ext/optimization/offline/portfolio.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace experiments {
namespace {

std::string WriteGraph(const optimization::PoseGraph& graph) {
  const std::string filename = testing::TempDir() + "/poor_start.g2o";
  std::ofstream file(filename);
  file.precision(17);
  for (size_t i = 0; i != graph.poses.size(); ++i) {
    const Pose2& pose = graph.poses[i];
    file << "VERTEX_SE2 " << i << " " << pose.x << " " << pose.y << " "
         << pose.theta << "\n";
  }
  for (const optimization::PoseGraphEdge& edge : graph.edges) {
    const Eigen::Matrix3d& info = edge.information;
    file << "EDGE_SE2 " << edge.from << " " << edge.to << " "
         << edge.measurement.x << " " << edge.measurement.y << " "
         << edge.measurement.theta << " " << info(0, 0) << " " << info(0, 1)
         << " " << info(0, 2) << " " << info(1, 1) << " " << info(1, 2) << " "
         << info(2, 2) << "\n";
  }
  return filename;
}

// What robust kernels are measured against is no local minimum, however poor
// the poses of the file are.
TEST(SweepGraphsTest, OptimumDoesNotDependOnTheStart) {
  int stuck = 0;
  for (const uint64_t seed : {1, 2, 3}) {
    optimization::test::GridWorld world =
        optimization::test::MakeGridWorld(200, 5, seed);
    Random random(seed);
    for (Pose2& pose : world.graph.poses) {
      pose = Pose2(random.Normal(0., 5.), random.Normal(0., 5.),
                   random.Normal(0., 2.));
    }
    const std::vector<optimization::WhitenedEdge> edges =
        optimization::Whiten(world.graph.edges);
    std::vector<Pose2> plain = world.graph.poses;
    optimization::SolveRobust(edges, optimization::SolverOptions(), &plain);
    stuck += optimization::AbsoluteTrajectoryError(plain, world.truth) > 1.;
    SweepOptions options;
    const std::string filename = WriteGraph(world.graph);
    const auto loaded = LoadSweepGraph(options, filename);
    std::remove(filename.c_str());
    ASSERT_TRUE(loaded.ok()) << loaded.status();
    EXPECT_EQ(loaded->name, "poor_start");
    EXPECT_LT(
        optimization::AbsoluteTrajectoryError(loaded->optimum, world.truth),
        0.3);
  }
  EXPECT_GT(stuck, 0);
}

optimization::PoseGraphEdge EdgeOfTenMetres(const double sigma) {
  optimization::PoseGraphEdge edge;
  edge.from = 0;
  edge.to = 1;
  edge.measurement = Pose2(10., 0., 0.);
  edge.information =
      Eigen::Vector3d(1. / (sigma * sigma), 1. / (sigma * sigma), 1e4)
          .asDiagonal();
  return edge;
}

// A place is off by as many standard deviations as its edges leave it, whatever
// that is in metres.
TEST(SweepGraphsTest, DeviationIsInStandardDeviations) {
  for (const double sigma : {0.01, 10.}) {
    SweepGraph dataset;
    dataset.optimum = {Pose2(), Pose2(10., 0., 0.)};
    dataset.right_edges = optimization::Whiten(
        std::vector<optimization::PoseGraphEdge>{EdgeOfTenMetres(sigma)});
    EXPECT_EQ(DeviationFromOptimum(dataset, dataset.optimum), 0.);
    EXPECT_NEAR(DeviationFromOptimum(
                    dataset, {Pose2(), Pose2(10. + 0.09 * sigma, 0., 0.)}),
                0.09, 1e-9);
    EXPECT_NEAR(
        DeviationFromOptimum(dataset, {Pose2(), Pose2(10., 2. * sigma, 0.)}),
        2., 1e-9);
  }
}

// Edges that agree better than their matrices claim determine more.
TEST(SweepGraphsTest, DeviationCountsInTheNoiseOfTheEdges) {
  SweepGraph dataset;
  const double sigma = 1.;
  optimization::PoseGraphEdge low = EdgeOfTenMetres(sigma);
  optimization::PoseGraphEdge high = low;
  low.measurement.x -= 0.05;
  high.measurement.x += 0.05;
  dataset.optimum = {Pose2(), Pose2(10., 0., 0.)};
  dataset.right_edges =
      optimization::Whiten(std::vector<optimization::PoseGraphEdge>{low, high});
  // chi2 is 0.005, its redundancy three, and the sigma of the mean 1 / sqrt(2).
  EXPECT_NEAR(DeviationFromOptimum(dataset, {Pose2(), Pose2(10.1, 0., 0.)}),
              0.1 / (std::sqrt(0.5) * std::sqrt(0.005 / 3.)), 1e-6);
  dataset.right_edges.clear();
  EXPECT_FALSE(std::isfinite(DeviationFromOptimum(dataset, dataset.optimum)));
}

// An underconfident graph with as many random wrong loops as right ones.
absl::StatusOr<optimization::PoseGraph> HalfWrong(const SweepGraph& dataset,
                                                  const int seed) {
  return WithOutliers(SweepOptions(), dataset, "R", dataset.num_loops, seed);
}

// Here kernels agree from the given poses on a map that rejects most loops, softer
// ones leave it for another, and the gate is wide enough for wrong loops to be in
// force in that.
TEST(SweepGraphsTest, AnEmptyMapThatKernelsAgreeOnSettlesNothing) {
  constexpr int kSeed = 13009;
  const auto dataset = MakeFamilyGraph("underconfident", kSeed);
  ASSERT_TRUE(dataset.ok());
  const auto graph = HalfWrong(*dataset, kSeed);
  ASSERT_TRUE(graph.ok());
  optimization::Portfolio portfolio(*graph, optimization::PortfolioOptions());
  portfolio.Run();
  EXPECT_TRUE(portfolio.searched_groups());
}

// Odometry that claims far too much noise is bent by wrong loops for less than it
// costs to reject them. The right map is likelier, each with the noise that it shows.
TEST(SweepGraphsTest, TheLikeliestMapGivesTheNoise) {
  constexpr int kSeed = 3102;
  const auto dataset = MakeFamilyGraph("underconfident", kSeed);
  ASSERT_TRUE(dataset.ok());
  const auto graph = HalfWrong(*dataset, kSeed);
  ASSERT_TRUE(graph.ok());
  const auto result =
      optimization::Optimize(*graph, optimization::OptimizeOptions());
  ASSERT_TRUE(result.ok());
  EXPECT_LT(
      optimization::AbsoluteTrajectoryError(result->poses, dataset->optimum),
      0.1);
  EXPECT_LT(result->applied_odometry_scale, 0.5);
}

TEST(SweepGraphsTest, AMissingDataSetIsNamedWithItsFolder) {
  SweepOptions options;
  options.data_directory = "/nonexistent";
  const auto loaded = LoadSweepGraph(options, "intel");
  EXPECT_EQ(loaded.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(loaded.status().message()),
              testing::AllOf(testing::HasSubstr("intel"),
                             testing::HasSubstr("/nonexistent")));
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
