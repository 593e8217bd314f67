// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// As the source is compiled into a Cartographer without the swap
// optimization_problem, beside the one with it.
#include "cartographer_ext/swaps.h"
#undef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#define InterTrajectoryLoops InterTrajectoryLoopsWithoutSwap
#include "cartographer_ext/loop_closure/dropin/inter_trajectory_loops.cc"
#undef InterTrajectoryLoops

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/warning_counter.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using Constraint = InterTrajectoryLoopsWithoutSwap::Constraint;

Constraint Loop(const SubmapId& submap_id, const NodeId& node_id) {
  return Constraint{submap_id,
                    node_id,
                    {cartographer::transform::Rigid3d::Identity(), 3., 5.},
                    Constraint::INTER_SUBMAP};
}

// The marks are made all the same: tools and a later build skip the loops.
TEST(InterTrajectoryLoopsWithoutSwapTest, WarnsThatWithdrawnLoopsStillAct) {
  InterTrajectoryLoopsWithoutSwap loops;
  loops.Add(Loop(SubmapId(0, 0), NodeId(1, 4)));
  loops.Add(Loop(SubmapId(0, 1), NodeId(1, 9)));
  PoseGraphContext context;
  std::vector<Constraint> marks;
  const test::WarningCounter warnings;
  loops.Withdraw(1, 0, 3, &context, &marks);
  EXPECT_EQ(warnings.count, 0) << "nothing was withdrawn";
  loops.Withdraw(1, 0, 4, &context, &marks);
  EXPECT_EQ(marks.size(), 1u);
  EXPECT_EQ(warnings.count, 1);
  EXPECT_THAT(
      warnings.last,
      ::testing::AllOf(
          ::testing::StartsWith("1 withdrawn loop constraints of trajectory 1"),
          ::testing::HasSubstr("without the swap optimization_problem"),
          ::testing::HasSubstr("cartographer_ext_optimize")));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
