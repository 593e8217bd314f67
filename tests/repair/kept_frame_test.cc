// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/kept_frame.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace repair {
namespace {

evaluation::MapGraph Path(const Pose2& frame) {
  evaluation::MapGraph graph;
  for (int i = 0; i < 50; ++i) {
    auto& node = graph.nodes[{0, i}];
    node.time = i * 1000000000LL;
    node.global_pose = frame * Pose2(0.3 * i, std::sin(0.3 * i), 0.02 * i);
  }
  return graph;
}

TEST(KeptFrameTest, UnmovedNodesStayWhereTheyWere) {
  const evaluation::MapGraph before = Path(Pose2());
  // The repair has moved the first fifteen nodes and has another frame.
  const Pose2 frame(2., -1., 0.8);
  evaluation::MapGraph after = Path(frame);
  for (int i = 0; i < 15; ++i) {
    after.nodes[{0, i}].global_pose =
        frame * Pose2(1., 3., 0.4) * before.nodes.at({0, i}).global_pose;
  }
  const Pose2 by_nodes = OldFromNewByNodes(before, after);
  const Pose2 moved = by_nodes * after.nodes.at({0, 40}).global_pose;
  const Pose2 error = Between(before.nodes.at({0, 40}).global_pose, moved);
  EXPECT_LT(error.translation().norm(), 1e-6);
  EXPECT_LT(std::abs(error.theta), 1e-6);
  const Pose2 by_start = OldFromNewByStart(before, after);
  const Pose2 first = by_start * after.nodes.at({0, 0}).global_pose;
  EXPECT_LT(first.translation().norm(), 1e-9);
}

TEST(KeptFrameTest, TheTableHasBothPosesOfEachNode) {
  const std::string table = PoseTable(Path(Pose2()), Path(Pose2(1., 2., 0.)));
  EXPECT_THAT(table, testing::StartsWith("trajectory_id,node_index,time,old_x,"
                                         "old_y,old_theta,new_x,new_y,"
                                         "new_theta\n0,0,0.000000,0.000000,"
                                         "0.000000,0.000000,1.000000,2.000000,"
                                         "0.000000\n"));
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
