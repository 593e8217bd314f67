// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(DumpMainTest, TellsWhatIsInside) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 120);
  const CommandResult result =
      RunCommand("dump", {"-pbstream_filename", folder / "room.pbstream",
                          "-json", folder / "dump.json"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("valid"));
  EXPECT_THAT(result.out, HasSubstr("trajectory 0"));
  const auto json = ParseJson(ReadFile(folder / "dump.json"));
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["valid"], true);
  EXPECT_TRUE(json["problems"].empty());
  ASSERT_EQ(json["trajectories"].size(), 1u);
  EXPECT_GT(json["trajectories"][0]["nodes"], 20);
  EXPECT_EQ(json["trajectories"][0]["odometry_readings"], 120);
}

TEST(DumpMainTest, ComparesTwoMaps) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 60);
  const CommandResult same =
      RunCommand("dump", {"-pbstream_filename", folder / "room.pbstream",
                          "-other_pbstream_filename", folder / "room.pbstream",
                          "-json", "-"});
  ASSERT_EQ(same.exit_code, 0) << same.error;
  EXPECT_EQ(ParseJson(same.out)["difference"]["identical"], true);

  WriteFile(folder / "first.pbstream", ReadFile(folder / "room.pbstream"));
  WriteRoomMap(folder, 120);
  const CommandResult other = RunCommand(
      "dump", {"-pbstream_filename", folder / "first.pbstream",
               "-other_pbstream_filename", folder / "room.pbstream"});
  ASSERT_EQ(other.exit_code, 0) << other.error;
  EXPECT_THAT(other.out, HasSubstr("difference: nodes: 0 only in the first"));
}

TEST(DumpMainTest, ReplacesNoInput) {
  const TemporaryFolder folder;
  WriteFile(folder / "a", "one");
  WriteFile(folder / "b", "two");
  for (const char* name : {"a", "b"}) {
    const CommandResult result =
        RunCommand("dump", {folder / "a", "-other_pbstream_filename",
                            folder / "b", "-json", folder / name});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr(folder / name + ": "));
  }
  EXPECT_EQ(ReadFile(folder / "a") + ReadFile(folder / "b"), "onetwo");
}

TEST(DumpMainTest, StandardOutputThatTakesNothingIsAnError) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 20);
  const std::string command = std::string(CARTOGRAPHER_EXT_BIN_DIR) +
                              "/cartographer_ext_dump " +
                              (folder / "room.pbstream");
  const auto exit_code = [&](const std::string& redirection) {
    const int state = std::system(
        (command + redirection + " 2> " + (folder / "error")).c_str());
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  };
  EXPECT_EQ(exit_code(" > /dev/null"), 0);
  EXPECT_EQ(exit_code(" >&-"), 1);
  EXPECT_THAT(ReadFile(folder / "error"),
              HasSubstr("cannot write standard output"));
  if (access("/dev/full", W_OK) == 0) {
    EXPECT_EQ(exit_code(" > /dev/full"), 1);
  }
}

TEST(DumpMainTest, BrokenFilesAreListedAndRefused) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 20);
  const std::string whole = ReadFile(folder / "room.pbstream");
  WriteFile(folder / "cut.pbstream", whole.substr(0, whole.size() - 7));
  const CommandResult result = RunCommand(
      "dump", {"-pbstream_filename", folder / "cut.pbstream", "-json", "-"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("cut.pbstream"));
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["problems"].size(), 1u);
  EXPECT_TRUE(json["trajectories"].is_array());
}

TEST(DumpMainTest, WrongUsage) {
  EXPECT_EQ(RunCommand("dump", {}).exit_code, 2);
  EXPECT_EQ(
      RunCommand("dump", {"-pbstream_filename=x", "-max_problems=0"}).exit_code,
      2);
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
