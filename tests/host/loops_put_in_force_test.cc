// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops that are put in force at the end of a run, inside the host.
#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/common/withdrawn_loops.h"
#include "gtest/gtest.h"
#include "tests/host/square_walk.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

constexpr char kPutInForce[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
    "  robust_loops = false, odometry_check = false }";
constexpr char kNotPutInForce[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
    "  robust_loops = false, odometry_check = false,\n"
    "  loops_in_force = false }";

class LoopsPutInForceTest : public SquareWalkTest {
 protected:
  // A whole run with its final optimisation.
  void RunToTheEnd(
      const std::vector<Constraint>& loops,
      OptimizationProblem2D* const problem,
      const std::map<std::string, PoseGraphInterface::LandmarkNode>& landmarks =
          {}) const {
    Fill(problem);
    problem->SetMaxNumIterations(200);
    problem->Solve(With(loops), active_, landmarks);
  }
};

TEST_F(LoopsPutInForceTest, LoopsArePutInForceAtTheEnd) {
  SetShareWrong(0.1);
  SlipBefore(56);
  OptimizationProblem2D stock = MakeProblem(kNotPutInForce),
                        robust = MakeProblem(kPutInForce);
  for (OptimizationProblem2D* const problem : {&stock, &robust}) {
    Fill(problem);
    problem->Solve(With(AllRightLoops()), active_, {});
  }
  // During the run the problem is Cartographer's.
  EXPECT_EQ(LargestDifference(stock, robust), 0.);
  for (OptimizationProblem2D* const problem : {&stock, &robust}) {
    problem->SetMaxNumIterations(200);
    problem->Solve(With(AllRightLoops()), active_, {});
  }
  // Most of the metre is left in the map.
  EXPECT_GT(LargestError(stock), 0.7);
  EXPECT_LT(LargestError(robust), 0.4);
  // The step took nearly all, its neighbours kept their length.
  EXPECT_LT(StepLength(stock, 55), 0.3);
  EXPECT_GT(StepLength(robust, 55), 0.8);
  EXPECT_NEAR(StepLength(robust, 53), 1., 0.02);
  EXPECT_NEAR(StepLength(robust, 58), 1., 0.02);
}

TEST_F(LoopsPutInForceTest, LoopsThatContradictAreNotPutInForce) {
  SetShareWrong(0.1);
  SlipBefore(56);
  std::vector<Constraint> loops = AllRightLoops();
  // Those of every second node are a metre and a half to the side.
  for (size_t i = 0; i < loops.size(); ++i) {
    if (i % 8 < 4) continue;
    loops[i].pose.zbar_ij =
        transform::Rigid3d::Translation({0., 1.5, 0.}) * loops[i].pose.zbar_ij;
  }
  OptimizationProblem2D stock = MakeProblem(kNotPutInForce),
                        robust = MakeProblem(kPutInForce);
  for (OptimizationProblem2D* const problem : {&stock, &robust}) {
    RunToTheEnd(loops, problem);
  }
  // Solved again as it was.
  EXPECT_LT(LargestDifference(stock, robust), 0.01);
}

TEST_F(LoopsPutInForceTest, AmbiguousLoopsAreNotPutInForce) {
  SlipBefore(56);
  OptimizationProblem2D stock = MakeProblem(kNotPutInForce),
                        unknown = MakeProblem(kPutInForce),
                        ambiguous = MakeProblem(kPutInForce);
  for (OptimizationProblem2D* const problem : {&stock, &unknown, &ambiguous}) {
    if (problem == &ambiguous) SetShareWrong(0.5);
    RunToTheEnd(AllRightLoops(), problem);
  }
  EXPECT_EQ(LargestDifference(stock, unknown), 0.);
  EXPECT_EQ(LargestDifference(stock, ambiguous), 0.);
}

// One of 81 that nearly all others contradict: the map is the same as without it,
// and it is known which it was.
TEST_F(LoopsPutInForceTest, ALoopThatTheFinishedMapContradictsIsTakenBack) {
  std::vector<Constraint> loops = AllRightLoops();
  OptimizationProblem2D without = MakeProblem(kPutInForce),
                        with = MakeProblem(kPutInForce);
  RunToTheEnd(loops, &without);
  EXPECT_TRUE(LastSwitchedLoops().taken_back.empty());
  ASSERT_GT(loops.size(), 20u);
  loops.push_back(WrongLoops().front());
  Fill(&with);
  with.Solve(With(loops), active_, {});
  EXPECT_TRUE(LastSwitchedLoops().taken_back.empty());  // not during the run
  with.SetMaxNumIterations(200);
  with.Solve(With(loops), active_, {});
  EXPECT_LT(LargestDifference(without, with), 0.02);
  const auto taken_back = LastSwitchedLoops().taken_back;
  ASSERT_EQ(taken_back.size(), 1u);
  EXPECT_EQ(taken_back.begin()->node_index,
            WrongLoops().front().node_id.node_index);
  // Nor does it count from now on.
  EXPECT_EQ(context_->Get<cartographer_ext::WithdrawnLoops>()->All(),
            taken_back);
}

TEST_F(LoopsPutInForceTest, LandmarksKeepTheProblem) {
  SetShareWrong(0.1);
  SlipBefore(56);
  OptimizationProblem2D stock = MakeProblem(kNotPutInForce),
                        robust = MakeProblem(kPutInForce);
  for (OptimizationProblem2D* const problem : {&stock, &robust}) {
    RunToTheEnd(AllRightLoops(), problem,
                {{"unseen", PoseGraphInterface::LandmarkNode()}});
  }
  EXPECT_EQ(LargestDifference(stock, robust), 0.);
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
