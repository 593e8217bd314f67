// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From a scan in local SLAM to the residual of the optimisation.
#include "cartographer_ext/front_end/dropin/node_weight_recorder.h"

#include <algorithm>
#include <string>
#include <vector>

#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/common/full_information.h"
#include "cartographer_ext/swaps.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace front_end {
namespace {

namespace mapping = cartographer::mapping;
using Constraint = mapping::PoseGraphInterface::Constraint;
using SensorId = mapping::TrajectoryBuilderInterface::SensorId;

struct Mapped {
  int within = 0;  // constraints between a node and a submap that it is part of
  size_t remembered = 0;
  std::vector<Eigen::Vector3d> nodes;  // where they lie
};

// A round through the room with loops that pull at a drifting map.
Mapped MapTheRoom(const std::string& lua) {
  ForgetFullInformation();
  const mapping::test::SlamOptions options = mapping::test::LoadSlamOptions(
      "TRAJECTORY_BUILDER_2D.submaps.num_range_data = 8\n"
      "MAP_BUILDER.num_background_threads = 1\n"
      "POSE_GRAPH.constraint_builder.log_matches = false\n"
      "POSE_GRAPH.constraint_builder.sampling_ratio = 0.5\n"
      "POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher = {\n"
      "  linear_search_window = 1.,\n"
      "  angular_search_window = math.rad(10.),\n"
      "  branch_and_bound_depth = 4,\n"
      "}\n"
      "POSE_GRAPH.optimize_every_n_nodes = 20\n" +
      lua);
  const auto builder = mapping::CreateMapBuilder(options.map_builder);
  const int trajectory_id = builder->AddTrajectoryBuilder(
      {SensorId{SensorId::SensorType::RANGE, "laser"}},
      options.trajectory_builder, nullptr);
  auto* const trajectory = builder->GetTrajectoryBuilder(trajectory_id);
  for (int i = 0; i < 60; ++i) {
    const auto pose = mapping::test::Drive(i / 60.);
    trajectory->AddSensorData(
        "laser", mapping::test::Scan(pose, mapping::test::At(0.3 * i)));
  }
  builder->FinishTrajectory(trajectory_id);
  builder->pose_graph()->RunFinalOptimization();
  Mapped mapped;
  mapped.remembered = CountFullInformation();
  for (const Constraint& constraint : builder->pose_graph()->constraints()) {
    mapped.within += constraint.tag == Constraint::INTRA_SUBMAP;
  }
  for (const auto& node : builder->pose_graph()->GetTrajectoryNodePoses()) {
    mapped.nodes.push_back(node.data.global_pose.translation());
  }
  ForgetFullInformation();
  return mapped;
}

#if defined(CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER) && \
    defined(CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION)
TEST(NodeWeightRecorderTest, WeakerConstraintsGiveWay) {
  const Mapped stiff =
      MapTheRoom("TRAJECTORY_BUILDER_2D.cartographer_ext = {}");
  EXPECT_GT(stiff.within, 30);
  EXPECT_EQ(stiff.remembered, 0u);
  for (const std::string form : {"full", "two_scalars"}) {
    const Mapped weak = MapTheRoom(
        "TRAJECTORY_BUILDER_2D.cartographer_ext = { node_weights = {\n"
        "  enabled = true, translation_sigma = 1e-4, rotation_sigma = 1e-5,\n"
        "  form = \"" +
        form + "\" } }\n");
    EXPECT_EQ(weak.within, stiff.within);
    EXPECT_EQ(weak.remembered, static_cast<size_t>(weak.within));
    ASSERT_EQ(weak.nodes.size(), stiff.nodes.size());
    // The pose graph has made the very constraints that were foreseen.
    double moved = 0.;
    for (size_t i = 0; i != stiff.nodes.size(); ++i) {
      moved = std::max(moved, (weak.nodes[i] - stiff.nodes[i]).norm());
    }
    EXPECT_GT(moved, 1e-5);
    EXPECT_LT(moved, 0.5);
  }
}

// No node is made surer than the constant weights: where all is known better,
// nothing changes but for rounding.
TEST(NodeWeightRecorderTest, WhatIsKnownWellKeepsItsWeight) {
  const Mapped stiff =
      MapTheRoom("TRAJECTORY_BUILDER_2D.cartographer_ext = {}");
  const Mapped same = MapTheRoom(
      "TRAJECTORY_BUILDER_2D.cartographer_ext = { node_weights = {\n"
      "  enabled = true, translation_sigma = 10., rotation_sigma = 3. } }\n");
  ASSERT_EQ(same.nodes.size(), stiff.nodes.size());
  for (size_t i = 0; i != stiff.nodes.size(); ++i) {
    EXPECT_LT((same.nodes[i] - stiff.nodes[i]).norm(), 1e-5);
  }
}
#endif

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
