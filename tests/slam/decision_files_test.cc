// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/decision_files.h"

#include <cstdint>
#include <fstream>
#include <limits>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/host_ticks.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using proto::LoopDecision;

std::vector<LoopDecision> Some() {
  std::vector<LoopDecision> decisions(5);
  decisions[0].set_verdict(LoopDecision::ACCEPTED);
  decisions[0].set_reason(LoopDecision::CONFIRMED_BY_SUBSET);
  decisions[1].set_verdict(LoopDecision::REJECTED);
  decisions[1].set_reason(LoopDecision::CONTRADICTED);
  decisions[2].set_verdict(LoopDecision::REJECTED);
  decisions[2].set_reason(LoopDecision::LOW_GRID_SCORE);
  decisions[3].set_verdict(LoopDecision::REJECTED);
  decisions[3].set_reason(LoopDecision::SKIPPED_SPACING);
  decisions[4].set_verdict(LoopDecision::UNDECIDED);
  decisions[4].set_reason(LoopDecision::UNSUPPORTED);
  for (int i = 0; i < 5; ++i) decisions[i].set_candidate(i);
  return decisions;
}

TEST(DecisionFilesTest, NamesStandBesideTheMap) {
  EXPECT_EQ(DecisionRecordsFilename("a/run.pbstream"), "a/run.loops.pb");
  EXPECT_EQ(DecisionCsvFilename("a/run.pbstream"), "a/run.loops.csv");
  EXPECT_EQ(DecisionRecordsFilename("run.map"), "run.map.loops.pb");
}

TEST(DecisionFilesTest, WritesReadsAndRemoves) {
  const std::string map = testing::TempDir() + "/decision_files_test.pbstream";
  loop_closure::DecisionRecords records;
  for (const LoopDecision& decision : Some()) records.Add(decision);
  EXPECT_EQ(CountDecisions(records).rejected, 1);
  ASSERT_TRUE(WriteDecisionsBeside(map, records).ok());
  const auto read = ReadDecisions(DecisionRecordsFilename(map));
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->size(), 5u);
  EXPECT_EQ((*read)[4].candidate(), 4);
  std::ifstream csv(DecisionCsvFilename(map));
  int lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_EQ(lines, 6);
  // A run without our loop closure leaves nothing of an earlier one.
  ASSERT_TRUE(WriteDecisionsBeside(map, {}).ok());
  EXPECT_EQ(ReadDecisions(DecisionRecordsFilename(map)).status().code(),
            absl::StatusCode::kNotFound);
}

TEST(DecisionFilesTest, DamagedRecordsAreAnError) {
  const std::string name = testing::TempDir() + "/damaged.loops.pb";
  std::ofstream(name) << "\x7fjunk";
  const auto read = ReadDecisions(name);
  EXPECT_EQ(read.status().code(), absl::StatusCode::kDataLoss);
  EXPECT_NE(std::string(read.status().message()).find(name), std::string::npos);
}

TEST(DecisionFilesTest, TimesThatNoClockHasAreRefused) {
  const std::string map = testing::TempDir() + "/decision_times.pbstream";
  const auto write = [&map](const int64_t time) {
    std::vector<LoopDecision> decisions = Some();
    decisions[3].set_node_time(time);
    loop_closure::DecisionRecords records;
    for (const LoopDecision& decision : decisions) records.Add(decision);
    return WriteDecisionsBeside(map, records);
  };
  const std::string name = DecisionRecordsFilename(map);
  for (const int64_t time :
       {std::numeric_limits<int64_t>::min(), int64_t{-1}, kMaxHostTicks + 1,
        std::numeric_limits<int64_t>::max()}) {
    ASSERT_TRUE(write(time).ok());
    const auto read = ReadDecisions(name);
    EXPECT_EQ(read.status().code(), absl::StatusCode::kDataLoss);
    EXPECT_EQ(read.status().message(),
              absl::StrCat(name, ": decision record 3 is at ", time,
                           ", which no clock can show"));
  }
  ASSERT_TRUE(write(kUnixEpochTicks).ok());
  EXPECT_TRUE(ReadDecisions(name).ok());
}

TEST(DecisionFilesTest, CountsKinds) {
  const DecisionCounts counts = CountDecisions(Some());
  EXPECT_EQ(counts.accepted, 1);
  EXPECT_EQ(counts.rejected, 1);
  EXPECT_EQ(counts.not_found, 1);
  EXPECT_EQ(counts.skipped, 1);
  EXPECT_EQ(counts.undecided, 1);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
