// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// OptimizationProblem2D with our block in the options, inside the host.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Constraint = PoseGraphInterface::Constraint;
using TrajectoryState = PoseGraphInterface::TrajectoryState;
using cartographer_ext::PoseGraphContext;
using cartographer_ext::ScopedPoseGraphContext;
using cartographer_ext::optimization::SwitchedLoopRecorder;
using cartographer_ext::optimization::SwitchedLoops;
using transform::Rigid2d;

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

constexpr int kNodes = 80;
constexpr int kNodesPerSubmap = 10;
// Of the square, one node a metre.
constexpr int kNodesPerRound = 40;

// A square of 10 m walked twice. Local SLAM turns a little too far at every
// step. A submap begins every ten nodes at its first node and holds twenty.
class RobustOptimizationProblem2DTest : public ::testing::Test {
 protected:
  RobustOptimizationProblem2DTest() {
    Rigid2d truth, local;
    for (int i = 0; i != kNodes; ++i) {
      truth_.push_back(truth);
      local_.push_back(local);
      const double turn = i % 10 == 9 ? M_PI / 2. : 0.;
      truth = truth * Rigid2d({1., 0.}, turn);
      local = local * Rigid2d({1., 0.}, turn + 0.001);
    }
    for (int i = 0; i != kNodes; ++i) {
      for (int submap = i / kNodesPerSubmap - 1; submap <= i / kNodesPerSubmap;
           ++submap) {
        if (submap < 0) continue;
        constraints_.push_back(MakeConstraint(
            submap, i, Origin(local_, submap).inverse() * local_[i],
            Constraint::INTRA_SUBMAP));
      }
    }
  }

  static Rigid2d Origin(const std::vector<Rigid2d>& poses, const int submap) {
    return Rigid2d::Translation(poses[submap * kNodesPerSubmap].translation());
  }

  static Constraint MakeConstraint(const int submap, const int node,
                                   const Rigid2d& pose,
                                   const Constraint::Tag tag) {
    const bool is_loop = tag == Constraint::INTER_SUBMAP;
    return Constraint{
        SubmapId{0, submap}, NodeId{0, node},
        Constraint::Pose{transform::Embed3D(pose), is_loop ? 1.1e4 : 500.,
                         is_loop ? 1e5 : 1600.},
        tag};
  }

  // The node of the second round is where the submap of the first is.
  Constraint RightLoop(const int submap, const int node) const {
    return MakeConstraint(submap, node,
                          Origin(truth_, submap).inverse() * truth_[node],
                          Constraint::INTER_SUBMAP);
  }

  static OptimizationProblem2D MakeProblem(const std::string& block) {
    return OptimizationProblem2D(test::LoadSlamOptions(block)
                                     .map_builder.pose_graph_options()
                                     .optimization_problem_options());
  }

  void Fill(OptimizationProblem2D* const problem, const int first = 0,
            const int end = kNodes) const {
    for (int i = first; i != end; ++i) {
      // Continues from the optimised pose of the node before.
      Rigid2d global = local_[i];
      if (i > 0) {
        global = problem->node_data().at(NodeId{0, i - 1}).global_pose_2d *
                 local_[i - 1].inverse() * local_[i];
      }
      problem->AddTrajectoryNode(0, NodeSpec2D{test::At(i), local_[i], global,
                                               Eigen::Quaterniond::Identity()});
      if (i % kNodesPerSubmap == 0) {
        problem->AddSubmap(0, global * local_[i].inverse() *
                                  Origin(local_, i / kNodesPerSubmap));
      }
    }
  }

  std::vector<Constraint> With(const std::vector<Constraint>& loops) const {
    std::vector<Constraint> result = constraints_;
    result.insert(result.end(), loops.begin(), loops.end());
    return result;
  }

  // Of the first nodes, without loops.
  std::vector<Constraint> ConstraintsOf(const int num_nodes) const {
    std::vector<Constraint> result;
    for (const Constraint& constraint : constraints_) {
      if (constraint.node_id.node_index < num_nodes) {
        result.push_back(constraint);
      }
    }
    return result;
  }

  std::vector<Constraint> UpTo(const int num_nodes) const {
    std::vector<Constraint> result = ConstraintsOf(num_nodes);
    for (const Constraint& loop : RightLoops()) {
      if (loop.node_id.node_index < num_nodes) result.push_back(loop);
    }
    return result;
  }

  // How far the poses of the first nodes, as at the start of the run, moved.
  static double Moved(const MapById<NodeId, NodeSpec2D>& before,
                      const OptimizationProblem2D& problem,
                      const int num_nodes) {
    double result = 0.;
    for (int i = 0; i != num_nodes; ++i) {
      const NodeId id(0, i);
      result = std::max(
          result, (before.at(id).global_pose_2d.translation() -
                   problem.node_data().at(id).global_pose_2d.translation())
                      .norm());
    }
    return result;
  }

  std::vector<Constraint> RightLoops() const {
    std::vector<Constraint> result;
    for (int node = kNodesPerRound + 2; node < kNodes; node += 5) {
      result.push_back(
          RightLoop((node - kNodesPerRound) / kNodesPerSubmap, node));
    }
    return result;
  }

  // Two that agree with each other: the opposite sides of the square.
  std::vector<Constraint> WrongLoops() const {
    return {MakeConstraint(0, 25, Rigid2d({5., 0.2}, 0.1),
                           Constraint::INTER_SUBMAP),
            MakeConstraint(1, 72, Rigid2d({0.1, 0.1}, 0.),
                           Constraint::INTER_SUBMAP)};
  }

  static double LargestDifference(const OptimizationProblem2D& a,
                                  const OptimizationProblem2D& b) {
    double result = 0.;
    for (const auto& node : a.node_data()) {
      const Rigid2d difference = node.data.global_pose_2d.inverse() *
                                 b.node_data().at(node.id).global_pose_2d;
      result = std::max({result, difference.translation().norm(),
                         std::abs(difference.normalized_angle())});
    }
    return result;
  }

  double LargestError(const OptimizationProblem2D& problem) const {
    double result = 0.;
    for (const auto& node : problem.node_data()) {
      const Rigid2d difference =
          truth_[node.id.node_index].inverse() * node.data.global_pose_2d;
      result = std::max(result, difference.translation().norm());
    }
    return result;
  }

  SwitchedLoops LastSwitchedLoops() const {
    return context_->Get<SwitchedLoopRecorder>()->Get();
  }

  const std::shared_ptr<PoseGraphContext> context_ =
      std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope_{context_};
  const std::map<int, TrajectoryState> active_{{0, TrajectoryState::ACTIVE}};
  std::vector<Rigid2d> truth_, local_;
  std::vector<Constraint> constraints_;
};

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
