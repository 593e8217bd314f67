// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"

#include <algorithm>
#include <vector>

#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// A grid world with all right loops in force and, if asked for, random wrong
// loops.
struct World {
  explicit World(const int wrong) : world(test::MakeGridWorld(300, 5, 3)) {
    right_edges = world.graph.edges.size();
    if (wrong > 0) test::AddOutliers(test::Outliers(wrong), &world.graph);
    edges = Whiten(world.graph.edges);
    support = FindLoopSupport(world.graph, LoopSupportOptions());
    map.decisions.assign(edges.size(), 1.);
    std::fill(map.decisions.begin() + right_edges, map.decisions.end(), 0.);
    map.poses = world.truth;
    SolverOptions options;
    options.edge_weights = map.decisions;
    RobustSolver(edges).Solve(options, &map.poses);
  }

  // The map without every n-th right loop.
  DecidedMap Without(const int n) const {
    DecidedMap result = map;
    int loops = 0;
    for (size_t i = 0; i != right_edges; ++i) {
      if (edges[i].is_loop && ++loops % n == 0) result.decisions[i] = 0.;
    }
    return result;
  }

  test::GridWorld world;
  size_t right_edges = 0;
  std::vector<WhitenedEdge> edges;
  LoopSupport support;
  DecidedMap map;
};

TEST(LoopsByChanceTest, RightLoopsAllOverThePathAreNoChance) {
  const World world(0);
  RobustSolver solver(world.edges);
  EXPECT_TRUE(NarrowedMap(world.map, world.Without(8), world.support, &solver)
                  .RejectsMoreThanByChance());
  EXPECT_TRUE(TakesInMoreThanByChance(world.Without(8), world.map,
                                      world.support, &solver));
  EXPECT_FALSE(
      RejectsFew(world.edges, world.map.decisions, world.Without(8).decisions));
}

// Wrong loops are anywhere within the gate, most of them far out; right ones that are
// as noisy as claimed are not.
TEST(LoopsByChanceTest, LoopsAllOverTheGateAreWrong) {
  World world(0);
  const DecidedMap narrower = world.Without(8);
  for (const bool far_out : {false, true}) {
    int rejected = 0;
    for (size_t i = 0; i != world.edges.size(); ++i) {
      if (narrower.decisions[i] > 0.5) continue;
      WhitenedEdge& edge = world.edges[i];
      const Pose2 relative =
          Between(world.map.poses[edge.from], world.map.poses[edge.to]);
      // Off by so many of the 0.02 m that it claims.
      const double off = far_out ? 2.6 + 0.1 * (++rejected % 7) : 1.;
      edge.measurement << relative.x + 0.02 * off, relative.y, relative.theta;
    }
    RobustSolver solver(world.edges);
    EXPECT_EQ(NarrowedMap(world.map, narrower, world.support, &solver)
                  .RejectsMoreThanByChance(),
              !far_out);
  }
}

// As many as a gate of 99 % rejects.
TEST(LoopsByChanceTest, AFewRightLoopsMayBeBeyondTheGate) {
  const World world(0);
  RobustSolver solver(world.edges);
  EXPECT_FALSE(
      NarrowedMap(world.map, world.Without(100), world.support, &solver)
          .RejectsMoreThanByChance());
  EXPECT_FALSE(TakesInMoreThanByChance(world.Without(100), world.map,
                                       world.support, &solver));
  EXPECT_TRUE(RejectsFew(world.edges, world.map.decisions,
                         world.Without(100).decisions));
}

// Where loops claim a noise of metres, a good share of the wrong ones that are
// rejected has company in force.
TEST(LoopsByChanceTest, WrongLoopsFitAWideGateByChance) {
  const World world(400);
  const std::vector<WhitenedEdge> wide = WithNoiseScale(world.edges, 1., 40.);
  RobustSolver solver(wide), as_measured(world.edges);
  EXPECT_FALSE(NarrowedMap(world.map, world.Without(8), world.support, &solver)
                   .RejectsMoreThanByChance());
  EXPECT_FALSE(TakesInMoreThanByChance(world.Without(8), world.map,
                                       world.support, &solver));
  EXPECT_TRUE(
      NarrowedMap(world.map, world.Without(8), world.support, &as_measured)
          .RejectsMoreThanByChance());
}

TEST(LoopsByChanceTest, WrongLoopsAreRejectedWhereTheyMayFit) {
  const World all_right(0), world(400);
  RobustSolver right(all_right.edges), solver(world.edges);
  const std::vector<WhitenedEdge> wide = WithNoiseScale(world.edges, 1., 40.);
  RobustSolver wide_solver(wide);
  EXPECT_TRUE(
      NarrowedMap(world.map, world.Without(100), world.support, &wide_solver)
          .MayRejectWrongLoops());
  // None is rejected.
  EXPECT_FALSE(NarrowedMap(world.map, world.map, world.support, &wide_solver)
                   .MayRejectWrongLoops());
  // None fits by chance.
  EXPECT_FALSE(NarrowedMap(all_right.map, all_right.Without(100),
                           all_right.support, &right)
                   .MayRejectWrongLoops());
}

// Right loops that a smaller noise rejects are a tail where wrong ones with the
// claimed noise would be elsewhere, and not where these fit as well.
TEST(LoopsByChanceTest, LoopsAsNoisyAsTheyClaimAreRight) {
  const World world(400);
  const DecidedMap map = world.Without(20);
  std::vector<int> rejected;
  for (size_t i = 0; i != world.right_edges; ++i) {
    if (map.decisions[i] < 0.5) rejected.push_back(i);
  }
  ASSERT_GT(rejected.size(), 10u);
  EXPECT_EQ(FindHeavyTail(map, 2., world.support, world.edges), rejected);
  EXPECT_TRUE(FindHeavyTail(map, 40., world.support, world.edges).empty());
  EXPECT_TRUE(FindHeavyTail(world.map, 2., world.support, world.edges).empty());
}

TEST(LoopsByChanceTest, PoissonLimits) {
  EXPECT_EQ(MoreThanExpected(0.), 1.);
  EXPECT_EQ(MoreThanExpected(0.13), 3.);
  EXPECT_EQ(MoreThanExpected(1.), 6.);
  EXPECT_NEAR(MoreThanExpected(100.), 132., 1.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
