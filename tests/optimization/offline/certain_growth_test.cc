// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/certain_growth.h"

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "gmock/gmock.h"
#include "tests/optimization/loop_counts.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

test::GridWorld GridWithOutliers(const uint64_t seed, const int outliers) {
  test::GridWorld world = test::MakeGridWorld(1500, 14, seed);
  test::AddOutliers(test::Outliers(outliers, OutlierType::kRandom, seed),
                    &world.graph);
  return world;
}

// Number of the first odometry edge from this one on.
int FirstStep(const PoseGraph& graph, int edge) {
  while (graph.edges[edge].is_loop) ++edge;
  return edge;
}

TEST(CertainGrowthTest, SumsAlongTheChainPredictAsTheFactorDoes) {
  test::GridWorld world = GridWithOutliers(1, 100);
  // A step written backwards and a loop written backwards.
  PoseGraphEdge* const step = &world.graph.edges[FirstStep(world.graph, 20)];
  std::swap(step->from, step->to);
  step->measurement = step->measurement.Inverse();
  PoseGraphEdge* const loop = &world.graph.edges.back();
  std::swap(loop->from, loop->to);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  const std::vector<Pose2> poses = DeadReckoning(world.graph);
  const std::vector<Eigen::Matrix3d> covariances =
      PredictAlongChain(world.graph, edges, poses);
  ASSERT_EQ(covariances.size(), edges.size());
  RobustSolver solver(edges);
  std::vector<double> weights(edges.size());
  std::vector<int> loops;
  for (size_t i = 0; i != edges.size(); ++i) {
    weights[i] = edges[i].is_loop ? 0. : 1.;
    if (edges[i].is_loop) loops.push_back(i);
  }
  const std::vector<Innovation> expected =
      PredictLoops(loops, weights, poses, &solver);
  ASSERT_EQ(expected.size(), loops.size());
  for (size_t k = 0; k != loops.size(); ++k) {
    const WhitenedEdge& edge = edges[loops[k]];
    const Eigen::Vector3d residual =
        Residual(edge, poses[edge.from], poses[edge.to]);
    const Eigen::Matrix3d& covariance = covariances[loops[k]];
    EXPECT_NEAR(residual.dot(covariance.inverse() * residual), expected[k].chi2,
                1e-5 * (1. + expected[k].chi2));
    EXPECT_NEAR(std::log(covariance.determinant()), expected[k].log_determinant,
                1e-5);
  }
}

// As many wrong loops as right ones.
void ExpectFindsTheRightLoops(const uint64_t seed,
                              const CertainGrowthOptions& options) {
  const size_t clean = test::MakeGridWorld(1500, 14, seed).graph.edges.size();
  const test::GridWorld world = GridWithOutliers(seed, clean - 1499);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  std::vector<Pose2> poses = DeadReckoning(world.graph);
  std::vector<double> weights;
  const int in_force =
      GrowCertainLoops(world.graph, options, &solver, &poses, &weights);
  const test::LoopCounts counts = test::CountLoops(edges, clean, weights);
  EXPECT_EQ(in_force, counts.right_in_force + counts.wrong_in_force);
  EXPECT_GE(counts.right_in_force, 0.95 * counts.right) << seed;
  EXPECT_LE(counts.wrong_in_force, 0.01 * in_force) << seed;
  EXPECT_LT(AbsoluteTrajectoryError(poses, world.truth), 0.3) << seed;
}

TEST(CertainGrowthTest, FindsTheRightLoopsAmongAsManyWrongOnes) {
  for (const uint64_t seed : {1, 2, 3}) {
    ExpectFindsTheRightLoops(seed, CertainGrowthOptions());
  }
}

TEST(CertainGrowthTest, PredictsOnAsLongAsLoopsBecomeCertain) {
  CertainGrowthOptions options;
  options.prediction_work = 0.;
  options.min_prediction_work = 1e4;  // one or two predictions
  for (const uint64_t seed : {1, 2, 3}) ExpectFindsTheRightLoops(seed, options);
}

TEST(CertainGrowthTest, GoesOnFromAMapWithLoopsInForce) {
  const size_t clean = test::MakeGridWorld(1500, 14, 1).graph.edges.size();
  const test::GridWorld world = GridWithOutliers(1, clean - 1499);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  std::vector<Pose2> poses = world.truth;
  // One right loop in four and ten wrong ones.
  std::vector<double> weights(edges.size(), 0.);
  for (size_t i = 0; i != edges.size(); ++i) {
    weights[i] = !edges[i].is_loop || (i < clean ? i % 4 == 0 : i < clean + 10);
  }
  const test::LoopCounts before = test::CountLoops(edges, clean, weights);
  ASSERT_LT(before.right_in_force, 0.4 * before.right);
  ASSERT_EQ(before.wrong_in_force, 10);
  CertainGrowthOptions options;
  options.max_rounds = 4;  // from odometry that brings hardly any loop in
  const int in_force =
      GrowMoreCertainLoops(world.graph, options, &solver, &poses, &weights);
  const test::LoopCounts counts = test::CountLoops(edges, clean, weights);
  EXPECT_EQ(in_force, counts.right_in_force + counts.wrong_in_force);
  EXPECT_GE(counts.right_in_force, 0.95 * counts.right);
  EXPECT_LE(counts.wrong_in_force, 0.01 * in_force);
  EXPECT_LT(AbsoluteTrajectoryError(poses, world.truth), 0.3);

  poses = DeadReckoning(world.graph);
  GrowCertainLoops(world.graph, options, &solver, &poses, &weights);
  EXPECT_LT(test::CountLoops(edges, clean, weights).right_in_force,
            0.9 * counts.right_in_force);
}

// Headings are lost after ten steps: few loops are certain, and groups alone let more
// wrong ones in, or fewer right ones.
TEST(CertainGrowthTest, GrowsInTurnWithGroupsWhereHeadingsAreLost) {
  for (const uint64_t seed : {1, 2, 3}) {
    const double sigma = 0.1;
    test::GridWorld world = test::MakeGridWorld(800, 10, seed);
    Random random(seed);
    for (PoseGraphEdge& edge : world.graph.edges) {
      if (edge.is_loop) continue;
      edge.measurement =
          edge.measurement * Pose2(0., 0., random.Normal(0., sigma));
      edge.information(2, 2) = 1. / (sigma * sigma + 1e-4);
    }
    const size_t clean = world.graph.edges.size();
    test::AddOutliers(test::Outliers(clean - 799, OutlierType::kRandom, seed),
                      &world.graph);
    const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
    RobustSolver solver(edges);
    const LoopSupport support =
        FindLoopSupport(world.graph, LoopSupportOptions());
    const std::vector<Pose2> chained = DeadReckoning(world.graph);
    std::vector<Pose2> poses = chained;
    std::vector<double> weights;
    GrowCertainLoops(world.graph, CertainGrowthOptions(), &solver, &poses,
                     &weights);
    const int certain = test::CountLoops(edges, clean, weights).right_in_force;
    poses = chained;
    ASSERT_TRUE(GrowCertainLoopsAndGroups(world.graph, support, &solver, &poses,
                                          &weights));
    const test::LoopCounts counts = test::CountLoops(edges, clean, weights);
    EXPECT_GE(counts.right_in_force, 0.9 * counts.right) << certain;
    EXPECT_GT(counts.right_in_force, certain);
    EXPECT_LE(counts.wrong_in_force, 0.02 * counts.right);
  }
}

TEST(CertainGrowthTest, NeedsAChain) {
  test::GridWorld world = GridWithOutliers(1, 0);
  world.graph.edges.erase(world.graph.edges.begin() +
                          FirstStep(world.graph, 20));
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  std::vector<Pose2> poses = world.truth;
  const double before = poses[100].x;
  std::vector<double> weights;
  EXPECT_EQ(GrowCertainLoops(world.graph, CertainGrowthOptions(), &solver,
                             &poses, &weights),
            0);
  EXPECT_EQ(poses[100].x, before);
  EXPECT_FALSE(GrowCertainLoopsAndGroups(
      world.graph, FindLoopSupport(world.graph, LoopSupportOptions()), &solver,
      &poses, &weights));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
