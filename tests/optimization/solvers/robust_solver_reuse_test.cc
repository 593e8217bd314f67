// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What solutions of the same graph share: factors within one, and results.
#include <cmath>
#include <vector>

#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "gtest/gtest.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// The grid world with its loops and some wrong ones.
class RobustSolverReuseTest : public ::testing::Test {
 protected:
  RobustSolverReuseTest() : world_(test::MakeGridWorld(250, 8, 5)) {
    clean_ = Whiten(world_.graph.edges);
    std::vector<PoseGraphEdge> edges = world_.graph.edges;
    test::AppendOutliers(world_.graph, test::Outliers(80), &edges);
    dirty_ = Whiten(edges);
    optimum_ = world_.graph.poses;
    SolveRobust(clean_, SolverOptions(), &optimum_);
  }
  // The optimum with one pose in ten moved by half a metre.
  std::vector<Pose2> Disturbed() const {
    std::vector<Pose2> poses = optimum_;
    for (size_t i = 5; i < poses.size(); i += 10) poses[i].x += 0.5;
    return poses;
  }
  // Of the solution of disturbed poses, at the cost of an exact one.
  void ExpectSharedFactors(const std::vector<WhitenedEdge>& edges,
                           SolverOptions options) const {
    std::vector<Pose2> poses = Disturbed(), exact = poses;
    options.initial_lambda = 1e-8;
    const SolverSummary summary = SolveRobust(edges, options, &poses);
    EXPECT_TRUE(summary.converged);
    EXPECT_LT(summary.factorizations, summary.iterations);
    options.cost_tolerance = 1e-14;
    const SolverSummary reference = SolveRobust(edges, options, &exact);
    EXPECT_NEAR(summary.final_cost, reference.final_cost,
                1e-6 * reference.final_cost);
  }

  test::GridWorld world_;
  std::vector<WhitenedEdge> clean_;
  std::vector<WhitenedEdge> dirty_;
  std::vector<Pose2> optimum_;
};

TEST_F(RobustSolverReuseTest, LastStepsShareAFactor) {
  ExpectSharedFactors(clean_, SolverOptions());
}

TEST_F(RobustSolverReuseTest, RoughSolutionsHaveNoStepsToSpare) {
  std::vector<Pose2> poses = Disturbed();
  SolverOptions options;
  options.initial_lambda = 1e-8;
  options.cost_tolerance = 1e-3;
  const SolverSummary summary = SolveRobust(clean_, options, &poses);
  EXPECT_GT(summary.iterations, 1);
  EXPECT_EQ(summary.factorizations, summary.iterations);
}

TEST_F(RobustSolverReuseTest, ReweightedStepsShareAFactor) {
  SolverOptions options;
  options.kernel = DefaultKernel(KernelType::kGemanMcClure);
  ExpectSharedFactors(dirty_, options);
}

TEST_F(RobustSolverReuseTest, PolishesMeetInOneSolution) {
  RobustSolver solver(dirty_);
  std::vector<Pose2> first = optimum_, second = Disturbed();
  std::vector<double> weights, weights_again;
  EXPECT_GT(
      PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &first, &weights)
          .iterations,
      0);
  // Solved alone until it decides alike.
  SolverOptions options;
  options.edge_weights = weights;
  options.cost_tolerance = 1e-3;
  SolveRobust(dirty_, options, &second);
  ASSERT_EQ(DecideLoops(dirty_, second, kChi2Gate), weights);
  const SolverSummary summary = PolishTruncated(
      kChi2Gate, kFullPolishRounds, &solver, &second, &weights_again);
  EXPECT_EQ(summary.iterations, 0);
  EXPECT_TRUE(summary.converged);
  EXPECT_EQ(weights_again, weights);
  for (size_t i = 0; i != first.size(); ++i) {
    EXPECT_EQ(second[i].x, first[i].x);
    EXPECT_EQ(second[i].theta, first[i].theta);
  }
}

TEST_F(RobustSolverReuseTest, OnlyWhatCostsNoMoreIsRecalled) {
  RobustSolver solver(clean_);
  const std::vector<double> weights(clean_.size(), 1.);
  std::vector<Pose2> poses = Disturbed();
  EXPECT_FALSE(solver.Recall(weights, &poses));
  solver.Remember(weights, poses);
  poses = optimum_;
  EXPECT_FALSE(solver.Recall(weights, &poses));
  EXPECT_EQ(poses[5].x, optimum_[5].x);
  solver.Remember(weights, optimum_);
  std::vector<double> others = weights;
  others.back() = 0.;
  poses = Disturbed();
  EXPECT_FALSE(solver.Recall(others, &poses));
}

TEST_F(RobustSolverReuseTest, WhatWasAskedLastIsFactorisedOnce) {
  std::vector<WhitenedEdge> edges = clean_;
  RobustSolver solver(edges);
  std::vector<double> weights(edges.size(), 1.);
  // The solution of the factor, and whether it was made anew.
  const auto ask = [&](const std::vector<Pose2>& poses, Eigen::VectorXd* step) {
    const int before = solver.factorizations();
    const double work = solver.work();
    const BlockLdlt* const factor = solver.Factor(poses, weights, step);
    EXPECT_NE(factor, nullptr);
    EXPECT_GT(solver.work(), work);
    factor->Solve(step);
    return solver.factorizations() != before;
  };
  const std::vector<Pose2> poses = Disturbed();
  Eigen::VectorXd first, again, step;
  EXPECT_TRUE(ask(poses, &first));
  EXPECT_FALSE(ask(poses, &again));
  EXPECT_EQ(again, first);
  // Not with other edges, weights or poses, nor after another factor.
  edges[3].whitening *= 1.1;
  EXPECT_TRUE(ask(poses, &step));
  EXPECT_NE(step, first);
  edges = clean_;
  EXPECT_TRUE(ask(poses, &again));
  EXPECT_EQ(again, first);
  weights.back() = 0.5;
  EXPECT_TRUE(ask(poses, &step));
  weights.back() = 1.;
  EXPECT_TRUE(ask(optimum_, &step));
  EXPECT_TRUE(ask(poses, &again));
  EXPECT_EQ(again, first);
  std::vector<Pose2> solved = poses;
  solver.Solve(SolverOptions(), &solved);
  EXPECT_TRUE(ask(poses, &again));
  EXPECT_LT((again - first).norm(), 1e-9 * first.norm());
}

TEST_F(RobustSolverReuseTest, MemoryOfAnotherGraphChangesNothing) {
  SolverOptions options;
  options.kernel = DefaultKernel(KernelType::kDcs);
  std::vector<Pose2> expected = Disturbed();
  SolveRobust(clean_, options, &expected);
  for (const std::vector<WhitenedEdge>* const other : {&dirty_, &clean_}) {
    RobustSolver larger(*other);
    std::vector<Pose2> poses = Disturbed();
    larger.Solve(options, &poses);
    RobustSolver solver(clean_);
    solver.TakeMemory(larger.ReleaseMemory());
    poses = Disturbed();
    solver.Solve(options, &poses);
    for (size_t i = 0; i != poses.size(); ++i) {
      EXPECT_EQ(poses[i].x, expected[i].x);
      EXPECT_EQ(poses[i].theta, expected[i].theta);
    }
  }
}

TEST_F(RobustSolverReuseTest, ChangedEdgesAreNoticed) {
  std::vector<WhitenedEdge> edges = clean_;
  RobustSolver solver(edges);
  const std::vector<double> weights(edges.size(), 1.);
  solver.Remember(weights, optimum_);
  edges[3].whitening *= 1.1;
  std::vector<Pose2> poses = Disturbed();
  EXPECT_FALSE(solver.Recall(weights, &poses));
  // What is forgotten does not come back.
  edges = clean_;
  EXPECT_FALSE(solver.Recall(weights, &poses));
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
