// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/selection/switched_loops.h"

#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

TEST(SwitchedLoopsTest, KeepsTheLastAndCountsAll) {
  SwitchedLoopRecorder recorder;
  SwitchedLoop loop;
  loop.submap_index = 3;
  loop.node_trajectory = 1;
  loop.node_index = 41;
  loop.chi2 = 25.5;
  loop.by_odometry_check = true;
  recorder.Record(9, {loop}, 0.5, 2.);
  const SwitchedLoops loops = recorder.Get();
  EXPECT_EQ(loops.optimizations, 1);
  EXPECT_EQ(loops.loops, 9);
  EXPECT_EQ(SwitchedLoopsTable(loops),
            "submap_trajectory,submap,node_trajectory,node,chi2,reason\n"
            "0,3,1,41,25.5,odometry\n");
  recorder.Record(10, {}, 0.25, 1.);
  EXPECT_TRUE(recorder.Get().off.empty());
  EXPECT_DOUBLE_EQ(recorder.Get().selection_cpu_seconds, 0.75);
  EXPECT_DOUBLE_EQ(recorder.Get().solution_cpu_seconds, 3.);
  EXPECT_EQ(recorder.Get().optimizations, 2);
}

TEST(SwitchedLoopsTest, KeepsWhatWasPutInForceLast) {
  SwitchedLoopRecorder recorder;
  EXPECT_FALSE(recorder.Get().in_force.tried);
  recorder.Record(LoopsPutInForce{{40, 9}, {40, 1}, true, true});
  recorder.Record(7, {}, 0., 0.);
  EXPECT_EQ(recorder.Get().in_force.before.off, 9);
  EXPECT_EQ(recorder.Get().in_force.after.off, 1);
  EXPECT_TRUE(recorder.Get().in_force.relaxed);
}

TEST(SwitchedLoopsTest, ReadsItsOwnTable) {
  SwitchedLoop first, second;
  first.submap_index = 7;
  first.node_index = 120;
  first.chi2 = 40.25;
  second.submap_trajectory = 1;
  second.node_index = 3;
  second.by_odometry_check = true;
  SwitchedLoops loops;
  loops.off = {first, second};
  const auto parsed = ParseSwitchedLoopsTable(SwitchedLoopsTable(loops));
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  ASSERT_EQ(parsed->size(), 2u);
  EXPECT_EQ((*parsed)[0].submap_index, 7);
  EXPECT_EQ((*parsed)[0].node_index, 120);
  EXPECT_DOUBLE_EQ((*parsed)[0].chi2, 40.25);
  EXPECT_FALSE((*parsed)[0].by_odometry_check);
  EXPECT_EQ((*parsed)[1].submap_trajectory, 1);
  EXPECT_TRUE((*parsed)[1].by_odometry_check);
}

TEST(SwitchedLoopsTest, NamesTheBadLine) {
  EXPECT_FALSE(ParseSwitchedLoopsTable("").ok());
  EXPECT_FALSE(ParseSwitchedLoopsTable("submap,node\n").ok());
  const std::string heading = SwitchedLoopsTable(SwitchedLoops());
  EXPECT_TRUE(ParseSwitchedLoopsTable(heading)->empty());
  for (const char* line :
       {"0,1,2", "0,1,0,x,4.5,odometry", "0,1,0,2,4.5,because",
        "0,1,0,2,4.5,odometry,more"}) {
    const auto parsed = ParseSwitchedLoopsTable(heading + "\n" + line + "\n");
    ASSERT_FALSE(parsed.ok()) << line;
    EXPECT_NE(parsed.status().message().find("line 3"), std::string::npos);
  }
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
