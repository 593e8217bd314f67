// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/store_graph.h"

#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "gtest/gtest.h"
#include "tests/map/square_map.h"

namespace cartographer_ext {
namespace repair {
namespace {

TEST(StoreGraphTest, TheMapHasThePosesAndLoopsOfTheGraph) {
  test::SquareMap square;
  square.AddRightLoops();
  evaluation::MapGraph graph = evaluation::MakeMapGraph(square.pbstream);
  const int64_t loops = graph.num_loops();
  const size_t constraints = graph.constraints.size();
  ASSERT_GT(loops, 2);
  for (auto& node : graph.nodes) {
    node.second.global_pose = Pose2(1., 2., 0.3) * node.second.global_pose;
  }
  for (auto& submap : graph.submaps) {
    submap.second.global_pose = Pose2(1., 2., 0.3) * submap.second.global_pose;
  }
  // One loop less, and one elsewhere.
  for (size_t i = graph.constraints.size(); i-- > 0;) {
    if (!graph.constraints[i].is_loop) continue;
    graph.constraints.erase(graph.constraints.begin() + i);
    break;
  }
  for (auto& constraint : graph.constraints) {
    if (!constraint.is_loop) continue;
    constraint.relative_pose = constraint.relative_pose * Pose2(0.1, 0.2, 0.3);
    break;
  }
  StoreGraph(graph, &square.pbstream);
  const evaluation::MapGraph stored = evaluation::MakeMapGraph(square.pbstream);
  EXPECT_EQ(stored.num_loops(), loops - 1);
  ASSERT_EQ(stored.constraints.size(), constraints - 1);
  size_t matched = 0;
  for (const auto& constraint : graph.constraints) {
    if (!constraint.is_loop) continue;
    for (const auto& other : stored.constraints) {
      if (!other.is_loop || other.submap_id != constraint.submap_id ||
          other.node_id != constraint.node_id) {
        continue;
      }
      const Pose2 error =
          Between(constraint.relative_pose, other.relative_pose);
      EXPECT_LT(error.translation().norm() + std::abs(error.theta), 1e-9);
      ++matched;
    }
  }
  EXPECT_EQ(matched, static_cast<size_t>(loops - 1));
  for (const auto& node : graph.nodes) {
    const Pose2 error = Between(node.second.global_pose,
                                stored.nodes.at(node.first).global_pose);
    EXPECT_LT(error.translation().norm() + std::abs(error.theta), 1e-9);
  }
}

TEST(StoreGraphTest, MovesEverythingTogether) {
  test::SquareMap square;
  const evaluation::MapGraph before = evaluation::MakeMapGraph(square.pbstream);
  const Pose2 motion(-3., 5., 2.);
  MoveMap(motion, &square.pbstream);
  const evaluation::MapGraph after = evaluation::MakeMapGraph(square.pbstream);
  ASSERT_FALSE(before.nodes.empty());
  for (const auto& node : before.nodes) {
    const Pose2 error = Between(motion * node.second.global_pose,
                                after.nodes.at(node.first).global_pose);
    EXPECT_LT(error.translation().norm() + std::abs(error.theta), 1e-9);
  }
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
