// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_log.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "gmock/gmock.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"
#include "google/protobuf/util/delimited_message_util.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using testing::HasSubstr;

LoopDecision Example(int64_t candidate) {
  LoopDecision decision;
  decision.set_candidate(candidate);
  decision.set_submap_index(4);
  decision.set_node_index(17);
  decision.set_verdict(LoopDecision::REJECTED);
  decision.set_reason(LoopDecision::LOW_TEMPORAL_SCORE);
  decision.mutable_search()->set_grid_score(0.625);
  decision.mutable_temporal()->set_score(0.25);
  decision.mutable_temporal()->set_threshold(0.5);
  return decision;
}

// Column name to cell of the given line.
std::map<std::string, std::string> Row(const std::string& csv, int line) {
  const std::vector<std::string> lines = absl::StrSplit(csv, '\n');
  const std::vector<std::string> names = absl::StrSplit(lines[0], ',');
  const std::vector<std::string> cells = absl::StrSplit(lines[line], ',');
  EXPECT_EQ(names.size(), cells.size());
  std::map<std::string, std::string> row;
  for (size_t k = 0; k < std::min(names.size(), cells.size()); ++k) {
    EXPECT_TRUE(row.emplace(names[k], cells[k]).second) << names[k];
  }
  return row;
}

TEST(DecisionLogTest, TimesAreUnixSeconds) {
  LoopDecision decision = Example(1);
  // 2005-12-18 00:10:29.8951823 UTC.
  decision.set_node_time(
      (INT64_C(1134864629) + INT64_C(62135596800)) * 10000000 + 8951823);
  EXPECT_EQ(Row(DecisionCsv({decision}), 1)["node_time"], "1134864629.8951823");
}

TEST(DecisionLogTest, EveryColumnIsDocumented) {
  std::ifstream stream("docs/side_files.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), {});
  for (const absl::string_view column :
       absl::StrSplit(absl::StripSuffix(DecisionCsvHead(), "\n"), ',')) {
    EXPECT_THAT(page, HasSubstr("`" + std::string(column) + "`"));
  }
}

TEST(DecisionLogTest, BytesComeBack) {
  std::string bytes;
  for (int k = 0; k < 3; ++k) AppendDecision(Example(k), &bytes);
  const auto decisions = ParseDecisions(bytes);
  ASSERT_TRUE(decisions.ok());
  ASSERT_EQ(decisions->size(), 3u);
  EXPECT_EQ((*decisions)[2].SerializeAsString(),
            Example(2).SerializeAsString());
  EXPECT_TRUE(ParseDecisions("")->empty());
}

TEST(DecisionLogTest, BytesAreWhatProtobufReads) {
  LoopDecision longer = Example(1);
  for (int k = 0; k < 100; ++k) longer.mutable_information()->add_matrix(k);
  std::string bytes;
  AppendDecision(longer, &bytes);  // more than 127 bytes
  AppendDecision(Example(2), &bytes);
  google::protobuf::io::ArrayInputStream stream(bytes.data(),
                                                static_cast<int>(bytes.size()));
  LoopDecision decision;
  bool clean_end = false;
  ASSERT_TRUE(google::protobuf::util::ParseDelimitedFromZeroCopyStream(
      &decision, &stream, &clean_end));
  EXPECT_EQ(decision.information().matrix_size(), 100);
  ASSERT_TRUE(google::protobuf::util::ParseDelimitedFromZeroCopyStream(
      &decision, &stream, &clean_end));
  EXPECT_EQ(decision.candidate(), 2);
}

TEST(DecisionLogTest, DamageIsReported) {
  std::string bytes;
  AppendDecision(Example(1), &bytes);
  AppendDecision(Example(2), &bytes);
  const size_t half = bytes.size() / 2;
  for (size_t cut = 1; cut < bytes.size(); ++cut) {
    const auto decisions = ParseDecisions(bytes.substr(0, cut));
    EXPECT_EQ(decisions.ok(), cut == half) << cut;
  }
  EXPECT_THAT(ParseDecisions(bytes.substr(0, half + 2)).status().ToString(),
              HasSubstr("at byte " + std::to_string(half)));
  EXPECT_FALSE(ParseDecisions(std::string(20, '\xff')).ok());
  // A field with a wire type that does not exist.
  EXPECT_THAT(ParseDecisions(std::string("\x01\x0f", 2)).status().ToString(),
              HasSubstr("does not decode"));
}

TEST(DecisionLogTest, TableHasOneLineForEachCandidate) {
  LoopDecision skipped;
  skipped.set_candidate(9);
  skipped.set_verdict(LoopDecision::REJECTED);
  skipped.set_reason(LoopDecision::SKIPPED_BUDGET);
  const std::string csv = DecisionCsv({Example(8), skipped});
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  auto row = Row(csv, 1);
  EXPECT_EQ(row["candidate"], "8");
  EXPECT_EQ(row["submap"], "4");
  EXPECT_EQ(row["node"], "17");
  EXPECT_EQ(row["verdict"], "rejected");
  EXPECT_EQ(row["reason"], "low_temporal_score");
  EXPECT_EQ(row["grid_score"], "0.625");
  EXPECT_EQ(row["temporal_outcome"], "scored");
  EXPECT_EQ(row["temporal_score"], "0.25");
  EXPECT_EQ(row["threshold"], "0.5");
  EXPECT_EQ(row["final_score"], "");
  EXPECT_EQ(row["probability"], "");
  EXPECT_EQ(row["support"], "");
  row = Row(csv, 2);
  EXPECT_EQ(row["reason"], "skipped_budget");
  EXPECT_EQ(row["grid_score"], "");
}

TEST(DecisionLogTest, WithoutATemporalScoreTheCellIsEmpty) {
  LoopDecision decision = Example(1);
  decision.mutable_temporal()->set_outcome(
      LoopDecision::Temporal::PATH_UNKNOWN);
  auto row = Row(DecisionCsv({decision}), 1);
  EXPECT_EQ(row["temporal_outcome"], "path_unknown");
  EXPECT_EQ(row["temporal_score"], "");
  decision.set_reason(static_cast<LoopDecision::Reason>(1000));
  EXPECT_EQ(Row(DecisionCsv({decision}), 1)["reason"], "1000");
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
