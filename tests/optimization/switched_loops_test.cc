// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/switched_loops.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

TEST(SwitchedLoopsTest, KeepsTheLastAndCountsAll) {
  const int64_t before = LastSwitchedLoops().optimizations;
  SwitchedLoop loop;
  loop.submap_index = 3;
  loop.node_trajectory = 1;
  loop.node_index = 41;
  loop.chi2 = 25.5;
  loop.by_odometry_check = true;
  PublishSwitchedLoops(9, {loop}, 0.5);
  const SwitchedLoops loops = LastSwitchedLoops();
  EXPECT_EQ(loops.optimizations, before + 1);
  EXPECT_EQ(loops.loops, 9);
  EXPECT_EQ(SwitchedLoopsTable(loops),
            "submap_trajectory,submap,node_trajectory,node,chi2,reason\n"
            "0,3,1,41,25.5,odometry\n");
  PublishSwitchedLoops(10, {}, 0.25);
  EXPECT_TRUE(LastSwitchedLoops().off.empty());
  EXPECT_GE(LastSwitchedLoops().selection_cpu_seconds, 0.75);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
