// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// OptimizationProblem2D with our block in the options, inside the host.
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/host/square_walk.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

constexpr char kBlock[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {}";
constexpr char kPassive[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
    "  robust_loops = false, odometry_check = false }";
constexpr char kRecent[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
    "  robust_loops = false, odometry_check = false, recent_nodes = 30 }";
constexpr char kOdometryCheckAlone[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
    "  robust_loops = false }";

class RobustOptimizationProblem2DTest : public SquareWalkTest {};

TEST_F(RobustOptimizationProblem2DTest, RightLoopsGiveTheStockResult) {
  OptimizationProblem2D stock = MakeProblem(""), robust = MakeProblem(kBlock);
  for (OptimizationProblem2D* const problem : {&stock, &robust}) {
    Fill(problem);
    problem->Solve(With(RightLoops()), active_, {});
  }
  EXPECT_EQ(LargestDifference(stock, robust), 0.);
  EXPECT_LT(LargestError(robust), 0.5);
  const SwitchedLoops loops = LastSwitchedLoops();
  EXPECT_EQ(loops.optimizations, 1);  // the stock problem publishes nothing
  EXPECT_EQ(loops.loops, 8);
  EXPECT_TRUE(loops.off.empty());
  EXPECT_GT(loops.selection_cpu_seconds, 0.);
  EXPECT_GT(loops.solution_cpu_seconds, 0.);
}

TEST_F(RobustOptimizationProblem2DTest, WrongLoopsAreAsIfTheyWereNotThere) {
  OptimizationProblem2D stock = MakeProblem(""), robust = MakeProblem(kBlock);
  Fill(&stock);
  Fill(&robust);
  std::vector<Constraint> loops = RightLoops();
  stock.Solve(With(loops), active_, {});
  for (const Constraint& loop : WrongLoops()) loops.push_back(loop);
  robust.Solve(With(loops), active_, {});
  EXPECT_EQ(LargestDifference(stock, robust), 0.);
  const SwitchedLoops result = LastSwitchedLoops();
  EXPECT_EQ(result.loops, 10);
  ASSERT_EQ(result.off.size(), 2u);
  EXPECT_EQ(result.off[0].submap_index, 0);
  EXPECT_EQ(result.off[0].node_index, 25);
  EXPECT_EQ(result.off[1].submap_index, 1);
  EXPECT_EQ(result.off[1].node_index, 72);
  EXPECT_GT(result.off[0].chi2, 11.345);
}

TEST_F(RobustOptimizationProblem2DTest, JudgementsChangeWithTheEvidence) {
  OptimizationProblem2D problem = MakeProblem(kBlock);
  Fill(&problem);
  // At first one right loop against three that agree with each other.
  std::vector<Constraint> loops = {RightLoop(1, 52)};
  for (const int node : {50, 52, 54}) {
    loops.push_back(MakeConstraint(1, node,
                                   Rigid2d::Translation({0.6, 0.}) *
                                       Origin(truth_, 1).inverse() *
                                       truth_[node],
                                   Constraint::INTER_SUBMAP));
  }
  problem.Solve(With(loops), active_, {});
  ASSERT_EQ(LastSwitchedLoops().off.size(), 1u);
  EXPECT_EQ(LastSwitchedLoops().off[0].node_index, 52);
  // Then seven more that are right, and the first comes back.
  for (const Constraint& loop : RightLoops()) loops.push_back(loop);
  problem.Solve(With(loops), active_, {});
  problem.Solve(With(loops), active_, {});
  EXPECT_EQ(LastSwitchedLoops().off.size(), 3u);
  EXPECT_LT(LargestError(problem), 0.5);
}

TEST_F(RobustOptimizationProblem2DTest, OdometryCheckDisablesTheLoop) {
  OptimizationProblem2D stock = MakeProblem("");
  OptimizationProblem2D checked = MakeProblem(kOdometryCheckAlone);
  for (OptimizationProblem2D* const problem : {&stock, &checked}) {
    Fill(problem);
  }
  std::vector<Constraint> loops = RightLoops();
  stock.Solve(With(loops), active_, {});
  // Tears the trajectory between two neighbours.
  loops.push_back(
      MakeConstraint(1, 13, Rigid2d({9., -4.}, 1.), Constraint::INTER_SUBMAP));
  checked.Solve(With(loops), active_, {});
  ASSERT_EQ(LastSwitchedLoops().off.size(), 1u);
  EXPECT_EQ(LastSwitchedLoops().off[0].node_index, 13);
  EXPECT_TRUE(LastSwitchedLoops().off[0].by_odometry_check);
  EXPECT_EQ(LargestDifference(stock, checked), 0.);
}

TEST_F(RobustOptimizationProblem2DTest, PassiveBlockOnlyTakesTheTime) {
  OptimizationProblem2D stock = MakeProblem(""),
                        passive = MakeProblem(kPassive);
  std::vector<Constraint> loops = RightLoops();
  for (const Constraint& loop : WrongLoops()) loops.push_back(loop);
  for (OptimizationProblem2D* const problem : {&stock, &passive}) {
    Fill(problem);
    problem->Solve(With(loops), active_, {});
  }
  EXPECT_EQ(LargestDifference(stock, passive), 0.);
  EXPECT_EQ(LastSwitchedLoops().optimizations, 1);
  EXPECT_EQ(LastSwitchedLoops().loops, 10);
  EXPECT_TRUE(LastSwitchedLoops().off.empty());
  EXPECT_GT(LastSwitchedLoops().solution_cpu_seconds, 0.);
}

TEST_F(RobustOptimizationProblem2DTest, FrozenMapsKeepTheirPlace) {
  OptimizationProblem2D problem = MakeProblem(kBlock);
  Fill(&problem);
  std::vector<Constraint> loops = RightLoops();
  for (const Constraint& loop : WrongLoops()) loops.push_back(loop);
  problem.Solve(With(loops), {{0, TrajectoryState::FROZEN}}, {});
  for (const auto& node : problem.node_data()) {
    EXPECT_NEAR((node.data.global_pose_2d.translation() -
                 local_[node.id.node_index].translation())
                    .norm(),
                0., 1e-12);
  }
  // What does not fit a map that cannot move is disabled.
  EXPECT_GE(LastSwitchedLoops().off.size(), 2u);
}

TEST_F(RobustOptimizationProblem2DTest, TheNewestPartIsOptimizedAlone) {
  OptimizationProblem2D whole = MakeProblem(""), recent = MakeProblem(kRecent);
  for (OptimizationProblem2D* const problem : {&whole, &recent}) {
    Fill(problem, 0, 60);
    problem->Solve(UpTo(60), active_, {});
  }
  // The first time it is the whole graph.
  EXPECT_EQ(LargestDifference(whole, recent), 0.);
  const MapById<NodeId, NodeSpec2D> before = recent.node_data();
  for (OptimizationProblem2D* const problem : {&whole, &recent}) {
    Fill(problem, 60, 65);
    problem->Solve(UpTo(65), active_, {});
  }
  EXPECT_EQ(Moved(before, recent, 35), 0.);
  EXPECT_GT(Moved(before, whole, 35), 0.);
  EXPECT_GT(Moved(before, recent, 60), 0.);
  EXPECT_LT(LargestDifference(whole, recent), 0.03);
  EXPECT_LT(LargestError(recent), 0.5);
  // Grown by a tenth.
  Fill(&recent, 65, 66);
  recent.Solve(UpTo(66), active_, {});
  EXPECT_GT(Moved(before, recent, 35), 0.);
}

TEST_F(RobustOptimizationProblem2DTest, WhatContradictsTheOldPartMovesIt) {
  OptimizationProblem2D problem = MakeProblem(kRecent);
  Fill(&problem, 0, 64);
  // Without loops the old part has drifted.
  problem.Solve(ConstraintsOf(64), active_, {});
  const MapById<NodeId, NodeSpec2D> before = problem.node_data();
  Fill(&problem, 64, 66);
  std::vector<Constraint> constraints = ConstraintsOf(66);
  // One metre off.
  for (const int node : {62, 63, 64, 65}) {
    constraints.push_back(MakeConstraint(2, node,
                                         Rigid2d::Translation({1., 0.}) *
                                             Origin(local_, 2).inverse() *
                                             local_[node],
                                         Constraint::INTER_SUBMAP));
  }
  problem.Solve(constraints, active_, {});
  EXPECT_GT(Moved(before, problem, 30), 0.);
}

TEST_F(RobustOptimizationProblem2DTest, TheFinalOptimizationIsOfTheWholeGraph) {
  OptimizationProblem2D problem = MakeProblem(kRecent);
  Fill(&problem, 0, 64);
  problem.Solve(UpTo(64), active_, {});
  const MapById<NodeId, NodeSpec2D> before = problem.node_data();
  Fill(&problem, 64, 66);
  problem.SetMaxNumIterations(200);
  problem.Solve(UpTo(66), active_, {});
  EXPECT_GT(Moved(before, problem, 30), 0.);
  // Trimmed nodes and submaps are gone from both.
  problem.TrimTrajectoryNode(NodeId{0, 0});
  EXPECT_EQ(problem.node_data().size(), 65u);
  problem.TrimSubmap(SubmapId{0, 6});
  EXPECT_EQ(problem.submap_data().size(), 6u);
}

TEST_F(RobustOptimizationProblem2DTest, TrimmedNodesAndNothingAtAll) {
  OptimizationProblem2D problem = MakeProblem(kBlock);
  problem.Solve({}, {}, {});
  EXPECT_EQ(LastSwitchedLoops().loops, 0);
  Fill(&problem);
  problem.Solve({}, active_, {});
  std::vector<Constraint> loops = RightLoops();
  const Constraint gone = loops.front();
  problem.TrimTrajectoryNode(gone.node_id);
  std::vector<Constraint> constraints;
  for (const Constraint& constraint : With(loops)) {
    if (constraint.node_id != gone.node_id) constraints.push_back(constraint);
  }
  problem.Solve(constraints, active_, {});
  EXPECT_EQ(LastSwitchedLoops().loops, 7);
  EXPECT_TRUE(LastSwitchedLoops().off.empty());
  EXPECT_LT(LargestError(problem), 0.5);
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
