// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/self_consistency.h"

#include "absl/strings/str_cat.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/verdict/map_evaluation.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/map/verdict/box_world.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kNever = 1000;

// Wheels that agree with local SLAM but for one turn.
std::map<int, Trajectory> Odometry(const MapGraph& graph, const int turn_at,
                                   const double angle) {
  std::vector<StampedPose> poses;
  Pose2 turned;
  for (const auto& node : graph.nodes) {
    if (node.first.index == turn_at) {
      turned = node.second.local_pose * Pose2(0., 0., angle) *
               node.second.local_pose.Inverse();
    }
    poses.push_back(
        {node.second.time, ToIsometry(turned * node.second.local_pose)});
  }
  return {{0, Trajectory(poses)}};
}

TEST(SelfConsistencyTest, RightMapIsSound) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  const SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, {});
  EXPECT_EQ(result.word, "sound");
  EXPECT_TRUE(result.places.empty());
  EXPECT_THAT(result.reasons.front(), HasSubstr("the map is self-consistent"));
}

// Nothing is said of places visited twice where there are none.
TEST(SelfConsistencyTest, ARightMapOfOneVisitSaysSo) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2(), 0.);
  const SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, {});
  EXPECT_EQ(result.word, "sound");
  EXPECT_GT(result.contradictions.judged_nodes, 0);
  EXPECT_EQ(result.contradictions.revisit_nodes, 0);
  EXPECT_THAT(result.reasons.front(), HasSubstr("none was visited twice"));
  EXPECT_THAT(result.reasons,
              testing::Not(Contains(HasSubstr("nodes that revisit a place"))));
}

TEST(SelfConsistencyTest, FoldedMapIsBrokenAndNamesThePlace) {
  const test::BoxWorld world =
      test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)));
  const SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, {});
  EXPECT_EQ(result.word, "broken");
  EXPECT_GT(result.severe_share, 0.3);
  EXPECT_THAT(result.reasons.front(),
              HasSubstr("parts of the map overlap inconsistently, worst at"));
  EXPECT_THAT(result.reasons,
              Contains(HasSubstr("nodes (0, 60) to (0, 99) (60.0 s to 99.0 s "
                                 "after the start)")));
  const auto json = ToJson(result);
  EXPECT_EQ(json["verdict"], "broken");
  EXPECT_GE(json["places"].size(), 1u);
  EXPECT_THAT(ToText(result), HasSubstr("Self-consistency"));
}

// The same where the robot has not come back: local SLAM, or what the robot saw,
// is at fault, and nothing says that parts of the map are out of place.
TEST(SelfConsistencyTest, ContradictionsOnOneWayThroughAreDoubt) {
  const test::BoxWorld world =
      test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)), 0.);
  const SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, {});
  EXPECT_EQ(result.word, "doubtful");
  EXPECT_EQ(result.severe_share, 0.);
  EXPECT_GT(result.severe_passing_share, 0.3);
  EXPECT_GE(result.places.size(), 1u);
  EXPECT_THAT(result.reasons.front(),
              HasSubstr("parts of the map overlap inconsistently at"));
  EXPECT_THAT(
      result.reasons,
      Contains(HasSubstr("contradict what was mapped on the same visit")));
  // With a wrong turn the map is broken nevertheless.
  EXPECT_EQ(AssessSelfConsistency(world.graph, world.contents,
                                  Odometry(world.graph, 40, DegToRad(70.)), {})
                .word,
            "broken");
}

// A few nodes that come back say little about a large map.
TEST(SelfConsistencyTest, SevereNodesAreAShareOfEnoughNodes) {
  const test::BoxWorld world =
      test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)));
  SelfConsistencyOptions options;
  const double share =
      AssessSelfConsistency(world.graph, world.contents, {}, options)
          .severe_share;
  options.judged_share = 10.;
  EXPECT_NEAR(
      AssessSelfConsistency(world.graph, world.contents, {}, options)
          .severe_share,
      share *
          FindContradictions(world.graph, world.contents, {}).revisit_nodes /
          1000.,
      1e-9);
}

// Cartographer stores the nodes of a trajectory whose submaps were deleted or
// are not finished.
TEST(SelfConsistencyTest, TrajectoriesWithoutSubmapsAreNotJudged) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  const test::BoxWorld folded =
      test::MakeBoxWorld(0, Pose2(1.5, 1.2, DegToRad(20.)));
  for (const auto& node : folded.graph.nodes) {
    const GraphId id{1, node.first.index};
    world.graph.nodes[id] = node.second;
    world.contents.scans[id] = folded.contents.scans.at(node.first);
  }
  const SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, {});
  EXPECT_EQ(result.word, "sound");
  EXPECT_EQ(result.reasons.back(),
            "trajectory 1 (100 nodes) is not judged: nothing ties its nodes to "
            "a submap");
  // Tied by a single loop, they are part of the map.
  GraphConstraint loop;
  loop.submap_id = {0, 0};
  loop.node_id = {1, 50};
  loop.is_loop = true;
  world.graph.constraints.push_back(loop);
  EXPECT_EQ(AssessSelfConsistency(world.graph, world.contents, {}, {}).word,
            "broken");
}

TEST(SelfConsistencyTest, WrongTurnAloneIsDoubt) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  const SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents,
                            Odometry(world.graph, 40, DegToRad(70.)), {});
  EXPECT_EQ(result.word, "doubtful");
  ASSERT_EQ(result.wrong_turns.size(), 1u);
  EXPECT_EQ(result.wrong_turns[0].node_id, (GraphId{0, 40}));
  EXPECT_NEAR(RadToDeg(result.wrong_turns[0].odometry_rotation), 70., 1e-6);
  EXPECT_THAT(result.reasons, Contains(HasSubstr("differ by 70 degrees")));
}

TEST(SelfConsistencyTest, AgreeingOdometryIsFine) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  const SelfConsistency result = AssessSelfConsistency(
      world.graph, world.contents, Odometry(world.graph, kNever, 0.), {});
  EXPECT_EQ(result.word, "sound");
  EXPECT_EQ(result.motion.odometry_translation.count, 99);
  EXPECT_LT(result.motion.odometry_translation.max, 1e-9);
  EXPECT_LT(result.motion.bend_translation.max, 1e-9);
}

TEST(SelfConsistencyTest, NothingSeenTwiceIsUnknown) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  SelfConsistencyOptions options;
  options.contradiction.min_node_gap = 1000;
  EXPECT_EQ(
      AssessSelfConsistency(world.graph, world.contents, {}, options).word,
      "unknown");
}

TEST(SelfConsistencyTest, HardlyAnythingSeenTwiceIsUnknown) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  SelfConsistencyOptions options;
  bool is_few = false, is_enough = false;
  for (int gap = 40; gap < 110; ++gap) {
    options.contradiction.min_node_gap = gap;
    const SelfConsistency result =
        AssessSelfConsistency(world.graph, world.contents, {}, options);
    // Of a hundred nodes.
    const int64_t judged = result.contradictions.judged_nodes;
    EXPECT_EQ(result.word, judged < 15 ? "unknown" : "sound") << judged;
    is_few = is_few || (judged > 0 && judged < 15);
    is_enough = is_enough || judged >= 15;
  }
  EXPECT_TRUE(is_few);
  EXPECT_TRUE(is_enough);
}

// 0.6 m contradict less than 60 % of the rays.
TEST(SelfConsistencyTest, DisplacedMapIsDoubtfulAndNamesThePlace) {
  const test::BoxWorld world = test::MakeBoxWorld(60, Pose2(0., 0.6, 0.));
  SelfConsistencyOptions options;
  SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, options);
  EXPECT_EQ(result.severe_share, 0.);
  EXPECT_EQ(result.word, "doubtful");
  EXPECT_THAT(
      result.reasons.front(),
      HasSubstr("parts of the map are displaced against each other, by 0."));
  EXPECT_THAT(result.reasons, Contains(HasSubstr("m from where they fit")));
  EXPECT_EQ(result.places.size(), 2u);
  EXPECT_GT(ToJson(result)["places"][0]["displacement"], 0.3);
  // So few that the map may be torn apart.
  options.judged_share = 1.01;
  EXPECT_EQ(
      AssessSelfConsistency(world.graph, world.contents, {}, options).word,
      "unknown");
  options.judged_share = 0.15;
  options.displaced_share = 1.1;
  result = AssessSelfConsistency(world.graph, world.contents, {}, options);
  EXPECT_NE(result.word, "doubtful");
  EXPECT_TRUE(result.places.empty());
}

TEST(SelfConsistencyTest, PartsThatNothingTiesTogetherAreUnknown) {
  test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  // Nodes 0 to 9 and 60 to 99 remain, and the first submap sees none again.
  for (int i = 10; i < 60; ++i) world.graph.nodes.erase({0, i});
  for (int i = 60; i < 100; ++i) {
    GraphNode& node = world.graph.nodes.at({0, i});
    node.global_pose = Pose2(100., 0., 0.) * node.global_pose;
  }
  world.graph.submaps.at({0, 1}).global_pose = Pose2(100., 0., 0.);
  SelfConsistencyOptions options;
  // So that nodes 60 to 89 see the second submap again.
  options.contradiction.min_node_gap = 1;
  options.displacement.free_length = 2.;
  SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, options);
  // They tie nodes 60 to 99 together, 40 of 50.
  EXPECT_EQ(result.displacements.tied_share, 0.8);
  EXPECT_EQ(result.word, "sound");
  options.tied_share = 0.9;
  result = AssessSelfConsistency(world.graph, world.contents, {}, options);
  EXPECT_EQ(result.word, "unknown");
  EXPECT_THAT(result.reasons.front(),
              HasSubstr("tie no more than 80 % of the path together"));
}

TEST(SelfConsistencyTest, AMapThatMayLieElsewhereIsDoubtful) {
  const test::BoxWorld world = test::MakeBoxWorld(kNever, Pose2());
  SelfConsistencyOptions options;
  SelfConsistency result =
      AssessSelfConsistency(world.graph, world.contents, {}, options);
  EXPECT_EQ(result.loose.share(), 0.);
  EXPECT_EQ(ToJson(result)["loose_share"], 0.);
  // No scan fixes a place so closely.
  options.loose.limit = 1e-3;
  result = AssessSelfConsistency(world.graph, world.contents, {}, options);
  EXPECT_GT(result.loose.share(), 0.5);
  EXPECT_EQ(result.word, "doubtful");
  EXPECT_TRUE(result.places.empty());
  EXPECT_THAT(result.reasons.front(),
              HasSubstr("too little ties its parts together"));
  EXPECT_THAT(result.reasons,
              Contains(HasSubstr(DescribeLooseShare(result.loose.share()))));
  EXPECT_EQ(ToJson(result)["loose_share"], result.loose.share());
  // A contradiction weighs more.
  const test::BoxWorld folded =
      test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)));
  EXPECT_EQ(
      AssessSelfConsistency(folded.graph, folded.contents, {}, options).word,
      "broken");
}

TEST(SelfConsistencyTest, TruthGoesBeforeTheMapsOwnWord) {
  const test::BoxWorld world =
      test::MakeBoxWorld(60, Pose2(1.5, 1.2, DegToRad(20.)));
  Evaluation evaluation;
  evaluation.consistency =
      AssessSelfConsistency(world.graph, world.contents, {}, {});
  EXPECT_EQ(Judge(evaluation).word, "broken");
  evaluation.trajectory.emplace();
  evaluation.trajectory->ate.rmse = 0.02;
  EXPECT_EQ(Judge(evaluation).word, "sound");
}

class SharedMapsTest
    : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(SharedMapsTest, VerdictWithoutTruth) {
  const std::string filename = test::SharedData(
      absl::StrCat("pbstream/", GetParam().first, ".pbstream"));
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename);
  const auto pbstream = io::ReadPbstream(filename);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();
  const SelfConsistency result = AssessSelfConsistency(
      MakeMapGraph(*pbstream), ReadMapContents(*pbstream, {}),
      ReadOdometry(*pbstream), {});
  if (std::string(GetParam().second) == "broken") {
    EXPECT_EQ(result.word, "broken");
    EXPECT_FALSE(result.places.empty());
  } else {
    EXPECT_NE(result.word, "broken");
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedMapsTest,
    testing::Values(std::make_pair("aces-made-by-cartographer", "broken"),
                    std::make_pair("csail-made-by-cartographer", "broken"),
                    std::make_pair("aces-sound-by-cartographer", "not broken"),
                    std::make_pair("csail-sound-by-cartographer", "not broken"),
                    std::make_pair("forzaeth-hangar", "not broken"),
                    std::make_pair("legndy-map", "not broken")));

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
