// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/readmission.h"

#include "cartographer_ext/optimization/offline/portfolio.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// A replay that has refused every loop of a ring gets nearly all of them back,
// and a search in which it takes part ends no higher.
TEST(ReadmissionTest, BringsBackWhatAReplayHasLost) {
  for (const uint64_t seed : {1, 2, 3}) {
    const test::GridWorld world = test::MakeWeakRing(seed);
    std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
    RobustSolver solver(edges);
    ReplayResult replay;
    replay.poses = world.graph.poses;
    replay.accepted.assign(edges.size(), false);
    size_t loops = 0;
    for (size_t i = 0; i != edges.size(); ++i) {
      loops += edges[i].is_loop;
      replay.accepted[i] = !edges[i].is_loop;
    }
    const double before = TruncatedCost(edges, replay.poses);
    ASSERT_TRUE(ReadmitGroups(world.graph, &edges, &solver, &replay)) << seed;
    const double after = TruncatedCost(edges, replay.poses);
    EXPECT_LT(after, 0.5 * before) << seed;
    size_t accepted = 0;
    for (size_t i = 0; i != edges.size(); ++i) {
      accepted += edges[i].is_loop && replay.accepted[i];
    }
    EXPECT_GE(accepted, loops - 3) << seed;
    Portfolio portfolio(world.graph, PortfolioOptions());
    portfolio.Run();
    EXPECT_LE(portfolio.best().cost, after * (1. + 1e-6)) << seed;
  }
}

// The same of a graph that is too large for growth by groups.
TEST(ReadmissionTest, BringsBackWhatALargeGraphHasLost) {
  test::GridWorld world = test::MakeGridWorld(1600, 12, 1);
  const size_t first_outlier = world.graph.edges.size();
  test::AddOutliers(test::Outliers(1000), &world.graph);
  ReplayResult replay;
  replay.poses = world.graph.poses;
  replay.accepted.assign(world.graph.edges.size(), false);
  size_t loops = 0, right = 0;
  for (size_t i = 0; i != world.graph.edges.size(); ++i) {
    const bool is_loop = world.graph.edges[i].is_loop;
    replay.accepted[i] = !is_loop;
    loops += is_loop;
    right += is_loop && i < first_outlier;
  }
  ASSERT_GT(world.graph.poses.size() * loops, 4e6);
  std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  ASSERT_TRUE(ReadmitGroups(world.graph, &edges, &solver, &replay));
  size_t right_in_force = 0, wrong_in_force = 0;
  for (size_t i = 0; i != world.graph.edges.size(); ++i) {
    if (!world.graph.edges[i].is_loop || !replay.accepted[i]) continue;
    (i < first_outlier ? right_in_force : wrong_in_force) += 1;
  }
  EXPECT_GE(right_in_force, 0.98 * right);
  EXPECT_LE(wrong_in_force, 2);
}

TEST(ReadmissionTest, LeavesAMapAloneThatHasLostNothing) {
  const test::GridWorld world = test::MakeGridWorld(150, 5, 1);
  ReplayResult replay;
  ASSERT_TRUE(Replay(world.graph, SmootherOptions(), &replay).ok());
  const std::vector<Pose2> poses = replay.poses;
  const std::vector<bool> accepted = replay.accepted;
  std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  EXPECT_FALSE(ReadmitGroups(world.graph, &edges, &solver, &replay));
  EXPECT_EQ(replay.accepted, accepted);
  for (size_t i = 0; i != poses.size(); ++i) {
    EXPECT_EQ(replay.poses[i].x, poses[i].x);
    EXPECT_EQ(replay.poses[i].theta, poses[i].theta);
  }
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
