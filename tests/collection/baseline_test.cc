// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/baseline.h"

#include <unistd.h>

#include <fstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace collection {
namespace {

using testing::HasSubstr;

MapRecord Record(const std::string& filename, const std::string& verdict) {
  MapRecord record;
  record.filename = filename;
  record.verdict = verdict;
  return record;
}

TEST(BaselineTest, ComparesBySeverity) {
  const std::map<std::string, MapRecord> baseline = {
      {"a", Record("a", "sound")},
      {"b", Record("b", "broken")},
      {"c", Record("c", "broken")},
      {"d", Record("d", "unknown")},
      {"gone", Record("gone", "sound")}};
  const auto changes =
      Compare(baseline, {Record("a", "doubtful"), Record("b", "failed"),
                         Record("c", "sound"), Record("d", "sound"),
                         Record("new", "broken")});
  std::map<std::string, std::string> kinds;
  for (const MapChange& change : changes) kinds[change.filename] = change.kind;
  EXPECT_EQ(kinds, (std::map<std::string, std::string>{{"a", "worse"},
                                                       {"b", "worse"},
                                                       {"c", "better"},
                                                       {"d", "same"},
                                                       {"gone", "gone"},
                                                       {"new", "new"}}));
}

TEST(BaselineTest, ReadsTheLinesOfASurvey) {
  const std::string filename = testing::TempDir() + "baseline_test.jsonl";
  std::ofstream(filename) << ToJsonLines(
      {Record("a", "sound"), Record("b", "broken")});
  const auto baseline = ReadBaseline(filename);
  ASSERT_TRUE(baseline.ok()) << baseline.status();
  EXPECT_EQ(baseline->size(), 2u);
  EXPECT_EQ(baseline->at("b").verdict, "broken");

  std::ofstream(filename, std::ios::app) << "{\"filename\":\n";
  EXPECT_THAT(std::string(ReadBaseline(filename).status().message()),
              HasSubstr("baseline_test.jsonl:3: not a record"));
  unlink(filename.c_str());
  EXPECT_FALSE(ReadBaseline(filename).ok());
}

TEST(BaselineTest, HostileLinesAreRefused) {
  const std::string filename = testing::TempDir() + "baseline_deep.jsonl";
  std::ofstream(filename) << ToJsonLines({Record("a", "sound")})
                          << "{\"filename\": " << std::string(1000000, '[')
                          << "\n";
  EXPECT_THAT(std::string(ReadBaseline(filename).status().message()),
              HasSubstr("baseline_deep.jsonl:2: not a record"));
  // Counts that no map has.
  std::ofstream(filename) << R"({"filename": "a", "verdict": "sound",)"
                          << R"("nodes": 1e300, "loops": -1, "submaps": 3})"
                          << "\n";
  const auto baseline = ReadBaseline(filename);
  ASSERT_TRUE(baseline.ok()) << baseline.status();
  EXPECT_EQ(baseline->at("a").nodes, 0);
  EXPECT_EQ(baseline->at("a").loops, 0);
  EXPECT_EQ(baseline->at("a").submaps, 3);
  unlink(filename.c_str());
}

}  // namespace
}  // namespace collection
}  // namespace cartographer_ext
