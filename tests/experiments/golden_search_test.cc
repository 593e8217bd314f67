// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/golden_search.h"

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/compressed_point_cloud.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;

// A room as submap 0:0 and the room seen from elsewhere as node 0:1.
class GoldenSearchTest : public ::testing::Test {
 protected:
  GoldenSearchTest() {
    namespace mapping = cartographer::mapping;
    mapping::ValueConversionTables tables;
    mapping::proto::Submap submap;
    submap.mutable_submap_id()->set_trajectory_id(0);
    *submap.mutable_submap_2d()->mutable_grid() =
        mapping::test::RoomGrid(&tables, 0.05, 5)->ToProto();
    pbstream_.submaps.push_back(submap);
    const auto cloud = mapping::test::Moved(
        mapping::test::Room(),
        cartographer::transform::Rigid2d({0.3, -0.2}, 0.1).inverse());
    mapping::proto::Node node;
    node.mutable_node_id()->set_node_index(1);
    *node.mutable_node_data()->mutable_filtered_gravity_aligned_point_cloud() =
        cartographer::sensor::CompressedPointCloud(cloud).ToProto();
    pbstream_.nodes.push_back(node);
    pair_.line = 2;
    pair_.submap_id = SubmapId{0, 0};
    pair_.node_id = NodeId{0, 1};
    pair_.num_points = static_cast<int>(cloud.size());
    pair_.min_score = 0.5;
  }

  GoldenReport Check(const std::vector<GoldenPair>& pairs) {
    const auto map = GoldenMap::Create(pbstream_, pairs);
    EXPECT_TRUE(map.ok()) << map.status();
    return CheckGoldenPairs(pairs, *map, GoldenCheckOptions()).front();
  }

  // What the matchers themselves find.
  GoldenPair Truth() {
    GoldenPair pair = pair_;
    const GoldenReport found = Check({pair});
    EXPECT_TRUE(found.outcomes[0].ours.found);
    pair.found = true;
    pair.score = found.outcomes[0].ours.score;
    pair.pose = found.outcomes[0].ours.pose;
    const GoldenReport refined = Check({pair});
    pair.refined_pose = refined.outcomes[0].ours.refined_pose;
    pair.final_cost = refined.outcomes[0].ours.final_cost;
    return pair;
  }

  io::Pbstream pbstream_;
  GoldenPair pair_;
};

TEST_F(GoldenSearchTest, ComparesWithinTolerance) {
  const GoldenPair truth = Truth();
  EXPECT_NEAR(truth.pose.x, 0.3, 0.06);
  EXPECT_NEAR(truth.refined_pose.theta, 0.1, 0.01);

  std::vector<GoldenPair> pairs(7, truth);
  pairs[1].pose.x += 0.05;  // the score is the same
  pairs[2].score += 1e-4;
  pairs[3].refined_pose.y += 2e-3;
  pairs[4].final_cost *= 1.02;
  pairs[5].found = false;
  pairs[6].min_score = 0.99;
  const GoldenReport report = Check(pairs);
  ASSERT_EQ(report.outcomes.size(), 7u);
  EXPECT_EQ(report.outcomes[0].mismatch, "");
  EXPECT_FALSE(report.outcomes[0].tie);
  EXPECT_TRUE(report.outcomes[1].tie);
  EXPECT_NE(report.outcomes[2].mismatch.find("score"), std::string::npos);
  EXPECT_NE(report.outcomes[3].mismatch.find("refined pose"),
            std::string::npos);
  EXPECT_NE(report.outcomes[4].mismatch.find("final cost"), std::string::npos);
  EXPECT_EQ(report.outcomes[5].mismatch, "found");
  EXPECT_EQ(report.outcomes[6].mismatch, "not found");
  EXPECT_EQ(report.num_ties, 1);
  EXPECT_GE(report.num_mismatches, 5);
  EXPECT_NEAR(report.outcomes[4].relative_cost_deviation, 0.02, 2e-3);
  EXPECT_GT(MeanTimes(report, true).search_microseconds, 0.);
  EXPECT_EQ(MeanTimes(report, false).search_microseconds, 0.);
}

TEST_F(GoldenSearchTest, RefusesPairsThatAreNotInTheState) {
  GoldenPair pair = pair_;
  pair.submap_id.submap_index = 1;
  auto map = GoldenMap::Create(pbstream_, {pair});
  EXPECT_NE(map.status().message().find("no submap 0:1"), std::string::npos);
  pair = pair_;
  pair.node_id.node_index = 9;
  map = GoldenMap::Create(pbstream_, {pair});
  EXPECT_NE(map.status().message().find("no node 0:9"), std::string::npos);
  pair = pair_;
  pair.num_points += 1;
  map = GoldenMap::Create(pbstream_, {pair});
  EXPECT_FALSE(map.ok());
}

// The real thing: 64 pairs of each state.
class SharedGoldenTest : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedGoldenTest, FindsWhatCartographerFinds) {
  const std::string state =
      test::SharedData(std::string("pbstream/") + GetParam() + ".pbstream");
  const std::string golden =
      test::Golden(std::string(GetParam()) + ".search.csv");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(state);
  CARTOGRAPHER_EXT_SKIP_WITHOUT(golden);
  const auto pairs = ReadGoldenPairs(golden);
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  const auto pbstream = io::ReadPbstream(state);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();
  const auto map = GoldenMap::Create(*pbstream, *pairs);
  ASSERT_TRUE(map.ok()) << map.status();
  GoldenCheckOptions options;
  options.matchers = {GoldenMatcher::kStock, GoldenMatcher::kOurs};
  const std::vector<GoldenReport> reports =
      CheckGoldenPairs(*pairs, *map, options);
  ASSERT_EQ(reports.size(), 2u);
  for (const GoldenReport& report : reports) {
    EXPECT_EQ(report.outcomes.size(), 64u);
    for (const GoldenOutcome& outcome : report.outcomes) {
      EXPECT_EQ(outcome.mismatch, "") << "line " << outcome.golden.line;
      EXPECT_FALSE(outcome.tie) << "line " << outcome.golden.line;
    }
  }
  // The same as the host's matcher to the last bit.
  for (size_t i = 0; i != 64; ++i) {
    const GoldenPair& stock = reports[0].outcomes[i].ours;
    const GoldenPair& ours = reports[1].outcomes[i].ours;
    EXPECT_EQ(ours.found, stock.found);
    EXPECT_EQ(ours.score, stock.score);
    EXPECT_EQ(ours.pose.x, stock.pose.x);
    EXPECT_EQ(ours.pose.y, stock.pose.y);
    EXPECT_EQ(ours.pose.theta, stock.pose.theta);
  }
  EXPECT_LE(reports[1].mean_matcher_bytes, reports[0].mean_matcher_bytes);
}

INSTANTIATE_TEST_SUITE_P(States, SharedGoldenTest,
                         ::testing::Values("aces-made-by-cartographer",
                                           "csail-made-by-cartographer",
                                           "forzaeth-hangar", "legndy-map"));

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
