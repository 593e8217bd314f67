// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/decision_moves.h"

#include <cmath>

#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "gmock/gmock.h"
#include "tests/optimization/weak_ring.h"

namespace cartographer_ext {
namespace optimization {
namespace {

TEST(DecisionMovesTest, FlipsNeverRaiseTheCost) {
  for (const uint64_t seed : {1, 2, 3, 4}) {
    test::GridWorld world = test::MakeGridWorld(150, 5, seed);
    const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
    RobustSolver solver(edges);
    std::vector<Pose2> poses = world.graph.poses;
    PolishTruncated(kChi2Gate, 30, &solver, &poses, nullptr);
    const double before = TruncatedCost(edges, poses);
    const int kept = FlipLoops(FlipOptions(), &solver, &poses);
    const double after = TruncatedCost(edges, poses);
    if (kept > 0) {
      EXPECT_LT(after, before);
    } else {
      EXPECT_EQ(after, before);
    }
  }
}

TEST(DecisionMovesTest, FlipBringsInALoopThatTheMapAllows) {
  // Odometry alone: the only loop is far off but within the uncertainty.
  std::vector<PoseGraphEdge> list;
  std::vector<Pose2> poses = {Pose2()};
  for (int i = 0; i != 20; ++i) {
    PoseGraphEdge edge;
    edge.from = i;
    edge.to = i + 1;
    edge.measurement = Pose2(1., 0., 0.);
    edge.information = 25. * Eigen::Matrix3d::Identity();
    list.push_back(edge);
    poses.push_back(poses.back() * edge.measurement);
  }
  PoseGraphEdge loop;
  loop.from = 0;
  loop.to = 20;
  loop.measurement = Pose2(20., 3., 0.1);
  loop.information = 400. * Eigen::Matrix3d::Identity();
  loop.is_loop = true;
  list.push_back(loop);
  const std::vector<WhitenedEdge> edges = Whiten(list);
  RobustSolver solver(edges);
  ASSERT_GT(Chi2(edges[20], poses[0], poses[20]), 50. * kChi2Gate);
  FlipOptions options;
  EXPECT_EQ(FlipLoops(options, &solver, &poses), 0);  // beyond what is near
  poses[20].y = 2.;
  solver.Solve(SolverOptions(), &poses);
  EXPECT_LT(Chi2(edges[20], poses[0], poses[20]), kChi2Gate);
}

TEST(DecisionMovesTest, MapsDifferNearTheGateOrFarFromIt) {
  PoseGraphEdge loop;
  loop.from = 0;
  loop.to = 1;
  loop.information = Eigen::Matrix3d::Identity();
  loop.is_loop = true;
  const std::vector<WhitenedEdge> edges =
      Whiten(std::vector<PoseGraphEdge>{loop});
  const auto at = [](const double gates) -> std::vector<Pose2> {
    return {Pose2(), Pose2(std::sqrt(gates * kChi2Gate), 0., 0.)};
  };
  EXPECT_TRUE(DifferNearGateOnly(edges, at(0.9), at(3.9)));
  EXPECT_TRUE(DifferNearGateOnly(edges, at(1.1), at(100.)));
  EXPECT_FALSE(DifferNearGateOnly(edges, at(0.9), at(4.1)));
  EXPECT_FALSE(DifferNearGateOnly(edges, at(4.1), at(0.9)));
}

TEST(DecisionMovesTest, RightGroupsPushOutAWrongOne) {
  test::GridWorld world = test::MakeWeakRing(2);
  // One wrong group of four that agrees with itself.
  const size_t clean = world.graph.edges.size();
  for (int j = 0; j != 4; ++j) {
    PoseGraphEdge edge = world.graph.edges[clean - 1];
    edge.from = 20 + j;
    edge.to = 60 + j;
    edge.measurement = Pose2(0.3, 0., 0.);
    world.graph.edges.push_back(edge);
  }
  std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  // Start with the wrong group alone.
  SolverOptions wrong;
  wrong.edge_weights.assign(edges.size(), 1.);
  for (size_t i = 0; i != clean; ++i) {
    if (edges[i].is_loop) wrong.edge_weights[i] = 0.;
  }
  std::vector<Pose2> start = world.graph.poses;
  solver.Solve(wrong, &start);
  PolishTruncated(kChi2Gate, 30, &solver, &start, nullptr);
  const LoopSupport support =
      FindLoopSupport(world.graph, LoopSupportOptions());
  // Right groups lower the cost while they are in force.
  for (const double max_rise : {1e9, 1.}) {
    ForceOptions options;
    options.max_rise = max_rise;
    std::vector<Pose2> poses = start;
    std::vector<Alternative> alternatives;
    EXPECT_GT(
        ForceGroups(support, options, &edges, &solver, &poses, &alternatives),
        0);
    EXPECT_LT(TruncatedCost(edges, poses), TruncatedCost(edges, start));
    int wrong_in_force = 0;
    for (size_t i = clean; i != edges.size(); ++i) {
      EXPECT_TRUE(edges[i].is_loop);
      wrong_in_force +=
          Chi2(edges[i], poses[edges[i].from], poses[edges[i].to]) < kChi2Gate;
    }
    EXPECT_EQ(wrong_in_force, 0);
  }
}

// With a limit that nothing meets no group is released.
TEST(DecisionMovesTest, WhatRaisesTheCostTooMuchIsGivenUp) {
  test::GridWorld world = test::MakeWeakRing(2);
  std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  RobustSolver solver(edges);
  std::vector<Pose2> poses = world.graph.poses;
  PolishTruncated(kChi2Gate, 30, &solver, &poses, nullptr);
  ForceOptions options;
  options.max_rise = -1e9;
  const LoopSupport support =
      FindLoopSupport(world.graph, LoopSupportOptions());
  EXPECT_EQ(ForceGroups(support, options, &edges, &solver, &poses, nullptr), 0);
  options.max_rise = 1.;
  EXPECT_GT(ForceGroups(support, options, &edges, &solver, &poses, nullptr), 0);
}

// Of the first trial nobody knows beforehand what it takes; then work counts.
TEST(DecisionMovesTest, NoGroupIsTriedBeyondTheLimitOfWork) {
  test::GridWorld world = test::MakeWeakRing(6, 0.2, true);
  test::AddOutliers(test::Outliers(20, OutlierType::kRandomGrouped),
                    &world.graph);
  std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  std::vector<Pose2> start = world.graph.poses;
  PolishTruncated(edges, kChi2Gate, 30, &start, nullptr);
  const LoopSupport support =
      FindLoopSupport(world.graph, LoopSupportOptions());
  const auto work_of = [&](const bool regrow, const int max_trials,
                           const double max_work) {
    RobustSolver solver(edges);
    std::vector<Pose2> poses = start;
    if (regrow) {
      RegrowOptions options;
      options.max_trials = max_trials;
      options.max_work = max_work;
      RegrowGroups(support, options, &solver, &poses, nullptr);
    } else {
      ForceOptions options;
      options.max_trials = max_trials;
      options.max_work = max_work;
      ForceGroups(support, options, &edges, &solver, &poses, nullptr);
    }
    return solver.work();
  };
  for (const bool regrow : {false, true}) {
    EXPECT_EQ(work_of(regrow, 40, 0.), 0.);
    const double one = work_of(regrow, 1, kMaxMoveWork);
    const double two = work_of(regrow, 2, kMaxMoveWork);
    ASSERT_GT(one, 0.);
    ASSERT_GT(two, one);
    EXPECT_EQ(work_of(regrow, 40, 0.5 * one), one);
    EXPECT_EQ(work_of(regrow, 40, 0.5 * (one + two)), two);
    EXPECT_EQ(work_of(regrow, 40, one), one);
  }
}

TEST(DecisionMovesTest, AChordalRelaxationUnfoldsARing) {
  int unfolded = 0;
  for (const uint64_t seed : {1, 6, 8, 10, 12, 14, 16}) {
    test::GridWorld world = test::MakeWeakRing(seed, 0.2, true);
    test::AddOutliers(test::Outliers(20, OutlierType::kRandomGrouped, seed),
                      &world.graph);
    std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
    RobustSolver solver(edges);
    std::vector<Pose2> start = world.graph.poses;
    PolishTruncated(kChi2Gate, 30, &solver, &start, nullptr);
    const LoopSupport support =
        FindLoopSupport(world.graph, LoopSupportOptions());
    double cost[2];
    for (const bool relax : {false, true}) {
      ForceOptions options;
      options.relax = relax;
      std::vector<Pose2> poses = start;
      ForceGroups(support, options, &edges, &solver, &poses, nullptr);
      cost[relax] = TruncatedCost(edges, poses);
    }
    EXPECT_LE(cost[1], cost[0] * (1. + 1e-6)) << seed;
    unfolded += cost[1] < cost[0] - 5. * kChi2Gate;
  }
  EXPECT_GE(unfolded, 3);
}

// There and back on one line, with loops between the two passes: four right
// ones, and three wrong ones that agree with each other on another line.
std::vector<PoseGraphEdge> MakeThereAndBack(std::vector<Pose2>* const poses) {
  constexpr int kPoses = 60;
  std::vector<Pose2> truth = {Pose2()};
  std::vector<PoseGraphEdge> edges;
  for (int i = 0; i + 1 != kPoses; ++i) {
    PoseGraphEdge edge;
    edge.from = i;
    edge.to = i + 1;
    edge.measurement =
        i == kPoses / 2 - 1 ? Pose2(0., 0., kPi) : Pose2(1., 0., 0.);
    edge.information = Eigen::Vector3d(400., 400., 1. / 0.04).asDiagonal();
    edges.push_back(edge);
    truth.push_back(truth.back() * edge.measurement);
  }
  const auto add_loop = [&](const int from, const double aside) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = kPoses - 1 - from;
    edge.is_loop = true;
    edge.measurement =
        Between(truth[from], Pose2(0., aside, 0.) * truth[edge.to]);
    edge.information = Eigen::Vector3d(100., 100., 400.).asDiagonal();
    edges.push_back(edge);
  };
  for (const int from : {2, 8, 14, 20}) add_loop(from, 0.);
  for (const int from : {5, 11, 17}) add_loop(from, 8.);
  *poses = truth;
  return edges;
}

TEST(DecisionMovesTest, RegrowthReplacesWrongLoopsThatAgree) {
  PoseGraph graph;
  graph.edges = MakeThereAndBack(&graph.poses);
  std::vector<WhitenedEdge> edges = Whiten(graph.edges);
  const size_t first_wrong = edges.size() - 3;
  RobustSolver solver(edges);
  SolverOptions wrong;
  wrong.edge_weights.assign(edges.size(), 1.);
  for (size_t i = 0; i != first_wrong; ++i) {
    if (edges[i].is_loop) wrong.edge_weights[i] = 0.;
  }
  std::vector<Pose2> start = graph.poses;
  solver.Solve(wrong, &start);
  PolishTruncated(kChi2Gate, 30, &solver, &start, nullptr);
  const double cost = TruncatedCost(edges, start);
  // Each loop by itself.
  LoopSupportOptions options;
  options.window = 0;
  const LoopSupport support = FindLoopSupport(graph, options);
  ASSERT_EQ(support.groups.size(), 7u);
  std::vector<Pose2> poses = start;
  EXPECT_EQ(FlipLoops(FlipOptions(), &solver, &poses), 0);
  EXPECT_EQ(
      ForceGroups(support, ForceOptions(), &edges, &solver, &poses, nullptr),
      0);
  poses = start;
  std::vector<Alternative> alternatives;
  EXPECT_GT(
      RegrowGroups(support, RegrowOptions(), &solver, &poses, &alternatives),
      0);
  EXPECT_LT(TruncatedCost(edges, poses), cost - 0.9 * kChi2Gate);
  EXPECT_LT(AbsoluteTrajectoryError(poses, graph.poses), 0.05);
  // The wrong set costs one gate more than the right one.
  for (const Alternative& alternative : alternatives) {
    EXPECT_GE(alternative.cost, TruncatedCost(edges, poses));
  }
  // Nothing is left to do.
  const std::vector<Pose2> best = poses;
  EXPECT_EQ(RegrowGroups(support, RegrowOptions(), &solver, &poses, nullptr),
            0);
  EXPECT_EQ(TruncatedCost(edges, poses), TruncatedCost(edges, best));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
