// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/map_evidence.h"

#include <cmath>
#include <vector>

#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// The evidence of a solution with these loops in force.
double EvidenceOf(const PoseGraph& graph, const std::vector<double>& decisions,
                  std::vector<Pose2>* const poses) {
  const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
  RobustSolver solver(edges);
  SolverOptions options;
  options.edge_weights = decisions;
  options.cost_tolerance = 1e-12;
  solver.Solve(options, poses);
  return LogEvidenceOfMap({*poses, decisions},
                          FindLoopSupport(graph, LoopSupportOptions()), edges,
                          LogArea(graph.poses), &solver);
}

// What a loop adds is the likelihood ratio of its innovation.
TEST(MapEvidenceTest, ALoopAddsTheEvidenceOfItsInnovation) {
  const PoseGraph graph = test::MakeGridWorld(120, 5, 1).graph;
  std::vector<double> decisions(graph.edges.size(), 1.);
  std::vector<Pose2> with = graph.poses, without = graph.poses;
  const double all = EvidenceOf(graph, decisions, &with);
  int loops = 0;
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    if (!graph.edges[i].is_loop || ++loops % 8 != 0) continue;
    decisions[i] = 0.;
    const double others = EvidenceOf(graph, decisions, &without);
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    RobustSolver solver(edges);
    const Innovation innovation =
        PredictLoops({static_cast<int>(i)}, decisions, without, &solver)[0];
    EXPECT_NEAR(all - others,
                LogEvidence(edges[i], innovation, LogArea(graph.poses)), 0.05);
    decisions[i] = 1.;
  }
  EXPECT_GT(loops, 16);
}

// The actual noise is likelier than half or twice as much, of either kind.
TEST(MapEvidenceTest, TheActualNoiseIsTheLikeliest) {
  const PoseGraph graph = test::MakeGridWorld(300, 5, 3).graph;
  const std::vector<double> decisions(graph.edges.size(), 1.);
  std::vector<Pose2> poses = graph.poses;
  const double actual = EvidenceOf(graph, decisions, &poses);
  for (const double factor : {0.5, 2.}) {
    EXPECT_LT(EvidenceOf(WithNoiseScale(graph, factor, 1.), decisions, &poses),
              actual - 10.);
    EXPECT_LT(EvidenceOf(WithNoiseScale(graph, 1., factor), decisions, &poses),
              actual - 10.);
  }
}

// A group of wrong loops is one mistake, not as many as it has loops.
TEST(MapEvidenceTest, AWrongGroupIsWrongOnce) {
  test::GridWorld world = test::MakeGridWorld(200, 5, 3);
  const size_t right = world.graph.edges.size();
  for (const bool grouped : {false, true}) {
    PoseGraph graph = world.graph;
    constexpr int kWrong = 4;
    for (int k = 0; k != kWrong; ++k) {
      PoseGraphEdge edge = graph.edges[right - 1];
      edge.is_loop = true;
      edge.from = 20 + (grouped ? 0 : 30 * k);
      edge.to = 185;
      edge.measurement = Pose2(40., 40. + (grouped ? 0. : 5. * k), 0.);
      graph.edges.push_back(edge);
    }
    std::vector<double> decisions(graph.edges.size(), 1.);
    for (size_t i = right; i != graph.edges.size(); ++i) decisions[i] = 0.;
    std::vector<Pose2> poses = graph.poses;
    const double evidence = EvidenceOf(graph, decisions, &poses);
    std::vector<double> without(right, 1.);
    const double all_right = EvidenceOf(world.graph, without, &poses);
    const double follows =
        LogVolume(Whiten(graph.edges).back(), LogArea(graph.poses)) - 1.5 -
        1.5 * std::log(2.);
    EXPECT_NEAR(evidence - all_right, grouped ? (kWrong - 1) * follows : 0.,
                0.05);
  }
}

// Of four groups three are right: each decides with the share of its kind.
TEST(MapEvidenceTest, DecisionsAreAsLikelyAsTheirShares) {
  std::vector<WhitenedEdge> edges(9);
  LoopSupport support;
  std::vector<double> decisions(9, 1.);
  for (int i = 0; i != 9; ++i) {
    edges[i].is_loop = i > 0;
    edges[i].from = 0;
    edges[i].to = i;
    support.group.push_back(i == 0 ? -1 : (i - 1) / 2);
  }
  EXPECT_DOUBLE_EQ(LogPriorOfDecisions(decisions, support, edges), 0.);
  decisions[7] = decisions[8] = 0.;  // one group
  EXPECT_DOUBLE_EQ(LogPriorOfDecisions(decisions, support, edges),
                   3. * std::log(0.75) + std::log(0.25));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
