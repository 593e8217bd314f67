// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/likeliest_map.h"

#include <limits>
#include <vector>

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/rival_sets.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// A ring with loops on stretches of it, and in a gap between two of these a group of
// wrong ones, all of which see the second lap `aside` of the first (metres).
class RingWithWrongGroup {
 public:
  explicit RingWithWrongGroup(const double aside)
      : world(test::MakeWeakRing(1, 0.03, true)) {
    for (int i = 8; i != 16; ++i) {
      PoseGraphEdge edge = world.graph.edges.back();
      edge.from = i;
      edge.to = i + 100;
      edge.measurement = Pose2(0., aside, 0.);
      world.graph.edges.push_back(edge);
    }
    edges = Whiten(world.graph.edges);
    right = WithGroup(0.);
    wrong = WithGroup(1.);
  }

  test::GridWorld world;
  std::vector<WhitenedEdge> edges;
  std::vector<Pose2> right, wrong;  // without the group and with it

 private:
  std::vector<Pose2> WithGroup(const double weight) const {
    SolverOptions options;
    options.edge_weights.assign(edges.size(), 1.);
    for (size_t i = edges.size() - 8; i != edges.size(); ++i) {
      options.edge_weights[i] = weight;
    }
    std::vector<Pose2> poses = world.truth;
    SolveRobust(edges, options, &poses);
    return poses;
  }
};

// Eight loops that agree cost less in force than their gates, though odometry bends by
// more than one revisit is worth.
TEST(LikeliestMapTest, AGroupThatOdometryBendsToIsReleased) {
  const RingWithWrongGroup ring(1.5);
  const double cost = TruncatedCost(ring.edges, ring.right);
  Portfolio portfolio(ring.world.graph, PortfolioOptions());
  portfolio.Add("wrong", ring.wrong);
  ASSERT_LT(portfolio.best().cost, cost);
  // Not where that costs more than is allowed.
  EXPECT_EQ(&LikeliestMember(cost - 0.1, &portfolio), &portfolio.best());
  const Portfolio::Member& likeliest =
      LikeliestMember(cost + kChi2Gate, &portfolio);
  EXPECT_NEAR(likeliest.cost, cost, 1e-3);
  EXPECT_LT(AbsoluteTrajectoryError(likeliest.poses, ring.right), 1e-3);
}

TEST(LikeliestMapTest, AGroupThatFitsIsKept) {
  const RingWithWrongGroup ring(0.1);
  Portfolio portfolio(ring.world.graph, PortfolioOptions());
  portfolio.Add("all", ring.wrong);
  const Portfolio::Member& likeliest =
      LikeliestMember(std::numeric_limits<double>::infinity(), &portfolio);
  EXPECT_EQ(&likeliest, &portfolio.best());
}

// Of known maps the one that costs more may be likelier.
TEST(LikeliestMapTest, TakesTheLikelierOfTwo) {
  const RingWithWrongGroup ring(1.5);
  Portfolio portfolio(ring.world.graph, PortfolioOptions());
  portfolio.Add("wrong", ring.wrong);
  portfolio.Add("right", ring.right);
  ASSERT_EQ(portfolio.best().name, "wrong");
  EXPECT_EQ(LikeliestMember(1.1 * portfolio.best().cost, &portfolio).name,
            "right");
}

// What costs more than may be reported is named.
TEST(LikeliestMapTest, ALikelierMapIsARivalWhateverItCosts) {
  const RingWithWrongGroup ring(1.5);
  Portfolio portfolio(ring.world.graph, PortfolioOptions());
  portfolio.Add("wrong", ring.wrong);
  EXPECT_TRUE(FindLikelierMap(ring.wrong, &portfolio).empty());
  portfolio.Add("right", ring.right);
  const std::vector<Pose2> likelier = FindLikelierMap(ring.wrong, &portfolio);
  ASSERT_FALSE(likelier.empty());
  EXPECT_LT(AbsoluteTrajectoryError(likelier, ring.right), 1e-3);
  EXPECT_TRUE(FindLikelierMap(ring.right, &portfolio).empty());
  RivalOptions options;
  options.same_place = 0.;
  const double cost = TruncatedCost(ring.edges, ring.wrong) + 1e3;
  EXPECT_TRUE(
      FindRivalSets(ring.wrong, {{cost, likelier}}, options, portfolio.solver())
          .empty());
  const std::vector<RivalSets> rivals = FindRivalSets(
      ring.wrong, {{cost, likelier, true}}, options, portfolio.solver());
  ASSERT_EQ(rivals.size(), 1u);
  EXPECT_TRUE(rivals[0].is_likelier);
  EXPECT_GE(rivals[0].only_in_force.size(), 5u);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
