// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/refused_loops.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

WhitenedEdge Edge(const int from, const int to, const bool is_loop) {
  WhitenedEdge edge;
  edge.from = from;
  edge.to = to;
  edge.is_loop = is_loop;
  return edge;
}

TEST(RefusedLoopsTest, LoopsOfAStretchCountOnce) {
  const int s = kStretchOfPath;
  const std::vector<WhitenedEdge> edges = {
      Edge(0, 1, false),        Edge(0, 4 * s, true),
      Edge(4 * s + 1, 2, true), Edge(3, 5 * s - 1, true),
      Edge(5 * s, 3, true),     Edge(5 * s, 5 * s + 1, false),
      Edge(0, 9 * s + 1, true)};
  const std::vector<bool> accepted = {true,  false, true, false,
                                      false, true,  true};
  const Acceptance all = CountAccepted(edges, accepted, 0, edges.size());
  EXPECT_EQ(all.stretches, 3);
  EXPECT_EQ(all.accepted, 2);
  const Acceptance some = CountAccepted(edges, accepted, 3, 6);
  EXPECT_EQ(some.stretches, 2);
  EXPECT_EQ(some.accepted, 0);
}

TEST(RefusedLoopsTest, WithoutExperienceAllNumbersAreEquallyLikely) {
  for (int k = 0; k <= 6; ++k) {
    EXPECT_NEAR(ChanceOfSoFew({0, 0}, {k, 6}), (k + 1.) / 7., 1e-12);
  }
}

TEST(RefusedLoopsTest, IsTheMeanOfBinomialsOverWhatIsKnown) {
  const Acceptance before = {5, 7}, now = {1, 4};
  double sum = 0., norm = 0.;
  constexpr int kSteps = 20000;
  for (int i = 0; i != kSteps; ++i) {
    const double p = (i + 0.5) / kSteps, q = 1. - p;
    const double density = std::pow(p, 5) * std::pow(q, 2);
    norm += density;
    sum += density * (std::pow(q, 4) + 4. * p * std::pow(q, 3));
  }
  EXPECT_NEAR(ChanceOfSoFew(before, now), sum / norm, 1e-6);
}

TEST(RefusedLoopsTest, RefusalsAfterAcceptanceAreNoMatterOfChance) {
  EXPECT_LT(ChanceOfSoFew({20, 20}, {0, 4}), 0.001);
  // Not after few, nor where most were refused before, nor if there is none.
  EXPECT_GT(ChanceOfSoFew({2, 2}, {0, 4}), 0.01);
  EXPECT_GT(ChanceOfSoFew({5, 20}, {0, 4}), 0.1);
  EXPECT_NEAR(ChanceOfSoFew({20, 20}, {0, 0}), 1., 1e-12);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
