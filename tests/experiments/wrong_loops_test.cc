// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/wrong_loops.h"

#include <cmath>
#include <vector>

#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/switched_constraints.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "gmock/gmock.h"
#include "tests/map/square_map.h"
#include "tests/slam/room_source.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using test::SquareMap;
using ::testing::HasSubstr;

TEST(WrongLoopsTest, ClaimTheSamePlaceOfWhatIsFarApart) {
  const MapGraph map = MakeMapGraph(SquareMap().pbstream);
  const WrongLoopOptions options;
  Random random(3);
  double squares = 0., squared_angles = 0.;
  constexpr int kDraws = 2000;
  for (int k = 0; k != kDraws; ++k) {
    const auto loop = MakeWrongLoop(map, options, &random);
    ASSERT_TRUE(loop.ok()) << loop.status();
    EXPECT_TRUE(loop->is_loop);
    EXPECT_LE(loop->submap_id.index, 5);  // the last two may still grow
    EXPECT_GE((map.submaps.at(loop->submap_id).local_pose.translation() -
               map.nodes.at(loop->node_id).local_pose.translation())
                  .norm(),
              3.);
    squares += loop->relative_pose.translation().squaredNorm();
    squared_angles += loop->relative_pose.theta * loop->relative_pose.theta;
  }
  EXPECT_NEAR(std::sqrt(squares / (2 * kDraws)), 0.3, 0.01);
  EXPECT_NEAR(std::sqrt(squared_angles / kDraws), 10. * kPi / 180., 0.006);
}

TEST(WrongLoopsTest, GoToTheEndWithTheWeightsOfTheMap) {
  SquareMap map;
  map.AddRightLoops();
  for (int i = 0; i != map.pbstream.pose_graph.constraint_size(); ++i) {
    auto* const constraint = map.pbstream.pose_graph.mutable_constraint(i);
    if (constraint->translation_weight() > 1e4) {
      constraint->set_translation_weight(7e3);
      constraint->set_rotation_weight(2e4);
    }
  }
  const int before = map.pbstream.pose_graph.constraint_size();
  WrongLoopOptions options;
  options.count = 3;
  options.seed = 5;
  io::Pbstream again = map.pbstream, other = map.pbstream;
  const auto indices = AddWrongLoops(options, &map.pbstream);
  ASSERT_TRUE(indices.ok()) << indices.status();
  EXPECT_THAT(*indices, testing::ElementsAre(before, before + 1, before + 2));
  const MapGraph graph = MakeMapGraph(map.pbstream);
  for (const int index : *indices) {
    EXPECT_TRUE(graph.constraints[index].is_loop);
    EXPECT_EQ(graph.constraints[index].translation_weight, 7e3);
    EXPECT_EQ(graph.constraints[index].rotation_weight, 2e4);
  }
  ASSERT_TRUE(AddWrongLoops(options, &again).ok());
  EXPECT_EQ(again.pose_graph.SerializeAsString(),
            map.pbstream.pose_graph.SerializeAsString());
  options.seed = 6;
  ASSERT_TRUE(AddWrongLoops(options, &other).ok());
  EXPECT_NE(other.pose_graph.SerializeAsString(),
            map.pbstream.pose_graph.SerializeAsString());
}

TEST(WrongLoopsTest, SmallMapsHaveNoRoomForThem) {
  Random random(1);
  EXPECT_FALSE(MakeWrongLoop(MapGraph(), WrongLoopOptions(), &random).ok());
  WrongLoopOptions far;
  far.count = 1;
  far.least_distance = 100.;
  SquareMap map;
  const auto indices = AddWrongLoops(far, &map.pbstream);
  ASSERT_FALSE(indices.ok());
  EXPECT_THAT(std::string(indices.status().message()), HasSubstr("too small"));
}

TEST(WrongLoopsTest, RunsGetThemWhateverTheThreads) {
  std::vector<GraphConstraint> first;
  for (const int threads : {1, 2}) {
    auto configuration = ParseSlamConfiguration(
        {"configuration_files"}, "robust.lua",
        "include \"common_2d.lua\"\n"
        "TRAJECTORY_BUILDER_2D.submaps.num_range_data = 20\n"
        "POSE_GRAPH.optimize_every_n_nodes = 40\n"
        "POSE_GRAPH.constraint_builder.sampling_ratio = 0.01\n"
        "POSE_GRAPH.global_sampling_ratio = 0.\n"
        "POSE_GRAPH.optimization_problem.cartographer_ext = {}\n"
        "return { map_builder = MAP_BUILDER,\n"
        "  trajectory_builder = TRAJECTORY_BUILDER }\n");
    ASSERT_TRUE(configuration.ok()) << configuration.status();
    test::RoomSource source(400);
    SlamRunOptions options;
    options.num_background_threads = threads;
    WrongLoopOptions wrong_loops;
    wrong_loops.count = 4;
    WrongLoopInjector injector(
        WithLoopWeights(configuration->map_builder_options, wrong_loops));
    options.after_scan = injector.Callback();
    const auto run = RunSlam(*configuration, &source, options);
    ASSERT_TRUE(run.ok()) << run.status();
    EXPECT_EQ(injector.injected().size(), 4u);
    EXPECT_GE(run->inter_constraints, 4);
    MapGraph injected;
    injected.constraints = injector.injected();
    EXPECT_EQ(MarkSwitchedOff(run->switched_loops.off, &injected).size(), 4u);
    EXPECT_GT(run->switched_loops.optimizations, 1);
    // The map is none the worse.
    for (const auto& pose : run->global_scan_poses) {
      const int index = static_cast<int>(
          (pose.time - test::RoomSource::kStart) / test::RoomSource::kStep);
      const Pose2 truth = Between(test::RoomSource::TruePose(0),
                                  test::RoomSource::TruePose(index));
      EXPECT_LT(
          (pose.pose.translation().head<2>() - truth.translation()).norm(),
          0.2);
    }
    if (first.empty()) first = injector.injected();
    for (size_t i = 0; i != first.size(); ++i) {
      EXPECT_EQ(injector.injected()[i].submap_id, first[i].submap_id);
      EXPECT_EQ(injector.injected()[i].node_id, first[i].node_id);
    }
  }
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
