// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A map made of a drive round the test room, and later drives that start in it.
#include "cartographer_ext/slam/starting_state.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/slam/room_source.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr int kMapScans = 450;

SlamConfiguration Load(const std::string& basename) {
  auto configuration = LoadSlamConfiguration({"configuration_files"}, basename);
  CHECK(configuration.ok()) << configuration.status();
  return *configuration;
}

class StartingStateTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    filename_ = new std::string(testing::TempDir() + "starting_state.pbstream");
    test::RoomSource source(kMapScans);
    const auto run = RunSlam(Load("stock.lua"), &source, SlamRunOptions());
    ASSERT_TRUE(run.ok()) << run.status();
    ASSERT_TRUE(WritePbstream(run->map_builder.get(), *filename_).ok());
    map_nodes_ = run->nodes;
    std::vector<PosePair> pairs;
    for (const StampedPose& pose : run->global_scan_poses) {
      const int64_t scan =
          (pose.time - test::RoomSource::kStart) / test::RoomSource::kStep;
      pairs.push_back({pose.time, ToPose2(pose.pose),
                       test::RoomSource::TruePose(static_cast<int>(scan))});
    }
    room_from_map_ = AlignInPlane(pairs);
  }

  // (map <- robot)
  static Pose2 InMap(const int scan) {
    return Between(room_from_map_, test::RoomSource::TruePose(scan));
  }

  static std::string* filename_;
  static int64_t map_nodes_;
  static Pose2 room_from_map_;
};

std::string* StartingStateTest::filename_ = nullptr;
int64_t StartingStateTest::map_nodes_ = 0;
Pose2 StartingStateTest::room_from_map_;

TEST_F(StartingStateTest, LocalizesFromAKnownStart) {
  for (const char* configuration : {"stock_localization.lua"}) {
    test::RoomSource source(300);
    SlamRunOptions options;
    options.state.filename = *filename_;
    const Pose2 told = InMap(0) * Pose2(0.1, -0.1, 0.03);
    options.state.initial_pose = told;
    const auto run = RunSlam(Load(configuration), &source, options);
    ASSERT_TRUE(run.ok()) << run.status();
    EXPECT_EQ(run->trajectory_id, 1);
    EXPECT_EQ(run->loaded_nodes, map_nodes_);
    EXPECT_GE(run->loaded_submaps, 2);
    ASSERT_EQ(run->online_scan_poses.size(), run->local_scan_poses.size());
    // The trimmer has left nothing else.
    ASSERT_EQ(run->global_scan_poses.size(), run->online_scan_poses.size());
    EXPECT_EQ(run->nodes, map_nodes_);
    // At first where it was told to be, in the end where it is.
    const Pose2 first = ToPose2(run->online_scan_poses.front().pose);
    EXPECT_LT(Between(told, first).translation().norm(), 0.02);
    const Pose2 last = ToPose2(run->online_scan_poses.back().pose);
    const Pose2 error = Between(InMap(299), last);
    EXPECT_LT(error.translation().norm(), 0.06) << configuration;
    EXPECT_LT(std::abs(error.theta), 0.02) << configuration;
  }
}

TEST_F(StartingStateTest, GoesOnMapping) {
  test::RoomSource source(200);
  SlamRunOptions options;
  options.state.filename = *filename_;
  options.state.frozen = false;
  const auto run = RunSlam(Load("stock.lua"), &source, options);
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_GT(run->nodes, map_nodes_ + 50);
  EXPECT_FALSE(run->map_builder->pose_graph()->IsTrajectoryFrozen(0));
}

TEST_F(StartingStateTest, TellsTheHostWhereTheTrajectoryBegins) {
  const SlamConfiguration configuration = Load("stock.lua");
  const auto map_builder = cartographer::mapping::CreateMapBuilder(
      configuration.map_builder_options);
  StartingState state;
  state.filename = *filename_;
  const auto ids = LoadStartingState(state, map_builder.get());
  ASSERT_TRUE(ids.ok()) << ids.status();
  EXPECT_THAT(*ids, testing::ElementsAre(testing::Pair(0, 0)));
  auto options = configuration.trajectory_builder_options;
  const auto& pose_graph = *map_builder->pose_graph();
  ASSERT_TRUE(SetInitialPose(Pose2(1., 2., 0.5), 0, pose_graph, &options).ok());
  const int id = map_builder->AddTrajectoryBuilder(
      {{cartographer::mapping::TrajectoryBuilderInterface::SensorId::
            SensorType::RANGE,
        "scan"}},
      options, nullptr);
  const Pose2 start = ToPlanarPose(pose_graph.GetLocalToGlobalTransform(id));
  EXPECT_NEAR(start.x, 1., 1e-9);
  EXPECT_NEAR(start.y, 2., 1e-9);
  EXPECT_NEAR(start.theta, 0.5, 1e-9);
  map_builder->FinishTrajectory(id);

  const auto nowhere = SetInitialPose(Pose2(), 7, pose_graph, &options);
  EXPECT_THAT(std::string(nowhere.message()),
              testing::HasSubstr("trajectory 7 of the map has no nodes"));
}

TEST_F(StartingStateTest, ABadMapIsAnError) {
  test::RoomSource source(10);
  SlamRunOptions options;
  options.state.filename = testing::TempDir() + "no_such.pbstream";
  EXPECT_EQ(RunSlam(Load("stock.lua"), &source, options).status().code(),
            absl::StatusCode::kNotFound);
  // A file, but not a map.
  options.state.filename = "configuration_files/stock.lua";
  EXPECT_FALSE(RunSlam(Load("stock.lua"), &source, options).ok());
}

// Saving such a map would end the program.
TEST_F(StartingStateTest, AMapWithoutAGridIsRefused) {
  auto map = io::ReadPbstream(*filename_);
  ASSERT_TRUE(map.ok()) << map.status();
  map->submaps[1].mutable_submap_2d()->clear_grid();
  SlamRunOptions options;
  options.state.filename = testing::TempDir() + "without_grid.pbstream";
  ASSERT_TRUE(io::WritePbstream(*map, options.state.filename).ok());
  test::RoomSource source(3);
  const auto run = RunSlam(Load("stock.lua"), &source, options);
  std::remove(options.state.filename.c_str());
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(std::string(run.status().message()),
              testing::HasSubstr("submap (0, 1) has no grid"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
