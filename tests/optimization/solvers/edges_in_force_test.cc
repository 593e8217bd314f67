// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using testing::ElementsAre;
using testing::Pair;

WhitenedEdge MakeEdge(const int from, const int to, const bool is_loop) {
  WhitenedEdge edge;
  edge.from = from;
  edge.to = to;
  edge.is_loop = is_loop;
  return edge;
}

std::vector<WhitenedEdge> ChainWithLoop(const int poses) {
  std::vector<WhitenedEdge> edges;
  for (int i = 1; i != poses; ++i) edges.push_back(MakeEdge(i - 1, i, false));
  edges.push_back(MakeEdge(1, poses - 1, true));
  return edges;
}

TEST(EdgesInForceTest, CountsLoopsWithMoreThanHalfOfTheWeight) {
  std::vector<WhitenedEdge> edges = ChainWithLoop(3);
  edges.push_back(MakeEdge(0, 2, true));
  EXPECT_EQ(CountLoops(edges), 2);
  EXPECT_EQ(CountLoopsInForce(edges, std::vector<double>{1., 1., 0.6, 0.5}), 1);
  EXPECT_EQ(CountLoopsInForce(edges, std::vector<bool>{true, true, true, true}),
            2);
}

TEST(EdgesInForceTest, LeavesOutTheHeldPoseAndWhatHasNoWeight) {
  const std::vector<WhitenedEdge> edges = ChainWithLoop(4);
  EXPECT_THAT(PairsInForce(edges, {1., 1., 0.5, 1.}),
              ElementsAre(Pair(0, 1), Pair(1, 2), Pair(0, 2)));
  EXPECT_THAT(PairsInForce(edges, {1., 1., 0.5, 0.}),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(EdgesInForceTest, ALoopAroundAChainIsOneMoreBlockInEachColumnBetween) {
  const std::vector<WhitenedEdge> edges = ChainWithLoop(12);
  std::vector<double> weights(edges.size(), 1.);
  const double closed = FactorWork(edges, weights, 12);
  weights.back() = 0.;
  const double open = FactorWork(edges, weights, 12);
  // Eleven columns, ten of them with one block below the diagonal; eight more
  // with the loop.
  EXPECT_EQ(open, 27. * (10. * 2.5 + 1.));
  EXPECT_EQ(closed - open, 27. * 9. * 2.5);
  EXPECT_EQ(FactorWork({}, {}, 1), 0.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
