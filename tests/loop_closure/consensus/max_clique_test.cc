// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/max_clique.h"

#include <vector>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;

TEST(MaxCliqueTest, EmptyAndSingle) {
  const MaxCliqueResult empty = MaxWeightClique(CompatibilityGraph(0), {}, {});
  EXPECT_TRUE(empty.exact);
  EXPECT_TRUE(empty.vertices.empty());
  const MaxCliqueResult single =
      MaxWeightClique(CompatibilityGraph(1), {2.}, {});
  EXPECT_THAT(single.vertices, ElementsAre(0));
  EXPECT_EQ(single.weight, 2.);
}

TEST(MaxCliqueTest, WeightsCountRevisitsNotLoops) {
  // A triangle of weight one each against a pair of weight two each.
  CompatibilityGraph graph(5);
  graph.AddEdge(0, 1);
  graph.AddEdge(1, 2);
  graph.AddEdge(0, 2);
  graph.AddEdge(3, 4);
  EXPECT_THAT(MaxWeightClique(graph, {1., 1., 1., 1., 1.}, {}).vertices,
              ElementsAre(0, 1, 2));
  EXPECT_THAT(MaxWeightClique(graph, {1., 1., 1., 2., 2.}, {}).vertices,
              ElementsAre(3, 4));
}

// Pairs of many neighbours hide a clique of five from the greedy start.
TEST(MaxCliqueTest, BeginsWithAGivenClique) {
  CompatibilityGraph graph(45);
  for (int u = 0; u < 20; ++u) {
    for (int v = 20; v < 40; ++v) graph.AddEdge(u, v);
  }
  for (int u = 40; u < 45; ++u) {
    for (int v = 40; v < u; ++v) graph.AddEdge(u, v);
  }
  const std::vector<double> weights(45, 1.);
  MaxCliqueOptions none;
  none.max_steps = 0;
  EXPECT_EQ(MaxWeightClique(graph, weights, none).weight, 2.);
  // It is grown, and what is not joined to it is left out.
  const MaxCliqueResult grown =
      MaxWeightClique(graph, weights, none, {40, 41, 7, 42});
  EXPECT_THAT(grown.vertices, ElementsAre(40, 41, 42, 43, 44));
  EXPECT_FALSE(grown.exact);
  const MaxCliqueResult exact = MaxWeightClique(graph, weights, {}, {3, 25});
  EXPECT_THAT(exact.vertices, ElementsAre(40, 41, 42, 43, 44));
  EXPECT_TRUE(exact.exact);
}

TEST(MaxCliqueTest, EqualsExhaustiveSearchOnRandomGraphs) {
  Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = static_cast<int>(random.UniformInt(1, 13));
    const double density = random.Uniform();
    CompatibilityGraph graph(n);
    std::vector<double> weights(n);
    for (int u = 0; u < n; ++u) {
      weights[u] = static_cast<double>(random.UniformInt(1, 4));
      for (int v = u + 1; v < n; ++v) {
        if (random.Uniform() < density) graph.AddEdge(u, v);
      }
    }
    double best = 0.;
    for (int mask = 1; mask < (1 << n); ++mask) {
      double weight = 0.;
      bool clique = true;
      for (int u = 0; clique && u < n; ++u) {
        if (!((mask >> u) & 1)) continue;
        weight += weights[u];
        for (int v = u + 1; clique && v < n; ++v) {
          if ((mask >> v) & 1) clique = graph.HasEdge(u, v);
        }
      }
      if (clique) best = std::max(best, weight);
    }
    const MaxCliqueResult result = MaxWeightClique(graph, weights, {});
    EXPECT_TRUE(result.exact);
    EXPECT_EQ(result.weight, best);
    double sum = 0.;
    for (size_t i = 0; i < result.vertices.size(); ++i) {
      sum += weights[result.vertices[i]];
      for (size_t j = i + 1; j < result.vertices.size(); ++j) {
        EXPECT_TRUE(graph.HasEdge(result.vertices[i], result.vertices[j]));
      }
    }
    EXPECT_EQ(sum, best);
  }
}

TEST(MaxCliqueTest, FindsAPlantedCliqueAmongManyAndRespectsTheCap) {
  Random random(2);
  const int n = 300;
  CompatibilityGraph graph(n);
  for (int u = 0; u < n; ++u) {
    for (int v = u + 1; v < n; ++v) {
      const bool planted = u % 10 == 0 && v % 10 == 0;
      if (planted || random.Uniform() < 0.3) graph.AddEdge(u, v);
    }
  }
  const std::vector<double> weights(n, 1.);
  const MaxCliqueResult result = MaxWeightClique(graph, weights, {});
  EXPECT_GE(result.weight, 30.);

  // Without a planted clique there is much to search.
  CompatibilityGraph hard(n);
  for (int u = 0; u < n; ++u) {
    for (int v = u + 1; v < n; ++v) {
      if (random.Uniform() < 0.7) hard.AddEdge(u, v);
    }
  }
  MaxCliqueOptions capped;
  capped.max_steps = 10;
  const MaxCliqueResult partial = MaxWeightClique(hard, weights, capped);
  EXPECT_FALSE(partial.exact);
  // One with all candidates counts for many.
  EXPECT_LE(partial.steps, 10 + 1 + n * n / 1024);
  EXPECT_GT(partial.weight, 1.);  // the heuristic start is kept
}

// A hundred loops without contradiction, and a hundred rings of five of which
// only two each go together: 2^100 maximum cliques.
TEST(MaxCliqueTest, ContradictionsApartFromEachOtherAreDecidedApart) {
  const int n = 600;
  CompatibilityGraph graph(n);
  const auto contradict = [](const int u, const int v) {
    if (v < 100 || (u - 100) / 5 != (v - 100) / 5) return false;
    const int distance = v - u;
    return u >= 100 && (distance == 1 || distance == 4);
  };
  for (int u = 0; u < n; ++u) {
    for (int v = u + 1; v < n; ++v) {
      if (!contradict(u, v)) graph.AddEdge(u, v);
    }
  }
  const MaxCliqueResult result =
      MaxWeightClique(graph, std::vector<double>(n, 1.), {});
  EXPECT_TRUE(result.exact);
  EXPECT_EQ(result.weight, 300.);
  EXPECT_EQ(result.vertices.size(), 300u);
  EXPECT_LT(result.steps, 5000);
  for (size_t i = 0; i < result.vertices.size(); ++i) {
    for (size_t j = i + 1; j < result.vertices.size(); ++j) {
      EXPECT_TRUE(graph.HasEdge(result.vertices[i], result.vertices[j]));
    }
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
