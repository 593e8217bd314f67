// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(LabelLoopsMainTest, WrongUsage) {
  EXPECT_EQ(RunCommand("label_loops", {}).exit_code, 2);
  EXPECT_EQ(RunCommand("label_loops", {"-input_filename", "a.clf"}).exit_code,
            2);
  const CommandResult picture = RunCommand(
      "label_loops", {"-input_filename", "a.clf", "-relations_filename",
                      "a.relations", "-picture_filename", "a.gif"});
  EXPECT_EQ(picture.exit_code, 2);
  EXPECT_THAT(picture.error, HasSubstr(".svg"));
}

TEST(LabelLoopsMainTest, BadInput) {
  const TemporaryFolder folder;
  const CommandResult result = RunCommand(
      "label_loops", {"-input_filename", folder / "none.clf",
                      "-reference_trajectory_filename", folder / "none.tum"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("none.tum"));
}

// A robot that goes round in a room, with its own map as the truth.
TEST(LabelLoopsMainTest, LabelsTheCandidatesOfARun) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 900);
  const CommandResult slam = RunCommand(
      "slam", {"-input_filename", folder / "room.clf",
               "-configuration_basename", "default.lua", "-pbstream_filename",
               folder / "map.pbstream", "-trajectory_filename",
               folder / "truth.tum", "-json", folder / "slam.json"});
  ASSERT_EQ(slam.exit_code, 0) << slam.error;
  ASSERT_FALSE(ReadFile(folder / "map.loops.pb").empty());
  const CommandResult result = RunCommand(
      "label_loops", {"-pbstream_filename", folder / "map.pbstream",
                      "-reference_trajectory_filename", folder / "truth.tum",
                      "-csv_filename", folder / "loops.csv",
                      "-picture_filename", folder / "loops.svg", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_TRUE(json["candidates"].is_number());
  EXPECT_TRUE(json["true_candidates"].is_number());
  for (const char* const kind : {"grid", "temporal", "fused"}) {
    EXPECT_TRUE(json["auc"].contains(kind));
  }
  for (const char* const side : {"ours", "stock"}) {
    EXPECT_TRUE(json[side].contains("precision"));
    EXPECT_TRUE(json[side].contains("recall"));
  }
  EXPECT_THAT(ReadFile(folder / "loops.csv"), HasSubstr("label,"));
  EXPECT_THAT(ReadFile(folder / "loops.svg"), HasSubstr("<svg"));

  const std::vector<std::string> again = {
      "-pbstream_filename", folder / "map.pbstream",
      "-reference_trajectory_filename", folder / "truth.tum"};
  WriteFile(folder / "map.loops.pb", "");
  const CommandResult empty = RunCommand("label_loops", again);
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.error, HasSubstr("map.loops.pb: no loop candidates"));
  std::remove((folder / "map.loops.pb").c_str());
  const CommandResult without = RunCommand("label_loops", again);
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.error, HasSubstr("map.pbstream: the decision records, "));
}

TEST(LabelLoopsMainTest, TruthOfAnotherRecordingIsAnError) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 450);
  WriteFile(folder / "x.relations", "1 2 0 0 0 0 0 0\n");
  const CommandResult result = RunCommand(
      "label_loops",
      {folder / "room.clf", "-relations_filename", folder / "x.relations"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("x.relations: the ground truth covers "));
}

TEST(LabelLoopsMainTest, SaysWhatIsWrongWithTheRecording) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 20);
  WriteFile(folder / "room.clf",
            "FLASER 7 1 2\n" + ReadFile(folder / "room.clf"));
  WriteFile(folder / "x.relations", "1 2 0 0 0 0 0 0\n");
  const CommandResult result = RunCommand(
      "label_loops",
      {folder / "room.clf", "-relations_filename", folder / "x.relations"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("note: "));
  EXPECT_THAT(result.error, HasSubstr("room.clf:1: "));
  EXPECT_THAT(result.error, HasSubstr("the recording returns to no place"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
