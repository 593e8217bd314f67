// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/loop_withdrawer.h"

#include <set>
#include <vector>

#include "cartographer_ext/common/withdrawn_loops.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/warning_counter.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using Constraint = LoopWithdrawer::Constraint;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Constraint Loop(const SubmapId& submap_id, const NodeId& node_id) {
  return Constraint{submap_id,
                    node_id,
                    {cartographer::transform::Rigid3d::Identity(), 3., 5.},
                    Constraint::INTER_SUBMAP};
}

class LoopWithdrawerTest : public testing::Test {
 protected:
  // Adds an accepted loop.
  void Add(const SubmapId& submap_id, const NodeId& node_id) {
    withdrawer_.Add(Loop(submap_id, node_id), &context_, &constraints_);
  }
  // Withdraws those of run 1 with map 0.
  void WithdrawUpTo(const int last_node) {
    withdrawer_.Withdraw(1, 0, last_node, &context_, &constraints_);
  }
  void Withdraw(const SubmapId& submap_id, const NodeId& node_id) {
    withdrawer_.Withdraw(Loop(submap_id, node_id), &context_, &constraints_);
  }
  std::set<LoopId> Unmarked() { return context_.Get<WithdrawnLoops>()->All(); }

  LoopWithdrawer withdrawer_;
  PoseGraphContext context_;
  std::vector<Constraint> constraints_;
};

TEST_F(LoopWithdrawerTest, MarksTheLoopsOfOneRunWithOneMap) {
  Add(SubmapId(0, 0), NodeId(1, 4));
  Add(SubmapId(0, 1), NodeId(1, 7));
  Add(SubmapId(0, 2), NodeId(1, 8));  // after it was lost
  Add(SubmapId(1, 0), NodeId(1, 3));  // within the run
  Add(SubmapId(2, 0), NodeId(1, 2));  // with another map
  Add(SubmapId(0, 0), NodeId(3, 1));  // of another run
  EXPECT_THAT(constraints_, IsEmpty());
  const test::WarningCounter warnings;
  WithdrawUpTo(7);
  ASSERT_THAT(constraints_, SizeIs(2));
  EXPECT_EQ(constraints_[0].submap_id, SubmapId(0, 0));
  EXPECT_EQ(constraints_[0].node_id, NodeId(1, 4));
  EXPECT_EQ(constraints_[1].node_id, NodeId(1, 7));
  for (const Constraint& mark : constraints_) {
    EXPECT_EQ(mark.tag, Constraint::INTER_SUBMAP);
    EXPECT_EQ(mark.pose.translation_weight, 0.);
    EXPECT_EQ(mark.pose.rotation_weight, 0.);
  }
  EXPECT_THAT(Unmarked(), IsEmpty());
  // The swap skips them, so there is nothing to warn of.
  EXPECT_EQ(warnings.count, 0);
  // Once is enough.
  constraints_.clear();
  WithdrawUpTo(7);
  EXPECT_THAT(constraints_, IsEmpty());
}

// A mark of a node that is gone would be fatal in the pose graph.
TEST_F(LoopWithdrawerTest, LoopsOfTrimmedNodesGoToTheContext) {
  Add(SubmapId(0, 0), NodeId(1, 4));
  Add(SubmapId(0, 0), NodeId(1, 6));
  withdrawer_.DeleteSubmap(SubmapId(1, 0), 5, &context_);
  WithdrawUpTo(10);
  ASSERT_THAT(constraints_, SizeIs(1));
  EXPECT_EQ(constraints_[0].node_id, NodeId(1, 6));
  ASSERT_THAT(Unmarked(), SizeIs(1));
  EXPECT_EQ(Unmarked().begin()->node_index, 4);
}

// Of a node deleted with its second submap nothing has to be withdrawn.
TEST_F(LoopWithdrawerTest, ForgetsWhatThePoseGraphDeletes) {
  Add(SubmapId(0, 0), NodeId(1, 4));
  Add(SubmapId(0, 1), NodeId(1, 40));
  Add(SubmapId(0, 2), NodeId(1, 41));
  for (int i = 0; i != 4; ++i) {
    withdrawer_.DeleteSubmap(SubmapId(1, i), 5 + i, &context_);
  }
  withdrawer_.DeleteSubmap(SubmapId(0, 1), -1, &context_);
  WithdrawUpTo(50);
  ASSERT_THAT(constraints_, SizeIs(1));
  EXPECT_EQ(constraints_[0].node_id, NodeId(1, 41));
  EXPECT_THAT(Unmarked(), IsEmpty());

  Add(SubmapId(0, 3), NodeId(1, 60));
  withdrawer_.DeleteTrajectory(1);
  constraints_.clear();
  WithdrawUpTo(100);
  EXPECT_THAT(constraints_, IsEmpty());
}

// Whether or not they were added.
TEST_F(LoopWithdrawerTest, WithdrawsSingleLoopsWithinATrajectory) {
  withdrawer_.DeleteSubmap(SubmapId(0, 0), 5, &context_);
  Withdraw(SubmapId(0, 3), NodeId(0, 60));
  ASSERT_THAT(constraints_, SizeIs(1));
  EXPECT_EQ(constraints_[0].submap_id, SubmapId(0, 3));
  EXPECT_EQ(constraints_[0].node_id, NodeId(0, 60));
  EXPECT_EQ(constraints_[0].pose.translation_weight, 0.);
  EXPECT_EQ(constraints_[0].pose.rotation_weight, 0.);
  EXPECT_EQ(constraints_[0].tag, Constraint::INTER_SUBMAP);
  Withdraw(SubmapId(0, 3), NodeId(0, 4));
  EXPECT_THAT(constraints_, SizeIs(1));
  EXPECT_THAT(Unmarked(), SizeIs(1));
}

// Nodes 4 and 60, of which the first may have been trimmed.
TEST_F(LoopWithdrawerTest, LoopsThatAreAcceptedAgainCountOnce) {
  withdrawer_.DeleteSubmap(SubmapId(0, 0), 5, &context_);
  for (const int node : {4, 60}) {
    const SubmapId submap(0, 3);
    constraints_.clear();
    for (int i = 0; i < 2; ++i) {
      if (i > 0) Withdraw(submap, NodeId(0, node));
      Add(submap, NodeId(0, node));
      constraints_.push_back(Loop(submap, NodeId(0, node)));
    }
    // The first time, the mark, and again.
    EXPECT_THAT(constraints_, SizeIs(3));
    EXPECT_THAT(FindWithdrawnLoops(constraints_, DescribeConstraint<Constraint>,
                                   Unmarked()),
                ElementsAre(0, 1));
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
