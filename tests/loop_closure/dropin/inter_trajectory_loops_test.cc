// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/inter_trajectory_loops.h"

#include <set>
#include <vector>

#include "cartographer_ext/common/withdrawn_loops.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/warning_counter.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using Constraint = InterTrajectoryLoops::Constraint;

Constraint Loop(const SubmapId& submap_id, const NodeId& node_id) {
  return Constraint{submap_id,
                    node_id,
                    {cartographer::transform::Rigid3d::Identity(), 3., 5.},
                    Constraint::INTER_SUBMAP};
}

TEST(InterTrajectoryLoopsTest, MarksTheLoopsOfOneRunWithOneMap) {
  InterTrajectoryLoops loops;
  loops.Add(Loop(SubmapId(0, 0), NodeId(1, 4)));
  loops.Add(Loop(SubmapId(0, 1), NodeId(1, 7)));
  loops.Add(Loop(SubmapId(0, 2), NodeId(1, 8)));  // after it was lost
  loops.Add(Loop(SubmapId(1, 0), NodeId(1, 3)));  // within the run
  loops.Add(Loop(SubmapId(2, 0), NodeId(1, 2)));  // with another map
  loops.Add(Loop(SubmapId(0, 0), NodeId(3, 1)));  // of another run
  PoseGraphContext context;
  std::vector<Constraint> marks;
  const test::WarningCounter warnings;
  loops.Withdraw(1, 0, 7, &context, &marks);
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].submap_id, SubmapId(0, 0));
  EXPECT_EQ(marks[0].node_id, NodeId(1, 4));
  EXPECT_EQ(marks[1].node_id, NodeId(1, 7));
  for (const Constraint& mark : marks) {
    EXPECT_EQ(mark.tag, Constraint::INTER_SUBMAP);
    EXPECT_EQ(mark.pose.translation_weight, 0.);
    EXPECT_EQ(mark.pose.rotation_weight, 0.);
  }
  EXPECT_TRUE(context.Get<WithdrawnLoops>()->All().empty());
  // The swap skips them, so there is nothing to warn of.
  EXPECT_EQ(warnings.count, 0);
  // Once is enough.
  marks.clear();
  loops.Withdraw(1, 0, 7, &context, &marks);
  EXPECT_TRUE(marks.empty());
}

// A mark of a node that is gone would be fatal in the pose graph.
TEST(InterTrajectoryLoopsTest, LoopsOfTrimmedNodesGoToTheContext) {
  InterTrajectoryLoops loops;
  loops.Add(Loop(SubmapId(0, 0), NodeId(1, 4)));
  loops.Add(Loop(SubmapId(0, 0), NodeId(1, 6)));
  PoseGraphContext context;
  loops.DeleteSubmap(SubmapId(1, 0), 5, &context);
  std::vector<Constraint> marks;
  loops.Withdraw(1, 0, 10, &context, &marks);
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0].node_id, NodeId(1, 6));
  const std::set<LoopId> unmarked = context.Get<WithdrawnLoops>()->All();
  ASSERT_EQ(unmarked.size(), 1u);
  EXPECT_EQ(unmarked.begin()->node_index, 4);
}

// Of a node deleted with its second submap nothing has to be withdrawn.
TEST(InterTrajectoryLoopsTest, ForgetsWhatThePoseGraphDeletes) {
  InterTrajectoryLoops loops;
  loops.Add(Loop(SubmapId(0, 0), NodeId(1, 4)));
  loops.Add(Loop(SubmapId(0, 1), NodeId(1, 40)));
  loops.Add(Loop(SubmapId(0, 2), NodeId(1, 41)));
  PoseGraphContext context;
  for (int i = 0; i != 4; ++i) {
    loops.DeleteSubmap(SubmapId(1, i), 5 + i, &context);
  }
  loops.DeleteSubmap(SubmapId(0, 1), -1, &context);
  std::vector<Constraint> marks;
  loops.Withdraw(1, 0, 50, &context, &marks);
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0].node_id, NodeId(1, 41));
  EXPECT_TRUE(context.Get<WithdrawnLoops>()->All().empty());

  loops.Add(Loop(SubmapId(0, 3), NodeId(1, 60)));
  loops.DeleteTrajectory(1);
  marks.clear();
  loops.Withdraw(1, 0, 100, &context, &marks);
  EXPECT_TRUE(marks.empty());
}

// Of any trajectory, whether or not it was added.
TEST(InterTrajectoryLoopsTest, WithdrawsSingleLoops) {
  InterTrajectoryLoops loops;
  PoseGraphContext context;
  loops.DeleteSubmap(SubmapId(0, 0), 5, &context);
  std::vector<Constraint> marks;
  loops.Withdraw(Loop(SubmapId(0, 3), NodeId(0, 60)), &context, &marks);
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0].submap_id, SubmapId(0, 3));
  EXPECT_EQ(marks[0].node_id, NodeId(0, 60));
  EXPECT_EQ(marks[0].pose.translation_weight, 0.);
  EXPECT_EQ(marks[0].pose.rotation_weight, 0.);
  EXPECT_EQ(marks[0].tag, Constraint::INTER_SUBMAP);
  loops.Withdraw(Loop(SubmapId(0, 3), NodeId(0, 4)), &context, &marks);
  EXPECT_EQ(marks.size(), 1u);
  EXPECT_EQ(context.Get<WithdrawnLoops>()->All().size(), 1u);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
