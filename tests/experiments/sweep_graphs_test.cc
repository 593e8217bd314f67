// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/sweep_graphs.h"

#include <cstdio>
#include <fstream>

#include "cartographer_ext/optimization/offline/graph_metrics.h"
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

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
