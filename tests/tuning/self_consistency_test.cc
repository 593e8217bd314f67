// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/self_consistency.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

TEST(SelfConsistencyTest, EntropyOfKnownCells) {
  io::OccupancyMap map = io::OccupancyMap::Make(2, 2, 0.05, Pose2());
  EXPECT_EQ(ComputeSelfConsistency({}, map).map_entropy, 0.);
  map.at(0, 0) = 0.5f;  // 1 bit
  map.at(1, 0) = 1.f;   // sure
  EXPECT_NEAR(ComputeSelfConsistency({}, map).map_entropy, 0.5, 1e-9);
  map.at(0, 1) = 0.25f;  // 0.811278 bits
  EXPECT_NEAR(ComputeSelfConsistency({}, map).map_entropy, 1.811278 / 3., 1e-6);
}

TEST(SelfConsistencyTest, ResidualsAndBending) {
  evaluation::MapGraph graph;
  graph.submaps[{0, 0}];
  evaluation::GraphNode node;
  graph.nodes[{0, 0}] = node;
  node.local_pose = Pose2(2., 0., 0.);
  node.global_pose = Pose2(2.1, 0., 0.);
  graph.nodes[{0, 1}] = node;
  // Another trajectory is no neighbour.
  node.local_pose = Pose2(50., 0., 0.);
  graph.nodes[{1, 0}] = node;
  evaluation::GraphConstraint loop;
  loop.node_id = {0, 1};
  loop.relative_pose = Pose2(2.1, 0.3, 0.);
  loop.is_loop = true;
  graph.constraints.push_back(loop);
  loop.is_loop = false;
  loop.relative_pose = Pose2(9., 9., 0.);
  graph.constraints.push_back(loop);
  const SelfConsistency result =
      ComputeSelfConsistency(graph, io::OccupancyMap());
  EXPECT_NEAR(result.loop_residual, 0.3, 1e-9);
  EXPECT_NEAR(result.bending, 0.1 / 2., 1e-9);
  EXPECT_NEAR(result.Total(), 3. + 5., 1e-6);
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
