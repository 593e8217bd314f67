// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps that Cartographer made, from the shared data.
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "cartographer/mapping/map_builder.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"
#include "tests/test_data.h"

namespace cartographer {
namespace mapping {
namespace {

using transform::Rigid3d;

std::unique_ptr<MapBuilderInterface> LoadMap(const std::string& filename,
                                             const bool frozen) {
  auto builder = CreateMapBuilder(
      test::LoadSlamOptions("MAP_BUILDER.num_background_threads = 1")
          .map_builder);
  EXPECT_EQ(builder->LoadStateFromFile(filename, frozen).size(), 1);
  return builder;
}

class StoredMapsTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string filename() const {
    return cartographer_ext::test::SharedData(std::string("pbstream/") +
                                              GetParam() + ".pbstream");
  }
};

INSTANTIATE_TEST_SUITE_P(Maps, StoredMapsTest,
                         ::testing::Values("AGV_NAV-map", "Racelien-map",
                                           "aces-made-by-cartographer",
                                           "aces-sound-by-cartographer",
                                           "csail-made-by-cartographer",
                                           "csail-sound-by-cartographer",
                                           "forzaeth-JFR_racingv6",
                                           "forzaeth-hangar", "legndy-map"));

TEST_P(StoredMapsTest, LoadsAndStores) {
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename());
  const auto builder = LoadMap(filename(), false);
  const proto::PoseGraph graph = builder->pose_graph()->ToProto(true);
  ASSERT_EQ(graph.trajectory_size(), 1);
  EXPECT_GE(graph.trajectory(0).node_size(), 500);
  EXPECT_GE(graph.trajectory(0).submap_size(), 4);
  const std::string copy = ::testing::TempDir() + GetParam() + "-copy.pbstream";
  ASSERT_TRUE(builder->SerializeStateToFile(true, copy));
  const auto again = LoadMap(copy, true);
  std::remove(copy.c_str());
  const proto::PoseGraph graph_again = again->pose_graph()->ToProto(true);
  EXPECT_EQ(graph_again.trajectory(0).submap_size(),
            graph.trajectory(0).submap_size());
  ASSERT_EQ(graph_again.trajectory(0).node_size(),
            graph.trajectory(0).node_size());
  for (int i = 0; i < graph.trajectory(0).node_size(); ++i) {
    EXPECT_EQ(graph.trajectory(0).node(i).SerializeAsString(),
              graph_again.trajectory(0).node(i).SerializeAsString());
  }
}

// Stored poses are an optimum of the stored constraints, so that optimising
// again should hardly move them.
class OptimizeStoredMapTest : public StoredMapsTest {};

INSTANTIATE_TEST_SUITE_P(Maps, OptimizeStoredMapTest,
                         ::testing::Values("csail-sound-by-cartographer",
                                           "aces-sound-by-cartographer",
                                           "csail-made-by-cartographer"));

TEST_P(OptimizeStoredMapTest, HardlyMoves) {
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename());
  // Weights of the runs that made the maps: they are not stored.
  const bool odometry_counts =
      std::string(GetParam()) == "csail-made-by-cartographer";
  const std::string weight = odometry_counts ? "1e3" : "0.";
  auto builder = CreateMapBuilder(
      test::LoadSlamOptions(
          "MAP_BUILDER.num_background_threads = 1\n"
          "POSE_GRAPH.optimization_problem.odometry_translation_weight = " +
          weight +
          "\nPOSE_GRAPH.optimization_problem.odometry_rotation_weight = " +
          weight)
          .map_builder);
  ASSERT_EQ(builder->LoadStateFromFile(filename(), false).size(), 1);
  const auto before = builder->pose_graph()->GetTrajectoryNodePoses();
  builder->pose_graph()->RunFinalOptimization();
  const auto after = builder->pose_graph()->GetTrajectoryNodePoses();
  ASSERT_EQ(before.size(), after.size());
  double largest_shift = 0.;
  double largest_turn = 0.;
  for (const auto& node : before) {
    const Rigid3d change =
        node.data.global_pose.inverse() * after.at(node.id).global_pose;
    largest_shift = std::max(largest_shift, change.translation().norm());
    largest_turn = std::max(largest_turn, transform::GetAngle(change));
  }
  EXPECT_LT(largest_shift, 0.01);
  EXPECT_LT(largest_turn, 0.1 * M_PI / 180.);
  RecordProperty("largest_shift", std::to_string(largest_shift));
  std::cout << GetParam() << ": " << largest_shift << " m, "
            << largest_turn * 180. / M_PI << " degrees\n";
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
