// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/line_journal.h"

#include <unistd.h>

#include <fstream>
#include <iterator>

#include "cartographer_ext/io/keyed_journal.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const JournalKind kKind = {"test_key", "test journal", "test", "it differs"};

class LineJournalTest : public testing::Test {
 protected:
  ~LineJournalTest() override { unlink(filename_.c_str()); }

  absl::StatusOr<std::unique_ptr<LineJournal>> Open(
      const std::string& fingerprint) {
    values_.clear();
    return LineJournal::Open(filename_, kKind, fingerprint,
                             [this](const nlohmann::json& line) {
                               if (!line.is_object() || !line.contains("v")) {
                                 return absl::InvalidArgumentError("no v");
                               }
                               values_.push_back(line["v"]);
                               return absl::OkStatus();
                             });
  }
  std::string Content() const {
    std::ifstream stream(filename_);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  }
  void Append(const std::string& text) const {
    std::ofstream(filename_, std::ios::app) << text;
  }

  const std::string filename_ = testing::TempDir() + "line_journal_test";
  std::vector<int> values_;
};

TEST_F(LineJournalTest, GivesBackWhatWasAppendedAndCutsHalfALine) {
  {
    const auto journal = Open("f");
    ASSERT_TRUE(journal.ok()) << journal.status();
    ASSERT_TRUE((*journal)->Append({{"v", 1}}).ok());
    ASSERT_TRUE((*journal)->Append({{"v", 2}}).ok());
    EXPECT_THAT(std::string(Open("f").status().message()),
                HasSubstr("another test is writing to it"));
  }
  Append("{\"v\": 3");
  const auto journal = Open("f");
  ASSERT_TRUE(journal.ok()) << journal.status();
  EXPECT_TRUE((*journal)->was_torn());
  EXPECT_THAT(values_, ElementsAre(1, 2));
}

TEST_F(LineJournalTest, NamesLineAndCause) {
  ASSERT_TRUE(Open("f").ok());
  EXPECT_THAT(std::string(Open("g").status().message()),
              HasSubstr("is of another test: it differs"));
  Append("{\"w\": 3}\n");
  EXPECT_THAT(std::string(Open("f").status().message()),
              HasSubstr("line 2: no v"));
}

TEST_F(LineJournalTest, CutsNothingOffAFileThatIsNoJournal) {
  for (const std::string content : {"precious data without a line end",
                                    "{\"other\": 1}\nhalf", "a\nb\nc"}) {
    unlink(filename_.c_str());
    Append(content);
    EXPECT_THAT(std::string(Open("f").status().message()),
                HasSubstr("not a test journal"));
    EXPECT_EQ(Content(), content);
  }
}

TEST_F(LineJournalTest, ATornHeadIsBegunAgain) {
  Append("{\"test_key\":1,\"fing");
  ASSERT_TRUE(Open("f").ok());
  EXPECT_EQ(Content(), "{\"test_key\":1,\"fingerprint\":\"f\"}\n");
}

TEST_F(LineJournalTest, ItemsAreFoundByTheirKeys) {
  const auto parse = [](const nlohmann::json& line)
      -> absl::StatusOr<std::pair<std::string, int>> {
    if (!line.is_object() || !line.contains("v")) {
      return absl::InvalidArgumentError("no v");
    }
    return std::make_pair(line["k"].get<std::string>(), line["v"].get<int>());
  };
  {
    KeyedJournal<int> journal;
    ASSERT_TRUE(journal.Open(filename_, kKind, "f", parse).ok());
    EXPECT_EQ(journal.Find("a"), nullptr);
    for (const int v : {1, 2}) {
      ASSERT_TRUE(journal.Append({{"k", "a"}, {"v", v}}).ok());
    }
  }
  KeyedJournal<int> journal;
  ASSERT_TRUE(journal.Open(filename_, kKind, "f", parse).ok());
  ASSERT_NE(journal.Find("a"), nullptr);
  EXPECT_EQ(*journal.Find("a"), 2);
  EXPECT_EQ(journal.Find("b"), nullptr);
}

TEST_F(LineJournalTest, LinesWithoutAnItemAreNamed) {
  ASSERT_TRUE((*Open("f"))->Append({{"w", 1}}).ok());
  KeyedJournal<int> journal;
  const absl::Status status = journal.Open(
      filename_, kKind, "f",
      [](const nlohmann::json&) -> absl::StatusOr<std::pair<std::string, int>> {
        return absl::InvalidArgumentError("no v");
      });
  EXPECT_THAT(std::string(status.message()), HasSubstr("line 2: no v"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
