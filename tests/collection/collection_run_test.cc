// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/collection_run.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace collection {
namespace {

using testing::HasSubstr;

CollectionResult MakeResult(const std::vector<std::string>& verdicts) {
  CollectionResult result;
  for (const std::string& verdict : verdicts) {
    MapRecord record;
    record.filename = verdict + ".pbstream";
    record.verdict = verdict;
    record.reasons = {"it is " + verdict};
    result.records.push_back(record);
  }
  return result;
}

TEST(CollectionRunTest, FailsOnWhatIsAsBadOrWorse) {
  EXPECT_FALSE(FailsOn(MakeResult({"broken"}), ""));
  EXPECT_FALSE(FailsOn(MakeResult({"sound", "doubtful", "unknown"}), "broken"));
  EXPECT_TRUE(FailsOn(MakeResult({"sound", "broken"}), "broken"));
  EXPECT_TRUE(FailsOn(MakeResult({"doubtful"}), "doubtful"));
  EXPECT_TRUE(FailsOn(MakeResult({"broken"}), "doubtful"));
  EXPECT_FALSE(FailsOn(MakeResult({"sound", "unknown"}), "doubtful"));
}

TEST(CollectionRunTest, FailsOnWhatHasBecomeWorse) {
  CollectionResult result = MakeResult({"broken"});
  result.changes = {{"broken.pbstream", "broken", "broken", "same"}};
  EXPECT_FALSE(FailsOn(result, "worse"));
  result.changes = {{"broken.pbstream", "doubtful", "broken", "worse"}};
  EXPECT_TRUE(FailsOn(result, "worse"));
}

TEST(CollectionRunTest, KnowsItsWords) {
  for (const char* const word : {"", "broken", "doubtful", "worse"}) {
    EXPECT_TRUE(IsFailOn(word));
  }
  EXPECT_FALSE(IsFailOn("sound"));
}

TEST(CollectionRunTest, NamesWhatCouldNotBeJudged) {
  EXPECT_TRUE(CheckAllJudged(MakeResult({"broken"}).records).ok());
  EXPECT_THAT(
      std::string(
          CheckAllJudged(MakeResult({"sound", "failed"}).records).message()),
      HasSubstr("1 of 2 maps could not be judged:\n  failed.pbstream: it is"));
}

TEST(CollectionRunTest, TellsCountsInTextAndJson) {
  const CollectionResult result = MakeResult({"sound", "broken", "broken"});
  EXPECT_THAT(ToText(result), HasSubstr("3 maps: 2 broken, 1 sound"));
  EXPECT_EQ(ToJson(result)["verdicts"]["broken"], 2);
}

}  // namespace
}  // namespace collection
}  // namespace cartographer_ext
