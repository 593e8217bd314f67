// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The command cartographer_ext_evaluate over many maps.
#include <signal.h>
#include <sys/wait.h>

#include <filesystem>
#include <sstream>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

// Sound maps and three damaged ones in a folder of their own.
class EvaluateManyTest : public testing::Test {
 protected:
  void SetUp() override {
    WriteRoomMap(folder_, 120);
    std::filesystem::create_directories(folder_ / "maps/sub");
    whole_ = ReadFile(folder_ / "room.pbstream");
    for (const char* const name :
         {"maps/a.pbstream", "maps/sub/b.pbstream", "maps/sub/c.pbstream"}) {
      WriteFile(folder_ / name, whole_);
    }
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_ / "maps");
    std::filesystem::remove_all(folder_ / "reports");
  }

  void AddDamagedMaps() {
    WriteFile(folder_ / "maps/cut.pbstream", whole_.substr(0, 5000));
    WriteFile(folder_ / "maps/empty.pbstream", "");
    std::string flipped = whole_;
    for (size_t i = 40; i < flipped.size(); i += 97) flipped[i] ^= 0x5a;
    WriteFile(folder_ / "maps/flipped.pbstream", flipped);
  }

  CommandResult Evaluate(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {folder_ / "maps"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand("evaluate", arguments);
  }

  TemporaryFolder folder_;
  std::string whole_;
};

TEST_F(EvaluateManyTest, DamagedMapsStopNoOtherAndWorkersChangeNoByte) {
  AddDamagedMaps();
  for (const std::string workers : {"1", "2"}) {
    const CommandResult result = Evaluate(
        {"-workers", workers, "-report_filename", folder_ / (workers + ".html"),
         "-csv_filename", folder_ / (workers + ".csv"), "-json_lines_filename",
         folder_ / (workers + ".jsonl"), "-json", folder_ / (workers + ".json"),
         "-fail_on", "broken"});
    EXPECT_EQ(result.exit_code, 1) << result.error;
    EXPECT_THAT(result.error, HasSubstr("3 of 6 maps could not be judged"));
    EXPECT_THAT(result.error, HasSubstr("maps/cut.pbstream: "));
    EXPECT_THAT(result.out, HasSubstr("6 maps: 3 failed"));
  }
  for (const std::string ending : {".html", ".csv", ".jsonl", ".json"}) {
    const std::string one = ReadFile(folder_ / ("1" + ending));
    EXPECT_FALSE(one.empty());
    EXPECT_TRUE(one == ReadFile(folder_ / ("2" + ending))) << ending;
  }
  const auto json = ParseJson(ReadFile(folder_ / "1.json"));
  ASSERT_EQ(json["maps"].size(), 6u);
  EXPECT_EQ(json["verdicts"]["failed"], 3);
  EXPECT_EQ(json["maps"][0]["filename"], folder_ / "maps/a.pbstream");
}

TEST_F(EvaluateManyTest, AJobArrayWritesTheSame) {
  const CommandResult alone =
      Evaluate({"-workers", "1", "-json_lines_filename", folder_ / "1.jsonl"});
  ASSERT_EQ(alone.exit_code, 0) << alone.error;
  const TemporaryFolder job;
  std::vector<CommandResult> results(2);
  std::thread other([&]() {
    results[1] = Evaluate(
        {"-workers", "1", "-job_folder", job.path(), "-job_task", "1"});
  });
  results[0] =
      Evaluate({"-workers", "1", "-job_folder", job.path(), "-job_task", "0",
                "-json_lines_filename", folder_ / "2.jsonl"});
  other.join();
  for (const CommandResult& result : results) {
    EXPECT_EQ(result.exit_code, 0) << result.error;
  }
  EXPECT_TRUE(ReadFile(folder_ / "1.jsonl") == ReadFile(folder_ / "2.jsonl"));
  EXPECT_FALSE(ReadFile(job / "journal.jsonl").empty());
}

TEST_F(EvaluateManyTest, ReportsBaselineAndExitCodes) {
  const CommandResult first = Evaluate(
      {"-reports_directory", folder_ / "reports", "-report_filename",
       folder_ / "all.html", "-json_lines_filename", folder_ / "before.jsonl"});
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_THAT(ReadFile(folder_ / "all.html"), HasSubstr("href=\"reports/"));
  EXPECT_EQ(
      std::distance(std::filesystem::directory_iterator(folder_ / "reports"),
                    std::filesystem::directory_iterator()),
      3);
  const CommandResult same =
      Evaluate({"-baseline", folder_ / "before.jsonl", "-fail_on", "worse"});
  EXPECT_EQ(same.exit_code, 0) << same.error;

  WriteFile(folder_ / "maps/a.pbstream", "x");
  const CommandResult worse =
      Evaluate({"-baseline", folder_ / "before.jsonl", "-fail_on", "worse"});
  EXPECT_EQ(worse.exit_code, 1);  // it cannot be read any more
  EXPECT_THAT(worse.out, HasSubstr("maps/a.pbstream: worse, was "));
}

TEST_F(EvaluateManyTest, TakesSeveralNamesAndRefusesWhatIsForOneMap) {
  const CommandResult two = RunCommand(
      "evaluate",
      {folder_ / "maps/a.pbstream", folder_ / "maps/sub/*.pbstream"});
  EXPECT_EQ(two.exit_code, 0) << two.error;
  EXPECT_THAT(two.out, HasSubstr("3 maps: "));
  EXPECT_EQ(Evaluate({"-relations_filename", "x"}).exit_code, 2);
  EXPECT_EQ(Evaluate({"-fail_on", "sound"}).exit_code, 2);
  EXPECT_EQ(Evaluate({"-fail_on", "worse"}).exit_code, 2);
  EXPECT_EQ(RunCommand("evaluate", {folder_ / "maps/a.pbstream",
                                    "-journal_filename", folder_ / "j"})
                .exit_code,
            2);
  const CommandResult replaced =
      Evaluate({"-csv_filename", folder_ / "maps/a.pbstream"});
  EXPECT_EQ(replaced.exit_code, 1);
  EXPECT_TRUE(ReadFile(folder_ / "maps/a.pbstream") == whole_);
}

TEST_F(EvaluateManyTest, GoesOnAfterItWasKilled) {
  for (int i = 0; i < 12; ++i) {
    WriteFile(folder_ / ("maps/" + std::to_string(i) + ".pbstream"), whole_);
  }
  const std::string journal = folder_ / "journal";
  const std::string program =
      std::string(CARTOGRAPHER_EXT_BIN_DIR) + "/cartographer_ext_evaluate";
  const std::string maps = folder_ / "maps";
  const pid_t child = fork();
  if (child == 0) {
    const int null_device = open("/dev/null", O_RDWR);
    dup2(null_device, STDOUT_FILENO);
    execl(program.c_str(), program.c_str(), maps.c_str(), "-workers", "1",
          "-journal_filename", journal.c_str(), nullptr);
    _exit(127);
  }
  const auto lines = [&journal] {
    const std::string text = ReadFile(journal);
    return std::count(text.begin(), text.end(), '\n');
  };
  while (lines() < 4 && waitpid(child, nullptr, WNOHANG) == 0) usleep(1000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const int64_t kept = lines();
  ASSERT_GE(kept, 4);
  const CommandResult again =
      Evaluate({"-journal_filename", journal, "-report_filename",
                folder_ / "again.html", "-workers", "2"});
  ASSERT_EQ(again.exit_code, 0) << again.error;
  EXPECT_EQ(lines(), 1 + 15);  // nothing twice
  const CommandResult once =
      Evaluate({"-report_filename", folder_ / "once.html"});
  ASSERT_EQ(once.exit_code, 0) << once.error;
  EXPECT_TRUE(ReadFile(folder_ / "again.html") ==
              ReadFile(folder_ / "once.html"));
}

// Overview, JSON, page and exit code of real maps: one verdict, one reason.
TEST(EvaluateAllMapsTest, OneVerdictInEveryOutput) {
  CARTOGRAPHER_EXT_SKIP_WITHOUT(SharedData("pbstream"));
  CARTOGRAPHER_EXT_SKIP_WITHOUT(SharedData("wild"));
  const TemporaryFolder folder;
  const CommandResult result = RunCommand(
      "evaluate",
      {SharedData("pbstream"), SharedData("wild"), "-reports_directory",
       folder / "pages", "-report_filename", folder / "all.html",
       "-json_lines_filename", folder / "all.jsonl", "-fail_on", "broken"});
  const std::string overview = ReadFile(folder / "all.html");
  std::istringstream lines(ReadFile(folder / "all.jsonl"));
  std::string line;
  int count = 0;
  bool any_broken = false;
  while (std::getline(lines, line)) {
    const auto json = ParseJson(line);
    ASSERT_TRUE(json.is_object()) << line;
    ++count;
    const std::string word = json["verdict"];
    any_broken = any_broken || word == "broken";
    EXPECT_THAT(overview, HasSubstr("<tr data-verdict=\"" + word + "\">"));
    const std::string page = ReadFile(json["report"]);
    EXPECT_THAT(page, HasSubstr("<div class=\"verdict " + word + "\">"));
    EXPECT_THAT(page, HasSubstr("Map " + word + "<"));
    const std::string headline = json["reasons"][0];
    const bool is_consistent =
        headline.find("self-consistent") != std::string::npos;
    EXPECT_EQ(is_consistent, word == "sound") << line;
    for (const std::string reason : json["reasons"]) {
      EXPECT_THAT(page, HasSubstr("<li>" + reason + "</li>"));
      EXPECT_THAT(overview, HasSubstr(reason));
      for (const std::string other : {"sound", "doubtful", "broken"}) {
        if (other == word) continue;
        EXPECT_THAT(reason, testing::Not(HasSubstr(other))) << line;
      }
    }
  }
  EXPECT_GE(count, 9);
  EXPECT_EQ(result.exit_code, any_broken ? 3 : 0) << result.error;
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
