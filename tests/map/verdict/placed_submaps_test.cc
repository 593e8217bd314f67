// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/placed_submaps.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(PlacedSubmapsTest, OneVisitEndsWhereTheRobotHasComeBack) {
  EXPECT_TRUE(IsOneVisit(20., 20., 2.));
  EXPECT_TRUE(IsOneVisit(3.9, 0., 2.));
  EXPECT_FALSE(IsOneVisit(4., 0., 2.));
  EXPECT_FALSE(IsOneVisit(50., 20., 2.));
}

// Ten metres out and back.
TEST(PlacedSubmapsTest, ThePathIsThatOfLocalSlam) {
  MapGraph graph;
  for (int i = 0; i <= 20; ++i) {
    for (const int trajectory_id : {0, 1}) {
      GraphNode node;
      node.local_pose = Pose2(i <= 10 ? i : 20 - i, 0., 0.);
      graph.nodes[{trajectory_id, i}] = node;
    }
  }
  const TravelledPath path(graph);
  EXPECT_TRUE(path.AreOneVisit({0, 0}, {0, 10}, 10., 2.));
  EXPECT_TRUE(path.AreOneVisit({0, 10}, {0, 0}, 10., 2.));
  EXPECT_FALSE(path.AreOneVisit({0, 0}, {0, 20}, 0., 2.));
  EXPECT_TRUE(path.AreOneVisit({1, 0}, {1, 10}, 10., 2.));
  EXPECT_FALSE(path.AreOneVisit({0, 0}, {1, 0}, 0., 2.));
  EXPECT_FALSE(path.AreOneVisit({0, 0}, {0, 30}, 0., 2.));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
