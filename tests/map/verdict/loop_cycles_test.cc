// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/loop_cycles.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// Nodes half a metre apart; submaps 0 and 1 with known places in the local
// frame, and loops that agree with a drifted revisit: the whole piece lies at
// (7, 0, 0.1) in the frame of submap 0.
MapGraph Revisit(const int num_loops) {
  MapGraph graph;
  graph.submaps[{0, 0}].local_pose = Pose2(1., 2., 0.);
  graph.submaps[{0, 1}].local_pose = Pose2(3., 2., 0.4);
  const Pose2 piece(7., 0., 0.1);
  for (int i = 0; i < num_loops; ++i) {
    GraphNode node;
    node.local_pose = Pose2(0.5 * i, 0., 0.05 * i);
    graph.nodes[{0, 100 + i}] = node;
    GraphConstraint loop;
    loop.is_loop = true;
    loop.submap_id = {0, i % 2};
    loop.node_id = {0, 100 + i};
    const Pose2 in_first = piece * node.local_pose;
    loop.relative_pose = i % 2 == 0
                             ? in_first
                             : Between(graph.submaps[{0, 1}].local_pose,
                                       graph.submaps[{0, 0}].local_pose) *
                                   in_first;
    graph.constraints.push_back(loop);
  }
  return graph;
}

TEST(LoopCyclesTest, AgreeingLoopsClose) {
  const LoopCycles cycles = ComputeLoopCycles(Revisit(6), {});
  EXPECT_EQ(cycles.cycles, 15);
  EXPECT_EQ(cycles.inconsistent, 0);
  EXPECT_LT(cycles.translation.max, 1e-9);
  EXPECT_LT(cycles.rotation_degrees.max, 1e-9);
  EXPECT_EQ(cycles.partners[0], 5);
}

TEST(LoopCyclesTest, TheWrongLoopHasTheResidual) {
  MapGraph graph = Revisit(6);
  graph.constraints[2].relative_pose =
      Pose2(1., 0., 0.) * graph.constraints[2].relative_pose;
  const LoopCycles cycles = ComputeLoopCycles(graph, {});
  EXPECT_EQ(cycles.inconsistent, 5);
  EXPECT_DOUBLE_EQ(cycles.inconsistent_fraction[2], 1.);
  EXPECT_DOUBLE_EQ(cycles.inconsistent_fraction[0], 0.2);
  EXPECT_NEAR(cycles.translation.max, 1., 1e-9);
  EXPECT_NEAR(cycles.fraction(), 1. / 3., 1e-12);
}

TEST(LoopCyclesTest, LongPiecesAreNotUsed) {
  LoopCycleOptions options;
  options.max_metres = 0.6;  // only neighbours
  EXPECT_EQ(ComputeLoopCycles(Revisit(6), options).cycles, 5);
  options.max_metres = 100.;
  options.max_submap_gap = 0;
  EXPECT_EQ(ComputeLoopCycles(Revisit(6), options).cycles, 6);
}

TEST(LoopCyclesTest, SingleLoopHasNoCycle) {
  const LoopCycles cycles = ComputeLoopCycles(Revisit(1), {});
  EXPECT_EQ(cycles.cycles, 0);
  EXPECT_EQ(cycles.fraction(), 0.);
  ASSERT_EQ(cycles.partners.size(), 1u);
  EXPECT_EQ(cycles.partners[0], 0);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
