// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/map_record.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace collection {
namespace {

using testing::HasSubstr;
using testing::Not;

MapRecord MakeRecord() {
  MapRecord record;
  record.filename = "a \"b\",c.pbstream";
  record.verdict = "broken";
  record.reasons = {"parts lie across each other", "walls, thicker"};
  record.nodes = 1234;
  record.submaps = 12;
  record.loops = 56;
  record.path = 1. / 3.;
  record.severe_share = 0.1 + 0.2;
  record.open_cycles = 0.25;
  record.wall_doubling = 1.5;
  record.wrong_turns = 2;
  record.picture = "data:image/png;base64,AAAA";
  record.report = "reports/a.html";
  return record;
}

TEST(MapRecordTest, ReadsWhatItWrites) {
  const MapRecord record = MakeRecord();
  const auto read = RecordFromJson(
      nlohmann::json::parse(nlohmann::json(ToJson(record)).dump()));
  ASSERT_TRUE(read.ok()) << read.status();
  // To the last bit, so that a survey that goes on writes the same bytes.
  EXPECT_EQ(ToJson(*read), ToJson(record));
  EXPECT_EQ(read->severe_share, record.severe_share);
}

TEST(MapRecordTest, RefusesWhatIsNoRecord) {
  EXPECT_FALSE(RecordFromJson({{"filename", "a"}}).ok());
  EXPECT_FALSE(RecordFromJson(nlohmann::json::array()).ok());
  EXPECT_FALSE(RecordFromJson(nlohmann::json::parse("{", nullptr, false)).ok());
}

TEST(MapRecordTest, CsvQuotesNamesAndReasons) {
  EXPECT_THAT(ToCsv({MakeRecord()}),
              HasSubstr("\n\"a \"\"b\"\",c.pbstream\",broken,1234,12,56,0.333,"
                        "0.300000,0.250000,1.5000,2,\"parts lie across each "
                        "other; walls, thicker\"\n"));
}

TEST(MapRecordTest, LinesHaveNoPictures) {
  const std::string lines = ToJsonLines({MakeRecord(), MakeRecord()});
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 2);
  EXPECT_THAT(lines, Not(HasSubstr("base64")));
}

TEST(MapRecordTest, ADamagedFileIsAFailedAnswer) {
  const auto answer = AnswerMapRequest(
      {{"filename", testing::TempDir() + "no/such.pbstream"}, {"report", ""}});
  EXPECT_EQ(answer["ok"], false);
  EXPECT_THAT(answer["message"].get<std::string>(), HasSubstr("no/such"));
}

}  // namespace
}  // namespace collection
}  // namespace cartographer_ext
