// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// As the source is compiled into a Cartographer without the swap
// optimization_problem, beside the one with it.
#include "cartographer_ext/swaps.h"
#undef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#define LoopWithdrawer LoopWithdrawerWithoutSwap
#include "cartographer_ext/loop_closure/dropin/loop_withdrawer.cc"
#undef LoopWithdrawer

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/warning_counter.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using Constraint = LoopWithdrawerWithoutSwap::Constraint;
using ::testing::AllOf;
using ::testing::HasSubstr;

Constraint Loop(const SubmapId& submap_id, const NodeId& node_id) {
  return Constraint{submap_id,
                    node_id,
                    {cartographer::transform::Rigid3d::Identity(), 3., 5.},
                    Constraint::INTER_SUBMAP};
}

// The marks are made all the same: tools and a later build skip the loops.
TEST(LoopWithdrawerWithoutSwapTest, WarnsThatWithdrawnLoopsStillAct) {
  LoopWithdrawerWithoutSwap withdrawer;
  PoseGraphContext context;
  std::vector<Constraint> marks;
  withdrawer.Add(Loop(SubmapId(0, 0), NodeId(1, 4)), &context, &marks);
  withdrawer.Add(Loop(SubmapId(0, 1), NodeId(1, 9)), &context, &marks);
  const test::WarningCounter warnings;
  withdrawer.Withdraw(1, 0, 3, &context, &marks);
  EXPECT_EQ(warnings.count, 0) << "nothing was withdrawn";
  withdrawer.Withdraw(1, 0, 4, &context, &marks);
  EXPECT_EQ(marks.size(), 1u);
  EXPECT_EQ(warnings.count, 1);
  EXPECT_THAT(warnings.last,
              AllOf(HasSubstr("still act: 1 of trajectory 1 with the map of "
                              "trajectory 0."),
                    HasSubstr("without the swap optimization_problem"),
                    HasSubstr("cartographer_ext_optimize")));
}

// Once per trajectory.
TEST(LoopWithdrawerWithoutSwapTest, WarnsOfLoopsWithinATrajectory) {
  LoopWithdrawerWithoutSwap withdrawer;
  PoseGraphContext context;
  std::vector<Constraint> marks;
  const test::WarningCounter warnings;
  for (const int trajectory_id : {0, 2}) {
    for (const int node : {40, 41}) {
      withdrawer.Withdraw(
          Loop(SubmapId(trajectory_id, 3), NodeId(trajectory_id, node)),
          &context, &marks);
    }
    EXPECT_EQ(warnings.count, trajectory_id == 0 ? 1 : 2);
    EXPECT_THAT(warnings.last,
                HasSubstr(absl::StrCat("still act: some within trajectory ",
                                       trajectory_id, " ")));
  }
  EXPECT_EQ(marks.size(), 4u);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
