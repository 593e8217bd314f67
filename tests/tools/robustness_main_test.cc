// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The command cartographer_ext_robustness.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "gmock/gmock.h"
#include "tests/test_data.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace {

using test::CommandResult;
using test::RunCommand;
using ::testing::HasSubstr;

TEST(RobustnessMainTest, SweepIsResumed) {
  const std::string file = test::SharedData("g2o/intel.g2o.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
  const test::TemporaryFolder folder;
  const std::vector<std::string> arguments = {"-datasets",
                                              file,
                                              "-kernels",
                                              "r_isam,dcs",
                                              "-outlier_types",
                                              "R,LG",
                                              "-outlier_counts",
                                              "200,50%",
                                              "-journal_filename",
                                              folder / "journal.jsonl",
                                              "-picture_filename",
                                              folder / "plot.png",
                                              "-json",
                                              "-"};
  CommandResult result = RunCommand("robustness", arguments);
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const nlohmann::json json = test::ParseJson(result.out);
  ASSERT_EQ(json["runs"].size(), 8u);
  for (const nlohmann::json& run : json["runs"]) {
    for (const char* key :
         {"dataset", "kernel", "type", "count", "seed", "cpu_seconds", "ate",
          "rpe", "precision", "recall", "success"}) {
      EXPECT_TRUE(run.contains(key)) << key;
    }
    EXPECT_EQ(run["dataset"], "intel");
    EXPECT_TRUE(run["success"]);
    EXPECT_TRUE(run["count"] == 200 || run["count"] == 895);
  }
  EXPECT_THAT(test::ReadFile(folder / "plot.png"), HasSubstr("PNG"));
  // Half of the last line is lost; the rest is not run again.
  const std::string journal = test::ReadFile(folder / "journal.jsonl");
  test::WriteFile(folder / "journal.jsonl",
                  journal.substr(0, journal.size() - 40));
  result = RunCommand("robustness", arguments);
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const nlohmann::json again = test::ParseJson(result.out);
  ASSERT_EQ(again["runs"].size(), 8u);
  EXPECT_EQ(again["runs"][0]["cpu_seconds"], json["runs"][0]["cpu_seconds"]);
  EXPECT_EQ(RunCommand("robustness", arguments).exit_code, 0);
}

TEST(RobustnessMainTest, FamiliesAreGeneratedBySeed) {
  const CommandResult result = RunCommand(
      "robustness", {"-family", "star,few", "-first_seed", "5", "-seeds", "2",
                     "-kernels", "auto", "-outlier_types", "none,L",
                     "-outlier_counts", "20%", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const nlohmann::json json = test::ParseJson(result.out);
  ASSERT_EQ(json["runs"].size(), 8u);
  EXPECT_EQ(json["runs"][0]["dataset"], "star");
  EXPECT_EQ(json["runs"][0]["family"], "star");
  EXPECT_EQ(json["runs"][0]["seed"], 5);
  EXPECT_EQ(json["runs"][1]["seed"], 6);
  EXPECT_EQ(json["runs"][0]["count"], 0);
  EXPECT_GE(json["runs"][0]["recall"], 0.9);
  EXPECT_EQ(json["limits"].size(), 4u);
  EXPECT_TRUE(json["limits"][0].contains("undecidable_from"));
  EXPECT_EQ(RunCommand("robustness", {"-family", "moon"}).exit_code, 2);
}

TEST(RobustnessMainTest, ComparesCosts) {
  const CommandResult result =
      RunCommand("robustness", {"-compare_cost", "-family", "few",
                                "-first_seed", "5", "-outlier_types", "none,L",
                                "-outlier_counts", "20%", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const nlohmann::json json = test::ParseJson(result.out);
  EXPECT_EQ(json["graphs"], 2);
  EXPECT_EQ(json["above"], 0);
  EXPECT_EQ(json["comparisons"][1]["seed"], 5);
}

TEST(RobustnessMainTest, BadInputAndUsage) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(RunCommand("robustness", {"-preset", "nothing"}).exit_code, 2);
  EXPECT_EQ(RunCommand("robustness", {"-seeds", "0"}).exit_code, 2);
  CommandResult result =
      RunCommand("robustness", {"-datasets", folder / "missing.g2o"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("missing.g2o"));
  EXPECT_EQ(RunCommand("robustness", {"-kernels", "magic"}).exit_code, 2);
  EXPECT_EQ(RunCommand("robustness", {"-outlier_types", "X"}).exit_code, 2);
  result = RunCommand("robustness", {"-datasets="});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error,
              HasSubstr("neither -datasets nor -family names graphs"));
  result = RunCommand("robustness",
                      {"-datasets=", "-family=few", "-outlier_counts="});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error, HasSubstr("-outlier_counts names nothing"));
  result = RunCommand("robustness", {"-datasets=", "-family=few",
                                     "-outlier_types=none", "-kernels=none"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  test::WriteFile(folder / "journal", "something else\nand more\n");
  result = RunCommand("robustness", {"-journal_filename", folder / "journal"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error,
              HasSubstr("journal: line 1: not a robustness journal"));
}

TEST(RobustnessMainTest, AJournalIsKeptByOneSweepInAFile) {
  const test::TemporaryFolder folder;
  const auto sweep = [](const std::string& journal) {
    return RunCommand("robustness",
                      {"-datasets", "tests/data/square.g2o", "-outlier_types",
                       "none", "-journal_filename", journal});
  };
  ASSERT_EQ(sweep(folder / "journal").exit_code, 0);
  const int descriptor = open((folder / "journal").c_str(), O_RDONLY);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  const CommandResult second = sweep(folder / "journal");
  close(descriptor);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.error, HasSubstr("journal: another sweep is writing"));
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  const CommandResult full = sweep("/dev/full");
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.error, HasSubstr("/dev/full: not a plain file"));
}

}  // namespace
}  // namespace cartographer_ext
