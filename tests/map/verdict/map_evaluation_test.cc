// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/map_evaluation.h"

#include <vector>

#include "cartographer_ext/map/pbstream_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/map/square_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;

constexpr io::TimeNs kSecond = 1000000000LL;

class MapEvaluationTest : public testing::Test {
 protected:
  MapEvaluationTest() {
    square_.AddRightLoops();
    // One that is off by three metres.
    square_.Add(0, 60,
                Between(test::SquareMap::Origin(square_.truth, 0),
                        square_.truth[60] * Pose2(3., 0., 0.)),
                true);
    graph_ = MakeMapGraph(square_.pbstream);
    std::vector<StampedPose> poses;
    for (int i = 0; i < test::SquareMap::kNodes; ++i) {
      poses.push_back({(i + 1) * kSecond, ToIsometry(square_.truth[i])});
    }
    truth_ = Trajectory(poses);
  }

  absl::StatusOr<Evaluation> Judge(const GroundTruth& truth) {
    MapToEvaluate map;
    map.graph = &graph_;
    return EvaluateMap(map, truth, MapEvaluationOptions());
  }

  GroundTruth WithReference() {
    GroundTruth truth;
    truth.reference = truth_;
    truth.reference_name = "truth.tum";
    return truth;
  }

  test::SquareMap square_;
  MapGraph graph_;
  Trajectory truth_;
};

TEST_F(MapEvaluationTest, WithoutTruthTheLoopsAreCounted) {
  const auto result = Judge(GroundTruth());
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_FALSE(result->relations.has_value());
  EXPECT_FALSE(result->trajectory.has_value());
  EXPECT_FALSE(result->consistency.has_value());
  ASSERT_TRUE(result->loops.has_value());
  EXPECT_EQ(result->loops->accepted, 9);
  EXPECT_EQ(result->loops->judged, 0);
  // 79 steps of one metre.
  EXPECT_NEAR(result->trajectory_metres, 79., 1e-6);
}

TEST_F(MapEvaluationTest, AReferenceJudgesPathAndLoops) {
  const auto result = Judge(WithReference());
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_TRUE(result->trajectory.has_value());
  EXPECT_EQ(result->trajectory->num_pairs, test::SquareMap::kNodes);
  // A milliradian a metre, twice round the square.
  EXPECT_GT(result->trajectory->ate.rmse, 0.01);
  EXPECT_LT(result->trajectory->ate.rmse, 0.5);
  ASSERT_TRUE(result->loops.has_value());
  EXPECT_EQ(result->loops->judged, 9);
  EXPECT_EQ(result->loops->correct, 8);
}

TEST_F(MapEvaluationTest, ScansGoBeforeNodes) {
  MapToEvaluate map;
  map.graph = &graph_;
  map.scans = &truth_;
  GroundTruth truth = WithReference();
  Relation relation;
  relation.time1 = 10 * kSecond;
  relation.time2 = 70 * kSecond;
  relation.relative = ToIsometry(Between(square_.truth[9], square_.truth[69]));
  truth.relations = std::vector<Relation>{relation};
  const auto result = EvaluateMap(map, truth, MapEvaluationOptions());
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_NEAR(result->trajectory->ate.max, 0., 1e-9);
  ASSERT_TRUE(result->relations.has_value());
  EXPECT_EQ(result->relations->all.translation.count, 1);
  EXPECT_NEAR(result->relations->all.translation.mean, 0., 1e-9);
  // The nodes, beside it, have drifted.
  ASSERT_TRUE(result->node_relations.has_value());
  EXPECT_GT(result->node_relations->all.translation.mean, 0.01);

  // Without a graph there are no loops.
  map.graph = nullptr;
  const auto alone = EvaluateMap(map, truth, MapEvaluationOptions());
  ASSERT_TRUE(alone.ok()) << alone.status();
  EXPECT_FALSE(alone->loops.has_value());
  EXPECT_FALSE(alone->node_relations.has_value());
}

TEST_F(MapEvaluationTest, SelfConsistencyNeedsContents) {
  const MapContents contents = ReadMapContents(square_.pbstream, {});
  MapToEvaluate map;
  map.graph = &graph_;
  map.contents = &contents;
  const auto result = EvaluateMap(map, GroundTruth(), MapEvaluationOptions());
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_TRUE(result->consistency.has_value());
  // No grids, so nothing was seen twice.
  EXPECT_EQ(result->consistency->word, "unknown");
}

TEST_F(MapEvaluationTest, ErrorsNameTheTruth) {
  GroundTruth late = WithReference();
  late.reference = Trajectory(
      std::vector<StampedPose>{{1000 * kSecond, ToIsometry(Pose2())},
                               {1001 * kSecond, ToIsometry(Pose2())}});
  const auto nothing = Judge(late);
  ASSERT_FALSE(nothing.ok());
  EXPECT_THAT(std::string(nothing.status().message()), HasSubstr("truth.tum"));
  GroundTruth relations;
  relations.relations_name = "map.relations";
  Relation relation;
  relation.time1 = 1000 * kSecond;
  relation.time2 = 1001 * kSecond;
  relations.relations = std::vector<Relation>{relation};
  const auto outside = Judge(relations);
  ASSERT_FALSE(outside.ok());
  EXPECT_THAT(std::string(outside.status().message()),
              HasSubstr("map.relations"));
  MapToEvaluate map;
  map.graph = &graph_;
  MapEvaluationOptions options;
  options.trajectory_id = 4;
  const auto empty = EvaluateMap(map, GroundTruth(), options);
  ASSERT_FALSE(empty.ok());
  EXPECT_THAT(std::string(empty.status().message()),
              HasSubstr("trajectory 4 has no nodes"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
