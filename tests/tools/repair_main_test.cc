// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The command cartographer_ext_repair.
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

// No loop is found either.
TEST(RepairMainTest, AMapThatCannotBeJudgedIsLeftAsItIs) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 120);
  const CommandResult result = RunCommand(
      "repair", {folder / "room.pbstream", "-output_filename",
                 folder / "out.pbstream", "-report_filename",
                 folder / "report.html", "-json", folder / "out.json"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out,
              HasSubstr("not repaired, because it cannot be judged"));
  const auto json = ParseJson(ReadFile(folder / "out.json"));
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["written"], false);
  EXPECT_TRUE(json["before"]["severe_share"].is_number());
  EXPECT_EQ(json["after"]["verdict"], json["before"]["verdict"]);
  EXPECT_FALSE(json["steps"].empty());
  EXPECT_EQ(ReadFile(folder / "out.pbstream"), "");
  EXPECT_THAT(ReadFile(folder / "report.html"), HasSubstr("What to do"));
}

TEST(RepairMainTest, WritesAllOrNothing) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  const TemporaryFolder folder;
  WriteRoomMap(folder, 40);
  const size_t before = folder.Names().size();
  const CommandResult result = RunCommand(
      "repair", {folder / "room.pbstream", "-dry_run", "-report_filename",
                 folder / "report.html", "-poses_filename",
                 folder / "poses.csv", "-json", "/dev/full"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(folder.Names().size(), before);
}

TEST(RepairMainTest, RefusesBadInput) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 40);
  const std::string map = folder / "room.pbstream";
  const std::string whole = ReadFile(map);
  EXPECT_EQ(RunCommand("repair", {map}).exit_code, 2);
  const CommandResult step =
      RunCommand("repair", {map, "-dry_run", "-only", "loops,magic"});
  EXPECT_EQ(step.exit_code, 2);
  EXPECT_THAT(step.error, HasSubstr("magic"));

  const CommandResult same =
      RunCommand("repair", {map, "-output_filename", map});
  EXPECT_EQ(same.exit_code, 1);
  EXPECT_THAT(same.error, HasSubstr("the output is also the input"));
  EXPECT_EQ(ReadFile(map), whole);

  const CommandResult unwritable = RunCommand(
      "repair", {map, "-output_filename", folder / "no/such/out.pbstream"});
  EXPECT_EQ(unwritable.exit_code, 1);
  EXPECT_THAT(unwritable.error, HasSubstr("no/such"));

  WriteFile(folder / "cut.pbstream", whole.substr(0, whole.size() - 7));
  const CommandResult cut = RunCommand(
      "repair",
      {folder / "cut.pbstream", "-output_filename", folder / "out.pbstream"});
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_THAT(cut.error, HasSubstr("cut.pbstream"));
  EXPECT_EQ(ReadFile(folder / "out.pbstream"), "");

  const CommandResult loop =
      RunCommand("repair", {map, "-dry_run", "-drop_loops", "0:99:0:1"});
  EXPECT_EQ(loop.exit_code, 1);
  EXPECT_THAT(loop.error, HasSubstr("no loop between"));
  const CommandResult added =
      RunCommand("repair", {map, "-dry_run", "-add_loops", "0:99:0:1"});
  EXPECT_EQ(added.exit_code, 1);
  EXPECT_THAT(added.error, HasSubstr("no submap (0, 99)"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
