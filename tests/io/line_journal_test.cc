// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/line_journal.h"

#include <unistd.h>

#include <fstream>
#include <iterator>

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

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
