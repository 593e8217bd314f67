// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/map_repair.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/experiments/wrong_loops.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "cartographer_ext/repair/kept_frame.h"
#include "cartographer_ext/repair/local_rerun.h"
#include "cartographer_ext/repair/repair_output.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace repair {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class MapRepairTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_ = new io::Pbstream(
        test::MakeRoomMap(testing::TempDir() + "/map_repair_test.pbstream"));
  }
  static void TearDownTestSuite() { delete room_; }

  static RepairOptions Options() {
    const auto slam = test::RoomConfiguration();
    RepairOptions options;
    options.configuration.stock = slam.map_builder_options.pose_graph_options();
    options.local_slam =
        slam.trajectory_builder_options.trajectory_builder_2d_options();
    return options;
  }

  // The room with wrong loops, optimised as if they were right.
  static io::Pbstream Broken() {
    io::Pbstream broken = *room_;
    evaluation::WrongLoopOptions wrong;
    wrong.count = 8;
    CHECK(evaluation::AddWrongLoops(wrong, &broken).ok());
    const auto graph =
        evaluation::MakeMapPoseGraph(evaluation::MakeMapGraph(broken), {});
    CHECK(graph.ok()) << graph.status();
    optimization::OptimizeOptions options;
    options.method = "none";
    const auto solved = optimization::Optimize(graph->graph, options);
    CHECK(solved.ok()) << solved.status();
    evaluation::StorePoses(*graph, solved->poses, &broken);
    return broken;
  }

  // The largest distance of a node from where the room's map has it, both laid
  // over each other.
  static double LargestError(const io::Pbstream& pbstream) {
    const auto graph = evaluation::MakeMapGraph(pbstream);
    const auto room = evaluation::MakeMapGraph(*room_);
    const Pose2 room_from_map = OldFromNewByNodes(room, graph);
    double largest = 0.;
    for (const auto& node : room.nodes) {
      const Pose2 pose = room_from_map * graph.nodes.at(node.first).global_pose;
      largest = std::max(
          largest,
          (pose.translation() - node.second.global_pose.translation()).norm());
    }
    return largest;
  }

  static io::Pbstream* room_;
};

io::Pbstream* MapRepairTest::room_ = nullptr;

TEST_F(MapRepairTest, ASoundMapIsLeftAlone) {
  const auto repair = RepairMap(*room_, Options());
  ASSERT_TRUE(repair.ok()) << repair.status();
  EXPECT_EQ(repair->before.quality.verdict, "sound");
  EXPECT_FALSE(repair->changed());
  EXPECT_TRUE(repair->steps.empty());
  EXPECT_THAT(repair->conclusion, StartsWith("nothing to repair"));
}

TEST_F(MapRepairTest, WrongLoopsAreTakenOut) {
  const io::Pbstream broken = Broken();
  ASSERT_GT(LargestError(broken), 0.5);
  const auto repair = RepairMap(broken, Options());
  ASSERT_TRUE(repair.ok()) << repair.status();
  EXPECT_EQ(repair->before.quality.verdict, "broken");
  EXPECT_TRUE(repair->changed());
  EXPECT_EQ(repair->after.quality.verdict, "sound") << ToText(*repair);
  EXPECT_THAT(repair->conclusion, StartsWith("repaired"));
  const io::Pbstream& after = *repair->after.pbstream;
  EXPECT_TRUE(io::FindPbstreamProblems(after).empty());
  EXPECT_EQ(after.nodes.size(), broken.nodes.size());
  EXPECT_EQ(after.odometry_data.size(), broken.odometry_data.size());
  EXPECT_EQ(after.options.SerializeAsString(),
            broken.options.SerializeAsString());
  EXPECT_LT(LargestError(after), 0.2);
  const auto json = ToJson(*repair);
  EXPECT_EQ(json["after"]["verdict"], "sound");
  ASSERT_FALSE(json["steps"].empty());
  EXPECT_TRUE(json["steps"][0]["kept"].is_boolean());
  const auto page = MakeRepairReport(*repair, "room", "");
  ASSERT_TRUE(page.ok()) << page.status();
  EXPECT_THAT(*page, HasSubstr("What to do"));
}

TEST_F(MapRepairTest, OdometryIsLeftOutOnRequest) {
  const io::Pbstream broken = Broken();
  ASSERT_FALSE(broken.odometry_data.empty());
  RepairOptions options = Options();
  for (const bool drop : {false, true}) {
    options.drop_odometry = drop;
    const auto repair = RepairMap(broken, options);
    ASSERT_TRUE(repair.ok()) << repair.status();
    EXPECT_EQ(repair->after.quality.verdict, "sound");
    EXPECT_EQ(repair->after.pbstream->odometry_data.empty(), drop);
    EXPECT_TRUE(io::FindPbstreamProblems(*repair->after.pbstream).empty());
    const bool warns =
        ToText(*repair).find("loaded frozen") != std::string::npos;
    EXPECT_EQ(warns, !drop);
  }
}

TEST_F(MapRepairTest, AnyNumberOfThreadsGivesTheSameBytes) {
  const io::Pbstream broken = Broken();
  std::string bytes[2];
  for (const int threads : {1, 3}) {
    RepairOptions options = Options();
    options.num_background_threads = threads;
    const auto repair = RepairMap(broken, options);
    ASSERT_TRUE(repair.ok());
    bytes[threads == 1] = io::SerializePbstream(*repair->after.pbstream);
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

// The second half saw everything at 0.6 of its distance, which nothing repairs; the
// wrong loops go, and the map is still broken.
TEST_F(MapRepairTest, WhatStaysBrokenIsNotWritten) {
  io::Pbstream broken = Broken();
  for (size_t i = broken.nodes.size() / 2; i < broken.nodes.size(); ++i) {
    auto* const proto = broken.nodes[i].mutable_node_data();
    auto data = cartographer::mapping::FromProto(*proto);
    std::vector<cartographer::sensor::RangefinderPoint> points;
    for (const auto& point : data.filtered_gravity_aligned_point_cloud) {
      points.push_back({0.6f * point.position});
    }
    data.filtered_gravity_aligned_point_cloud =
        cartographer::sensor::PointCloud(points);
    *proto = cartographer::mapping::ToProto(data);
  }
  RepairOptions options = Options();
  options.local = false;
  const auto repair = RepairMap(broken, options);
  ASSERT_TRUE(repair.ok()) << repair.status();
  EXPECT_EQ(repair->before.quality.verdict, "broken");
  EXPECT_TRUE(std::any_of(repair->steps.begin(), repair->steps.end(),
                          [](const RepairStep& step) { return step.kept; }));
  EXPECT_FALSE(repair->changed());
  EXPECT_THAT(repair->conclusion, StartsWith("cannot be repaired"));
  EXPECT_THAT(repair->conclusion,
              HasSubstr("the best version is still broken"));

  // Corrected by hand, it is written for the next correction.
  options.dropped_loops = {broken.pose_graph.constraint_size() - 1};
  const auto by_hand = RepairMap(broken, options);
  ASSERT_TRUE(by_hand.ok()) << by_hand.status();
  EXPECT_TRUE(by_hand->changed());
}

TEST_F(MapRepairTest, AMapWithoutNodesIsRefused) {
  io::Pbstream empty = *room_;
  empty.nodes.clear();
  EXPECT_FALSE(RepairMap(empty, Options()).ok());
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
