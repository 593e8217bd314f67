// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/node_history.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

HistoryNode Node(int index, double x) {
  HistoryNode node;
  node.node_index = index;
  node.local_pose = Pose2(x, 0., 0.);
  return node;
}

std::vector<int> Indices(const std::vector<const HistoryNode*>& sequence) {
  std::vector<int> indices;
  for (const HistoryNode* node : sequence) indices.push_back(node->node_index);
  return indices;
}

TEST(NodeHistoryTest, SequenceIsSpacedByTravelledDistance) {
  NodeHistory history(100);
  for (int i = 0; i < 10; ++i) history.Add(0, Node(i, 0.25 * i));
  EXPECT_THAT(Indices(history.Sequence(0, 9, 4, 0.5, 100)),
              ElementsAre(3, 5, 7, 9));
  EXPECT_THAT(Indices(history.Sequence(0, 9, 2, 0., 100)), ElementsAre(8, 9));
  EXPECT_THAT(Indices(history.Sequence(0, 3, 10, 0.6, 100)), ElementsAre(0, 3));
  EXPECT_THAT(Indices(history.Sequence(0, 9, 10, 0.5, 3)), ElementsAre(7, 9));
  EXPECT_THAT(history.Sequence(0, 10, 4, 0.5, 100), IsEmpty());
  EXPECT_THAT(history.Sequence(1, 9, 4, 0.5, 100), IsEmpty());
  EXPECT_THAT(history.Sequence(0, 9, 0, 0.5, 100), IsEmpty());
}

TEST(NodeHistoryTest, TravelCountsTheWayNotTheDisplacement) {
  NodeHistory history(100);
  // Forth and back: 0, 1, 0.
  history.Add(0, Node(0, 0.));
  history.Add(0, Node(1, 1.));
  history.Add(0, Node(2, 0.));
  EXPECT_THAT(Indices(history.Sequence(0, 2, 2, 1.5, 100)), ElementsAre(0, 2));
}

TEST(NodeHistoryTest, OrderOfAddingDoesNotMatter) {
  NodeHistory history(100);
  for (const int i : {4, 0, 2, 3, 1}) EXPECT_TRUE(history.Add(0, Node(i, i)));
  EXPECT_FALSE(history.Add(0, Node(3, 77.)));
  EXPECT_EQ(history.Find(0, 3)->local_pose.x, 3.);
  EXPECT_THAT(Indices(history.Sequence(0, 4, 9, 1., 100)),
              ElementsAre(0, 1, 2, 3, 4));
}

TEST(NodeHistoryTest, IsBoundedPerTrajectory) {
  NodeHistory history(3);
  for (int i = 0; i < 10; ++i) history.Add(0, Node(i, i));
  history.Add(1, Node(0, 0.));
  EXPECT_EQ(history.size(0), 3);
  EXPECT_EQ(history.size(1), 1);
  EXPECT_EQ(history.size(2), 0);
  EXPECT_FALSE(history.Contains(0, 6));
  EXPECT_TRUE(history.Contains(0, 7));
  EXPECT_FALSE(history.Add(0, Node(2, 2.)));
  EXPECT_EQ(history.size(0), 3);
  history.DeleteTrajectory(0);
  EXPECT_EQ(history.Find(0, 9), nullptr);
  EXPECT_TRUE(history.Contains(1, 0));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
