// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/match_files.h"

#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer/common/time.h"
#include "cartographer_ext/common/host_ticks.h"
#include "cartographer_ext/map/host_types.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using proto::MatchRecord;

MatchRecord RecordAt(const io::TimeNs time) {
  MatchRecord record;
  record.set_time(cartographer::common::ToUniversal(ToHostTime(time)));
  record.set_is_node(true);
  return record;
}

TEST(MatchFilesTest, NamesBesideTheMap) {
  EXPECT_EQ(MatchRecordsFilename("a/run.pbstream"), "a/run.nodes.pb");
  EXPECT_EQ(MatchCsvFilename("a/run.pbstream"), "a/run.nodes.csv");
  EXPECT_EQ(MatchRecordsFilename("run"), "run.nodes.pb");
}

TEST(MatchFilesTest, WrittenReadAndRemoved) {
  const std::string map = testing::TempDir() + "/match_files.pbstream";
  std::vector<MatchRecord> records = {RecordAt(1000000000),
                                      RecordAt(2000000000)};
  ASSERT_TRUE(WriteMatchesBeside(map, records).ok());
  const auto read = ReadMatches(MatchRecordsFilename(map));
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->size(), 2);
  EXPECT_EQ((*read)[1].SerializeAsString(), records[1].SerializeAsString());
  EXPECT_TRUE(std::ifstream(MatchCsvFilename(map)).good());
  // Those of an earlier run do not stay behind.
  ASSERT_TRUE(WriteMatchesBeside(map, {}).ok());
  EXPECT_EQ(ReadMatches(MatchRecordsFilename(map)).status().code(),
            absl::StatusCode::kNotFound);
  EXPECT_FALSE(std::ifstream(MatchCsvFilename(map)).good());
}

TEST(MatchFilesTest, DamageNamesTheFile) {
  const std::string name = testing::TempDir() + "/damaged.nodes.pb";
  std::ofstream(name) << "\x7f";
  const auto read = ReadMatches(name);
  EXPECT_EQ(read.status().code(), absl::StatusCode::kDataLoss);
  EXPECT_NE(read.status().message().find(name), absl::string_view::npos);
}

TEST(MatchFilesTest, TimesThatNoClockHasAreRefused) {
  const std::string map = testing::TempDir() + "/match_times.pbstream";
  for (const int64_t time :
       {std::numeric_limits<int64_t>::min(), int64_t{-1}, kMaxHostTicks + 1,
        std::numeric_limits<int64_t>::max()}) {
    std::vector<MatchRecord> records = {RecordAt(1000000000), MatchRecord()};
    records[1].set_time(time);
    ASSERT_TRUE(WriteMatchesBeside(map, records).ok());
    const auto read = ReadMatches(MatchRecordsFilename(map));
    EXPECT_EQ(read.status().code(), absl::StatusCode::kDataLoss);
    EXPECT_EQ(read.status().message(),
              absl::StrCat(MatchRecordsFilename(map), ": match record 1 is at ",
                           time, ", which no clock can show"));
  }
  ASSERT_TRUE(WriteMatchesBeside(map, {MatchRecord()}).ok());
  EXPECT_TRUE(ReadMatches(MatchRecordsFilename(map)).ok());
}

TEST(MatchFilesTest, MarksTheNodes) {
  MapGraph graph;
  for (int i = 0; i < 3; ++i) {
    GraphNode node;
    node.time = (i + 1) * 1000000000LL;
    node.local_pose = Pose2(i, 0., 0.1);
    node.global_pose = Pose2(0., i, 0.6);
    graph.nodes[GraphId{0, i}] = node;
  }
  MatchRecord degenerate = RecordAt(2000000000);
  degenerate.set_degeneracy(MatchRecord::TRANSLATION);
  degenerate.set_weak_direction(0.3);
  // Between two nodes, nearer to the last.
  MatchRecord fault = RecordAt(2800000000);
  fault.set_is_node(false);
  fault.set_odometry(MatchRecord::STALE);
  MatchRecord elsewhere = fault;
  elsewhere.set_builder(7);
  elsewhere.set_time(RecordAt(1000000000).time());
  MarkMatches({degenerate, fault, elsewhere, RecordAt(1000000000)}, &graph);
  const GraphNode& first = graph.nodes[GraphId{0, 0}];
  const GraphNode& second = graph.nodes[GraphId{0, 1}];
  const GraphNode& third = graph.nodes[GraphId{0, 2}];
  EXPECT_FALSE(first.weak_direction_is_known);
  EXPECT_FALSE(first.odometry_fault);
  ASSERT_TRUE(second.weak_direction_is_known);
  // Turned with the node from the local frame into the map.
  EXPECT_NEAR(second.weak_direction, 0.8, 1e-12);
  EXPECT_TRUE(third.odometry_fault);
}

TEST(MatchFilesTest, Counts) {
  std::vector<MatchRecord> records(5);
  records[0].set_degeneracy(MatchRecord::POSITION);
  records[1].set_searched(true);
  records[2].set_searched(true);
  records[2].set_source(MatchRecord::SEARCH);
  records[3].set_odometry(MatchRecord::JUMPING);
  records[4].set_odometry(MatchRecord::SLIP_SUSPECTED);
  records[4].set_time_offset(0.08);
  records[4].set_odometry_scale(0.98);
  records[4].set_rotation_per_metre(0.01);
  const MatchCounts counts = CountMatches(records);
  EXPECT_EQ(counts.scans, 5);
  EXPECT_EQ(counts.degenerate, 1);
  EXPECT_EQ(counts.searched, 2);
  EXPECT_EQ(counts.relocated, 1);
  EXPECT_EQ(counts.odometry_faults, 1);
  EXPECT_EQ(counts.slip_suspected, 1);
  EXPECT_EQ(counts.time_offset, 0.08);
  EXPECT_EQ(counts.odometry_scale, 0.98);
  EXPECT_EQ(counts.rotation_per_metre, 0.01);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
