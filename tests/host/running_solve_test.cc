// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Optimisations during a run that end early, inside the host.
#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/common/loop_information.h"
#include "gtest/gtest.h"
#include "tests/host/square_walk.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using LandmarkNode = PoseGraphInterface::LandmarkNode;

constexpr double kTolerance = 0.005;
constexpr char kLittleOdometry[] =
    "POSE_GRAPH.optimization_problem.odometry_translation_weight = 10.\n"
    "POSE_GRAPH.optimization_problem.odometry_rotation_weight = 10.\n";

// The problem with this tolerance; 0: all is Cartographer's.
std::string WithTolerance(const double tolerance) {
  return "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
         "  robust_loops = false, odometry_check = false,\n"
         "  loops_in_force = false, running_tolerance = " +
         std::to_string(tolerance) + " }\n";
}

class RunningSolveTest : public SquareWalkTest {
 protected:
  // Without and with tolerance.
  struct Problems {
    OptimizationProblem2D stock;
    OptimizationProblem2D early;
  };

  Problems MakeProblems(const std::string& changes) const {
    return {MakeProblem(WithTolerance(0.) + changes),
            MakeProblem(WithTolerance(kTolerance) + changes)};
  }

  // The difference between a problem with and one without tolerance after the
  // same optimisation.
  double Difference(
      const std::string& changes, const TrajectoryState state,
      const std::map<std::string, LandmarkNode>& landmarks = {},
      const std::vector<sensor::FixedFramePoseData>& fixed_frame = {}) const {
    Problems problems = MakeProblems(changes);
    for (OptimizationProblem2D* const problem :
         {&problems.stock, &problems.early}) {
      Fill(problem);
      for (const auto& data : fixed_frame) {
        problem->AddFixedFramePoseData(0, data);
      }
      problem->Solve(With(RightLoops()), {{0, state}}, landmarks);
    }
    return LargestDifference(problems.stock, problems.early);
  }
};

TEST_F(RunningSolveTest, IsNearCartographersResult) {
  const double difference =
      Difference(kLittleOdometry, TrajectoryState::ACTIVE);
  EXPECT_GT(difference, 0.);
  EXPECT_LT(difference, 2. * kTolerance);
}

TEST_F(RunningSolveTest, CartographerHasNothingToAdd) {
  OptimizationProblem2D problem =
      MakeProblem(WithTolerance(1e-6) + kLittleOdometry);
  // One loop is certain across and uncertain along its submap.
  const Constraint loop = RightLoops().back();
  context_->Get<cartographer_ext::LoopInformation>()->Set(
      cartographer_ext::MakeLoopId(loop.submap_id, loop.node_id),
      Eigen::Vector3d(1., 1e8, 1e9).asDiagonal());
  Fill(&problem);
  problem.Solve(With(RightLoops()), active_, {});
  const MapById<NodeId, NodeSpec2D> before = problem.node_data();
  const MapById<SubmapId, SubmapSpec2D> submaps_before = problem.submap_data();
  problem.SetMaxNumIterations(200);
  problem.Solve(With(RightLoops()), active_, {});
  EXPECT_LT(Moved(before, problem, kNodes), 1e-9);
  for (const auto& submap : problem.submap_data()) {
    EXPECT_LT((submap.data.global_pose.inverse() *
               submaps_before.at(submap.id).global_pose)
                  .translation()
                  .norm(),
              1e-9);
  }
}

TEST_F(RunningSolveTest, TheFinalOptimizationIsCartographers) {
  Problems problems = MakeProblems(kLittleOdometry);
  for (OptimizationProblem2D* const problem :
       {&problems.stock, &problems.early}) {
    Fill(problem);
    problem->SetMaxNumIterations(200);
    problem->Solve(With(RightLoops()), active_, {});
  }
  EXPECT_EQ(LargestDifference(problems.stock, problems.early), 0.);
}

TEST_F(RunningSolveTest, WhatItDoesNotKnowIsLeftToCartographer) {
  EXPECT_EQ(Difference("", TrajectoryState::ACTIVE), 0.) << "odometry counts";
  EXPECT_EQ(Difference(kLittleOdometry, TrajectoryState::FROZEN), 0.);
  LandmarkNode landmark;
  landmark.landmark_observations.push_back(
      {0, test::At(10.), transform::Rigid3d::Translation({0., 3., 1.}), 100.,
       100.});
  EXPECT_EQ(Difference(kLittleOdometry, TrajectoryState::ACTIVE,
                       {{"tree", landmark}}),
            0.);
  EXPECT_EQ(Difference(kLittleOdometry, TrajectoryState::ACTIVE, {},
                       {{test::At(0.), test::Planar(0., 0., 0.)},
                        {test::At(70.), test::Planar(1., 2., 0.)}}),
            0.);
}

TEST_F(RunningSolveTest, NodesThatNothingHoldsAreLeftToCartographer) {
  Problems problems = MakeProblems(kLittleOdometry);
  for (OptimizationProblem2D* const problem :
       {&problems.stock, &problems.early}) {
    Fill(problem);
    problem->AddTrajectoryNode(1, NodeSpec2D{test::At(0.),
                                             {},
                                             Rigid2d({3., 4.}, 0.),
                                             Eigen::Quaterniond::Identity()});
    problem->Solve(With(RightLoops()), active_, {});
  }
  EXPECT_EQ(LargestDifference(problems.stock, problems.early), 0.);
}

TEST_F(RunningSolveTest, TrimmedNodesLeaveAGap) {
  Problems problems = MakeProblems(kLittleOdometry);
  std::vector<Constraint> constraints;
  for (const Constraint& constraint : With(RightLoops())) {
    if (constraint.node_id.node_index != 33) constraints.push_back(constraint);
  }
  for (OptimizationProblem2D* const problem :
       {&problems.stock, &problems.early}) {
    Fill(problem);
    problem->TrimTrajectoryNode(NodeId{0, 33});
    problem->Solve(constraints, active_, {});
  }
  EXPECT_LT(LargestDifference(problems.stock, problems.early), 2. * kTolerance);
  EXPECT_LT(LargestError(problems.early), 0.5);
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
