// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The command cartographer_ext_compare.
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(CompareMainTest, AMapAgreesWithItself) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 120);
  const CommandResult result = RunCommand(
      "compare", {folder / "room.pbstream", folder / "room.pbstream", "-json",
                  "-", "-report_filename", folder / "report.html"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object());
  EXPECT_NEAR(json["alignment"]["x"], 0., 1e-9);
  EXPECT_NEAR(json["alignment"]["theta"], 0., 1e-9);
  EXPECT_NEAR(json["trajectory_difference"]["max"], 0., 1e-9);
  EXPECT_GT(json["walls"]["common"], 100);
  EXPECT_EQ(json["walls"]["only_first"], 0);
  EXPECT_EQ(json["walls"]["only_second"], 0);
  EXPECT_TRUE(json["first"]["verdict"].is_string());
  const std::string report = ReadFile(folder / "report.html");
  EXPECT_THAT(report, HasSubstr("walls in both"));
  EXPECT_THAT(report, HasSubstr("svg.map-figure').forEach(view)"));
}

TEST(CompareMainTest, TakesAPgmForAMap) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 120);
  ASSERT_EQ(
      RunCommand("export", {"-pbstream_filename", folder / "room.pbstream",
                            "-map_filestem", folder / "room"})
          .exit_code,
      0);
  const CommandResult result =
      RunCommand("compare", {folder / "room.pbstream", folder / "room.yaml",
                             "-json", folder / "out.json"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(ReadFile(folder / "out.json"));
  EXPECT_TRUE(json["trajectory_difference"]["mean"].is_null());
  EXPECT_TRUE(json["second"]["verdict"].is_null());
  EXPECT_LT(json["walls"]["only_second"], json["walls"]["common"]);
}

TEST(CompareMainTest, RefusesBadInput) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 40);
  EXPECT_EQ(RunCommand("compare", {folder / "room.pbstream"}).exit_code, 2);
  const std::string whole = ReadFile(folder / "room.pbstream");
  WriteFile(folder / "cut.pbstream", whole.substr(0, whole.size() - 7));
  const CommandResult cut =
      RunCommand("compare", {folder / "room.pbstream", folder / "cut.pbstream",
                             "-report_filename", folder / "report.html"});
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_THAT(cut.error, HasSubstr("cut.pbstream"));
  EXPECT_EQ(ReadFile(folder / "report.html"), "");
  const CommandResult three =
      RunCommand("compare", {folder / "room.pbstream", folder / "room.pbstream",
                             folder / "room.pbstream"});
  EXPECT_EQ(three.exit_code, 2);
  EXPECT_THAT(three.error, HasSubstr("second input"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
