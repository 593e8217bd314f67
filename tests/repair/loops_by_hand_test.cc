// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/loops_by_hand.h"

#include <limits>

#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/repair/map_repair.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace repair {
namespace {

using evaluation::GraphId;
using testing::HasSubstr;

class LoopsByHandTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_ = new io::Pbstream(
        test::MakeRoomMap(testing::TempDir() + "/loops_by_hand_test.pbstream"));
    graph_ = new evaluation::MapGraph(evaluation::MakeMapGraph(*room_));
  }
  static void TearDownTestSuite() {
    delete room_;
    delete graph_;
  }

  // In the first submap the node of the second lap that is nearest to where the
  // first lap began: the laser looks ahead only, and from elsewhere it sees
  // walls that the first submap does not have.
  static LoopByHand Loop() {
    LoopByHand loop;
    loop.submap_id = graph_->submaps.begin()->first;
    const auto first = graph_->nodes.begin()->second.global_pose.translation();
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& node : graph_->nodes) {
      if (node.first.index < 200) continue;
      const double distance =
          (node.second.global_pose.translation() - first).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      loop.node_id = node.first;
    }
    return loop;
  }
  static Pose2 Truth() {
    return graph_->submaps.at(Loop().submap_id).global_pose.Inverse() *
           graph_->nodes.at(Loop().node_id).global_pose;
  }
  static HandMatchOptions Options() {
    HandMatchOptions options;
    options.builder = test::RoomConfiguration()
                          .map_builder_options.pose_graph_options()
                          .constraint_builder_options();
    options.spacing = 0.2;  // the submaps are a metre long
    return options;
  }
  static void ExpectTruth(const absl::StatusOr<HandMatch>& match) {
    ASSERT_TRUE(match.ok()) << match.status();
    EXPECT_NEAR(match->pose.x, Truth().x, 0.08);
    EXPECT_NEAR(match->pose.y, Truth().y, 0.08);
    EXPECT_NEAR((Truth().Inverse() * match->pose).theta, 0., 0.03);
    EXPECT_GT(match->score, Options().builder.min_score());
    EXPECT_GE(match->temporal, Options().min_temporal_score);
    EXPECT_GT(match->num_verified, 3);
  }

  static io::Pbstream* room_;
  static evaluation::MapGraph* graph_;
};

io::Pbstream* LoopsByHandTest::room_ = nullptr;
evaluation::MapGraph* LoopsByHandTest::graph_ = nullptr;

TEST_F(LoopsByHandTest, FindsThePlaceFromAPoseThatIsOff) {
  LoopByHand loop = Loop();
  loop.pose = Pose2(Truth().x + 0.7, Truth().y - 0.6, Truth().theta + 0.3);
  ExpectTruth(MatchByHand(loop, *graph_, *room_, Options()));
}

TEST_F(LoopsByHandTest, FindsThePlaceInTheWholeSubmap) {
  ExpectTruth(MatchByHand(Loop(), *graph_, *room_, Options()));
}

TEST_F(LoopsByHandTest, RefusesWhereTheScanDoesNotFit) {
  LoopByHand loop = Loop();
  loop.pose = Pose2(Truth().x + 30., Truth().y, Truth().theta);
  EXPECT_THAT(
      std::string(
          MatchByHand(loop, *graph_, *room_, Options()).status().message()),
      HasSubstr("the scan matches nowhere within 1.0 m"));
}

// A pose that looks the other way scores enough if little is asked for; what the
// submap has there does not agree.
TEST_F(LoopsByHandTest, RefusesWhereOnlyOneScanFits) {
  LoopByHand loop = Loop();
  loop.pose = Pose2(Truth().x, Truth().y, Truth().theta + kPi);
  HandMatchOptions options = Options();
  options.builder.set_min_score(0.05);
  EXPECT_THAT(
      std::string(
          MatchByHand(loop, *graph_, *room_, options).status().message()),
      HasSubstr("do not agree with the submap"));
}

TEST_F(LoopsByHandTest, SaysWhatTheMapDoesNotHave) {
  io::Pbstream bare = *room_;
  bare.submaps.clear();
  EXPECT_THAT(
      std::string(
          MatchByHand(Loop(), *graph_, bare, Options()).status().message()),
      HasSubstr("does not have both the scan and the grid"));
}

TEST_F(LoopsByHandTest, ReadsNames) {
  evaluation::MapGraph graph = *graph_;
  graph.constraints.clear();
  const auto loops = ParseLoopsByHand(graph, "0:0:0:3, 0:0:0:4:1.5:-0.25:3.1");
  ASSERT_TRUE(loops.ok()) << loops.status();
  ASSERT_EQ(loops->size(), 2u);
  EXPECT_EQ((*loops)[0].node_id, (GraphId{0, 3}));
  EXPECT_FALSE((*loops)[0].pose.has_value());
  EXPECT_EQ((*loops)[1].pose->y, -0.25);
  for (const std::string name :
       {"0:0:0", "0:0:0:3:1:2", "a:0:0:3", "0:0:0:3:1:2:nan", "0:0:0:3:1:2:1e9",
        "0:99:0:3", "0:0:0:99999", "0:0:0:3,0:0:0:3:1:2:0"}) {
    EXPECT_FALSE(ParseLoopsByHand(graph, name).ok()) << name;
  }
  EXPECT_THAT(
      std::string(ParseLoopsByHand(*graph_, "0:0:0:0").status().message()),
      HasSubstr("was inserted into this submap"));
}

TEST_F(LoopsByHandTest, ALoopThatDoesNotFitLeavesTheMapAlone) {
  const auto slam = test::RoomConfiguration();
  RepairOptions options;
  options.configuration.stock = slam.map_builder_options.pose_graph_options();
  options.local_slam =
      slam.trajectory_builder_options.trajectory_builder_2d_options();
  LoopByHand loop = Loop();
  loop.pose = Pose2(Truth().x + 30., Truth().y, Truth().theta);
  options.added_loops = {loop};
  const auto repair = RepairMap(*room_, options);
  ASSERT_TRUE(repair.ok()) << repair.status();
  EXPECT_FALSE(repair->changed());
  ASSERT_EQ(repair->steps.size(), 1u);
  EXPECT_THAT(repair->steps[0].reason, HasSubstr("matches nowhere"));
}

// A map without its loops, its end moved off: one loop by hand brings it back.
TEST_F(LoopsByHandTest, ALoopByHandRepairs) {
  const auto slam = test::RoomConfiguration();
  RepairOptions options;
  options.loops = options.local = false;
  options.configuration.stock = slam.map_builder_options.pose_graph_options();
  io::Pbstream open = *room_;
  auto* const constraints = open.pose_graph.mutable_constraint();
  for (int i = constraints->size() - 1; i >= 0; --i) {
    if (constraints->Get(i).tag() ==
        cartographer::mapping::proto::PoseGraph::Constraint::INTER_SUBMAP) {
      constraints->DeleteSubrange(i, 1);
    }
  }
  // All after the first half lies 2 m to the side.
  auto* const trajectory = open.pose_graph.mutable_trajectory(0);
  for (int i = trajectory->node_size() / 2; i < trajectory->node_size(); ++i) {
    auto* const place =
        trajectory->mutable_node(i)->mutable_pose()->mutable_translation();
    place->set_y(place->y() + 2.);
  }
  for (int i = trajectory->submap_size() / 2; i < trajectory->submap_size();
       ++i) {
    auto* const place =
        trajectory->mutable_submap(i)->mutable_pose()->mutable_translation();
    place->set_y(place->y() + 2.);
  }
  options.added_loops = {Loop()};
  const auto repair = RepairMap(open, options);
  ASSERT_TRUE(repair.ok()) << repair.status();
  ASSERT_FALSE(repair->steps.empty());
  EXPECT_TRUE(repair->steps[0].kept) << repair->steps[0].reason;
  EXPECT_EQ(repair->after.graph.num_loops(), 1);
  const Pose2 after =
      repair->after.graph.submaps.at(Loop().submap_id).global_pose.Inverse() *
      repair->after.graph.nodes.at(Loop().node_id).global_pose;
  EXPECT_NEAR(after.x, Truth().x, 0.1);
  EXPECT_NEAR(after.y, Truth().y, 0.1);
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
