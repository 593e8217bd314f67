// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/journal.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

RunRecord MakeRecord(const double value) {
  RunRecord record;
  record.assignment = {{"A.b", value}};
  record.input = "log.clf@12";
  record.ok = true;
  record.metrics = {{"relations", 0.5 * value}, {"cpu_seconds", 2.}};
  record.wall_seconds = 3.;
  record.cpu_seconds = 2.5;
  return record;
}

TEST(JournalTest, AnswersOfAnotherFormAreFailures) {
  RunRecord record = MakeRecord(1.);
  TakeAnswer({{"ok", true}, {"metrics", {{"ate", 0.5}, {"text", "t"}}}},
             &record);
  EXPECT_TRUE(record.ok);
  EXPECT_EQ(record.metrics, (std::map<std::string, double>{{"ate", 0.5}}));
  for (const nlohmann::json& metrics :
       {nlohmann::json(), nlohmann::json(3), nlohmann::json({1, 2})}) {
    TakeAnswer({{"ok", true}, {"metrics", metrics}}, &record);
    EXPECT_THAT(record.metrics, IsEmpty());
  }
  TakeAnswer({{"ok", true}}, &record);
  EXPECT_THAT(record.metrics, IsEmpty());
  TakeAnswer({{"ok", "true"}, {"message", 3}, {"cpu_seconds", "long"}},
             &record);
  EXPECT_FALSE(record.ok);
  EXPECT_EQ(record.message, "");
  EXPECT_EQ(record.cpu_seconds, 0.);
  TakeAnswer(3, &record);
  EXPECT_FALSE(record.ok);
}

TEST(JournalTest, KeepsWhatWasAppended) {
  const test::Folder folder;
  const std::string name = folder.path() + "/journal";
  {
    const auto journal = Journal::Open(name, "f");
    ASSERT_TRUE(journal.ok()) << journal.status();
    EXPECT_THAT((*journal)->runs(), IsEmpty());
    ASSERT_TRUE((*journal)->Append(MakeRecord(1.)).ok());
    RunRecord failed = MakeRecord(2.);
    failed.ok = false;
    failed.message = "it crashed";
    failed.fidelity = 1. / 3.;
    ASSERT_TRUE((*journal)->Append(failed).ok());
  }
  const auto journal = Journal::Open(name, "f");
  ASSERT_TRUE(journal.ok()) << journal.status();
  EXPECT_FALSE((*journal)->was_torn());
  ASSERT_EQ((*journal)->runs().size(), 2u);
  const RunRecord& first = (*journal)->runs()[0];
  EXPECT_EQ(RunKey(first), RunKey(MakeRecord(1.)));
  EXPECT_TRUE(first.ok);
  EXPECT_EQ(first.metrics.at("relations"), 0.5);
  EXPECT_EQ(first.cpu_seconds, 2.5);
  const RunRecord& second = (*journal)->runs()[1];
  EXPECT_FALSE(second.ok);
  EXPECT_EQ(second.message, "it crashed");
  EXPECT_NE(RunKey(second), RunKey(MakeRecord(2.)));  // of another fidelity
}

TEST(JournalTest, HalfALineAtTheEndIsCutOff) {
  const test::Folder folder;
  const std::string name = folder.path() + "/journal";
  { ASSERT_TRUE((*Journal::Open(name, "f"))->Append(MakeRecord(1.)).ok()); }
  const std::string whole = folder.Read("journal");
  const size_t header = whole.find('\n') + 1;
  // Wherever the second line was cut, and the first one, too.
  for (size_t size = 1; size < whole.size(); size += 7) {
    folder.Write("journal", whole.substr(0, size));
    const auto journal = Journal::Open(name, "f");
    ASSERT_TRUE(journal.ok()) << size << journal.status();
    EXPECT_EQ((*journal)->was_torn(), size != header);
    EXPECT_THAT((*journal)->runs(), IsEmpty());
    ASSERT_TRUE((*journal)->Append(MakeRecord(1.)).ok());
    EXPECT_EQ(folder.Read("journal"), whole) << size;
  }
}

TEST(JournalTest, RefusesWhatIsNoJournalOfThisSearch) {
  const test::Folder folder;
  const auto error = [&](const std::string& content) {
    const auto journal = Journal::Open(folder.Write("journal", content), "f");
    EXPECT_FALSE(journal.ok()) << content;
    return std::string(journal.status().message());
  };
  const std::string header =
      "{\"cartographer_ext_tune\":1,\"fingerprint\":\"f\"}\n";
  EXPECT_THAT(error("hello\n"), HasSubstr("journal: line 1: not a tuning"));
  EXPECT_THAT(error("{\"cartographer_ext_tune\":9,\"fingerprint\":\"f\"}\n"),
              HasSubstr("another version"));
  EXPECT_THAT(error("{\"cartographer_ext_tune\":1,\"fingerprint\":\"g\"}\n"),
              HasSubstr("another search"));
  EXPECT_THAT(error(header + "{\"half\":\n{}\n"), HasSubstr("line 2"));
  EXPECT_THAT(error(header + "{\"values\":{},\"input\":3,\"fidelity\":1,"
                             "\"status\":\"ok\",\"metrics\":{}}\n"),
              HasSubstr("line 2: not a run"));
  // Deep enough to overflow a stack.
  EXPECT_THAT(error(header + "{\"values\":{\"a\":" + std::string(1000000, '[') +
                    std::string(1000000, ']') +
                    "},\"input\":\"a\",\"fidelity\":1,"
                    "\"status\":\"ok\",\"metrics\":{}}\n"),
              HasSubstr("line 2: not a run"));
  EXPECT_FALSE(Journal::Open(folder.path(), "f").ok());  // a folder
  EXPECT_THAT(std::string(Journal::Open("/dev/null", "f").status().message()),
              HasSubstr("not a plain file"));
  EXPECT_FALSE(Journal::Open(folder.path() + "/no/journal", "f").ok());
}

TEST(JournalTest, OneSearchAtATime) {
  const test::Folder folder;
  const std::string name = folder.path() + "/journal";
  const auto first = Journal::Open(name, "f");
  ASSERT_TRUE(first.ok());
  EXPECT_THAT(std::string(Journal::Open(name, "f").status().message()),
              HasSubstr("another search is writing"));
}

TEST(JournalTest, AFullDiskIsAnErrorAndLosesNothing) {
  const test::Folder folder;
  const std::string name = folder.path() + "/journal";
  const pid_t child = fork();
  if (child == 0) {
    // As much as fits two records and a half.
    signal(SIGXFSZ, SIG_IGN);
    const auto journal = Journal::Open(name, "f");
    const size_t line = ToJson(MakeRecord(1.)).dump().size() + 1;
    const rlim_t size =
        folder.Read("journal").size() + static_cast<rlim_t>(5 * line / 2);
    const struct rlimit limit = {size, size};
    setrlimit(RLIMIT_FSIZE, &limit);
    bool ok = true;
    int written = 0;
    while (ok && written < 10) {
      ok = (*journal)->Append(MakeRecord(1.)).ok();
      written += ok;
    }
    _exit(written);
  }
  int state = 0;
  waitpid(child, &state, 0);
  ASSERT_TRUE(WIFEXITED(state));
  EXPECT_EQ(WEXITSTATUS(state), 2);
  const auto journal = Journal::Open(name, "f");
  ASSERT_TRUE(journal.ok()) << journal.status();
  EXPECT_TRUE((*journal)->was_torn());
  EXPECT_EQ((*journal)->runs().size(), 2u);
}

TEST(JournalTest, WithoutAFileNothingIsKept) {
  const auto journal = Journal::Open("", "f");
  ASSERT_TRUE(journal.ok());
  EXPECT_TRUE((*journal)->Append(MakeRecord(1.)).ok());
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
