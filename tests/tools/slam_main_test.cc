// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::UnorderedElementsAre;

TEST(SlamMainTest, WritesMapTrajectoriesAndNumbers) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 250);
  const CommandResult result = RunCommand(
      "slam",
      {"--input_filename=" + folder / "room.clf", "-pbstream_filename",
       folder / "map.pbstream", "-map_filestem", folder / "map",
       "-picture_filename", folder / "map.png", "-trajectory_filename",
       folder / "global.tum", "-local_trajectory_filename",
       folder / "local.tum", "-decisions_filename", folder / "decisions.csv",
       "-configuration_basename", "stock.lua", "-json", folder / "slam.json"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("250 scans"));
  EXPECT_THAT(result.error, IsEmpty());
  EXPECT_THAT(folder.Names(),
              UnorderedElementsAre("room.clf", "map.pbstream", "map.pgm",
                                   "map.yaml", "map.png", "global.tum",
                                   "local.tum", "decisions.csv", "slam.json"));
  const auto json = ParseJson(ReadFile(folder / "slam.json"));
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["scans"], 250);
  EXPECT_EQ(json["odometry_readings"], 250);
  EXPECT_NEAR(json["sensor_seconds"].get<double>(), 24.9, 1e-6);
  EXPECT_GT(json["nodes"], 50);
  EXPECT_GE(json["submaps"], 1);
  EXPECT_GT(json["constraints"]["intra"], 50);
  EXPECT_EQ(json["constraints"]["inter"], 0);
  EXPECT_GT(json["wall_seconds"], 0.);
  EXPECT_GT(json["cpu_seconds"], 0.);
  EXPECT_GT(json["peak_memory_bytes"], 1000000);
  const auto& milliseconds = json["latency"]["local_slam_milliseconds"];
  EXPECT_GT(milliseconds["p50"], 0.);
  EXPECT_GE(milliseconds["p99"], milliseconds["p50"]);
  EXPECT_GE(milliseconds["max"], milliseconds["p99"]);
  EXPECT_GE(json["latency"]["backlog_seconds"]["max"], 0.);
  EXPECT_EQ(json["drift"]["cycles"], 0);
  EXPECT_EQ(json["loop_search"]["count"], 0);
  EXPECT_LT(json["loop_search"]["cpu_seconds"].get<double>(),
            0.5 * json["cpu_seconds"].get<double>());
  // A pose at every scan but those before the first one could be matched.
  const std::string trajectory = ReadFile(folder / "global.tum");
  EXPECT_GE(std::count(trajectory.begin(), trajectory.end(), '\n'), 249);
}

TEST(SlamMainTest, ReplaysAtAMultipleOfRealTime) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 60);
  const CommandResult result = RunCommand(
      "slam", {"-input_filename", folder / "room.clf", "-pbstream_filename",
               folder / "map.pbstream", "-realtime_factor", "10", "-json",
               folder / "slam.json"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_GE(ParseJson(ReadFile(folder / "slam.json"))["wall_seconds"],
            5.9 / 10.);
  for (const char* const factor : {"-1", "nan", "inf"}) {
    const CommandResult wrong = RunCommand(
        "slam",
        {"-input_filename", folder / "room.clf", "-realtime_factor", factor});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.error, HasSubstr("-realtime_factor"));
  }
}

TEST(SlamMainTest, OursByDefaultFromAnyFolder) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 60);
  const CommandResult result =
      RunCommand("slam", {"-input_filename", folder / "room.clf",
                          "-pbstream_filename", folder / "map.pbstream"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  // The records of our local SLAM.
  EXPECT_THAT(folder.Names(), testing::Contains("map.nodes.csv"));
}

TEST(SlamMainTest, ARecordingAloneGivesEverything) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 200);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const CommandResult result = RunCommand("slam", {"room.clf"});
  std::filesystem::current_path(before);
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(folder.Names(),
              UnorderedElementsAre("room.clf", "room.pbstream", "room.pgm",
                                   "room.yaml", "room.png", "room.html",
                                   "room.nodes.pb", "room.nodes.csv"));
  EXPECT_THAT(result.out, testing::ContainsRegex("Verdict: .*\nMemory   "));
  EXPECT_THAT(result.out, HasSubstr("Written    room.pbstream, room.png, "
                                    "room.html, room.yaml, room.pgm, "
                                    "room.nodes.csv\n"));
  EXPECT_THAT(ReadFile(folder / "room.html"), HasSubstr("<title>"));
  EXPECT_THAT(ReadFile(folder / "room.yaml"), HasSubstr("room.pgm"));

  // A flag of its own goes before the stem.
  const CommandResult named =
      RunCommand("slam", {folder / "room.clf", "-output_filestem", folder / "a",
                          "-report_filename", folder / "b.html", "-json", "-"});
  ASSERT_EQ(named.exit_code, 0) << named.error;
  EXPECT_THAT(folder.Names(), testing::IsSupersetOf({"a.pbstream", "b.html"}));
  EXPECT_THAT(folder.Names(), testing::Not(testing::Contains("a.html")));
  EXPECT_TRUE(ParseJson(named.out)["evaluation"]["verdict"].is_string());

  // The map to start from stays.
  const std::string map = ReadFile(folder / "a.pbstream");
  const CommandResult same =
      RunCommand("slam", {folder / "room.clf", "-output_filestem", folder / "a",
                          "-load_state_filename", folder / "a.pbstream"});
  EXPECT_EQ(same.exit_code, 1);
  EXPECT_THAT(same.error, HasSubstr("would be overwritten"));
  EXPECT_TRUE(map == ReadFile(folder / "a.pbstream"));
}

TEST(SlamMainTest, WritesAllOrNothing) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 80);
  const std::vector<std::string> arguments = {
      folder / "room.clf", "-output_filestem", folder / "a",
      "-trajectory_filename", folder / "a.tum"};
  auto full = arguments;
  full.insert(full.end(), {"-json", "/dev/full"});
  EXPECT_EQ(RunCommand("slam", full).exit_code, 1);
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("room.clf"));

  ASSERT_EQ(RunCommand("slam", arguments).exit_code, 0);
  const std::vector<std::string> names = folder.Names();
  std::map<std::string, std::string> before;
  for (const auto& name : names) before[name] = ReadFile(folder / name);
  // Without records, so that old ones would have to go.
  full.insert(full.end(), {"-configuration_basename", "stock.lua"});
  EXPECT_EQ(RunCommand("slam", full).exit_code, 1);
  EXPECT_THAT(folder.Names(), testing::UnorderedElementsAreArray(names));
  for (const auto& name : names) {
    EXPECT_TRUE(before[name] == ReadFile(folder / name)) << name;
  }
}

TEST(SlamMainTest, DevicesAreWrittenToWithoutFilesBesideThem) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 80);
  // A link, so that files beside the device would be in the folder.
  ASSERT_EQ(symlink("/dev/null", (folder / "null").c_str()), 0);
  ASSERT_EQ(symlink("/dev/full", (folder / "full").c_str()), 0);
  const std::vector<std::string> to_null = {
      folder / "room.clf", "-pbstream_filename", folder / "null",
      "-output_filestem", folder / "a"};
  const CommandResult written = RunCommand("slam", to_null);
  EXPECT_EQ(written.exit_code, 0) << written.error;
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("room.clf", "null", "full",
                                                   "a.pgm", "a.yaml", "a.png"));
  auto with_report = to_null;
  with_report.insert(with_report.end(),
                     {"-report_filename", folder / "a.html"});
  const CommandResult refused = RunCommand("slam", with_report);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.error, HasSubstr("is not a file"));
  EXPECT_THAT(refused.out, IsEmpty());
  // The reason is named.
  const CommandResult full =
      RunCommand("slam", {"-input_filename", folder / "room.clf",
                          "-pbstream_filename", folder / "full"});
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.error, HasSubstr("cannot write"));
  EXPECT_THAT(full.error, HasSubstr("No space left on device"));
}

TEST(SlamMainTest, LocalizesInAMap) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 300);
  ASSERT_EQ(RunCommand("slam", {"-input_filename", folder / "room.clf",
                                "-configuration_basename", "stock.lua",
                                "-pbstream_filename", folder / "map.pbstream"})
                .exit_code,
            0);
  const CommandResult result = RunCommand(
      "slam",
      {"-input_filename", folder / "room.clf", "-configuration_basename",
       "localization.lua", "-load_state_filename", folder / "map.pbstream",
       "-initial_pose", "0,0,0", "-trajectory_filename", folder / "all.tum",
       "-online_trajectory_filename", folder / "online.tum", "-json",
       folder / "slam.json", "-pbstream_filename", folder / "later.pbstream"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(RunCommand("dump", {folder / "later.pbstream"}).exit_code, 0);
  const auto json = ParseJson(ReadFile(folder / "slam.json"));
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["loaded"]["frozen"], true);
  EXPECT_GT(json["loaded"]["nodes"], 50);
  EXPECT_GE(json["loaded"]["submaps"], 1);
  EXPECT_TRUE(json.contains("localized"));
  EXPECT_THAT(result.out, HasSubstr("Localised  "));
  const std::string online = ReadFile(folder / "online.tum");
  EXPECT_GE(std::count(online.begin(), online.end(), '\n'), 299);
  EXPECT_EQ(online, ReadFile(folder / "all.tum"));

  for (const char* pose : {"1,2", "1,2,x", "1,2,3,4", "nan,0,0"}) {
    const CommandResult wrong = RunCommand(
        "slam", {"-input_filename", folder / "room.clf", "-load_state_filename",
                 folder / "map.pbstream", "-initial_pose", pose});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.error, HasSubstr("is not X,Y,DEGREES"));
  }
  EXPECT_EQ(RunCommand("slam", {"-input_filename", folder / "room.clf",
                                "-initial_pose", "0,0,0"})
                .exit_code,
            2);
  const CommandResult missing =
      RunCommand("slam", {"-input_filename", folder / "room.clf",
                          "-load_state_filename", folder / "no.pbstream"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.error, HasSubstr("slam: cannot open "));
}

TEST(SlamMainTest, JsonOnStandardOutputStandsAlone) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 30);
  const CommandResult result = RunCommand(
      "slam", {"-input_filename", folder / "room.clf", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_EQ(json["scans"], 30);
}

TEST(SlamMainTest, TheNumberOfThreadsDoesNotMatter) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 250);
  for (const std::string threads : {"1", "2", "3"}) {
    const CommandResult result = RunCommand(
        "slam",
        {"-input_filename", folder / "room.clf", "-num_background_threads",
         threads, "-pbstream_filename", folder / (threads + ".pbstream")});
    ASSERT_EQ(result.exit_code, 0) << result.error;
  }
  const std::string one = ReadFile(folder / "1.pbstream");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(one == ReadFile(folder / "2.pbstream"));
  EXPECT_TRUE(one == ReadFile(folder / "3.pbstream"));
}

// One damaged line made stock's grids grow beyond memory.
TEST(SlamMainTest, AJumpOfOdometryIsTakenOut) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 60);
  const std::string good = ReadFile(folder / "room.clf");
  const std::vector<std::string> lines = absl::StrSplit(good, '\n');
  std::string bad;
  int count = 0;
  for (const std::string& line : lines) {
    std::vector<std::string> words = absl::StrSplit(line, ' ');
    if (words[0] == "ODOM" && ++count == 30) words[1] = "100000";
    absl::StrAppend(&bad, absl::StrJoin(words, " "), "\n");
  }
  ASSERT_GE(count, 30);
  WriteFile(folder / "bad.clf", bad);
  const CommandResult result = RunCommand(
      "slam", {"-input_filename", folder / "bad.clf", "-configuration_basename",
               "stock.lua", "-trajectory_filename", folder / "bad.tum"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("the odometry jumps 2 times"));
}

TEST(SlamMainTest, WrongUsageIsExitCodeTwo) {
  EXPECT_EQ(RunCommand("slam", {}).exit_code, 2);
  const CommandResult unknown = RunCommand("slam", {"-input_filname", "x.clf"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.error, HasSubstr("did you mean '-input_filename'?"));
  EXPECT_EQ(RunCommand("slam", {"x.clf", "y.clf"}).exit_code, 2);
  EXPECT_EQ(RunCommand("slam", {"-input_filename=x.clf", "-report_filename=r"})
                .exit_code,
            2);
  const CommandResult bad_value =
      RunCommand("slam", {"-input_filename=x.clf", "-resolution=wide"});
  EXPECT_EQ(bad_value.exit_code, 2);
  EXPECT_THAT(bad_value.error, HasSubstr("wide"));
  EXPECT_EQ(RunCommand("slam", {"-input_filename"}).exit_code, 2);
  EXPECT_EQ(RunCommand("slam",
                       {"-input_filename=x.clf", "-num_background_threads=-1"})
                .exit_code,
            2);
}

TEST(SlamMainTest, HelpTeaches) {
  const CommandResult result = RunCommand("slam", {"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("cartographer_ext_slam -input_filename"));
  EXPECT_THAT(result.out, HasSubstr("-configuration_basename"));
  EXPECT_THAT(result.out, HasSubstr("Exit codes"));
}

TEST(SlamMainTest, MissingInputNamesTheFile) {
  const CommandResult result =
      RunCommand("slam", {"-input_filename", "/nowhere/run.clf"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("/nowhere/run.clf"));
  EXPECT_THAT(result.error, StartsWith("cartographer_ext_slam: "));
}

TEST(SlamMainTest, UnwritableOutputIsFoundBeforeTheWork) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 10);
  for (const std::string flag :
       {"-pbstream_filename", "-map_filestem", "-picture_filename",
        "-trajectory_filename", "-json"}) {
    const CommandResult result = RunCommand(
        "slam",
        {"-input_filename", folder / "room.clf", flag, "/nowhere/output.png"});
    EXPECT_EQ(result.exit_code, 1) << flag;
    EXPECT_THAT(result.error, HasSubstr("/nowhere/output")) << flag;
    EXPECT_THAT(result.out, IsEmpty()) << flag;
  }
}

TEST(SlamMainTest, AFailedRunLeavesNothingBehind) {
  const TemporaryFolder folder;
  WriteFile(folder / "broken.clf", "FLASER 3 1.0 2.0\n");
  const CommandResult result =
      RunCommand("slam", {"-input_filename", folder / "broken.clf",
                          "-pbstream_filename", folder / "map.pbstream"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("broken.clf"));
}

class LuaTest : public testing::Test {
 protected:
  CommandResult RunWith(const std::string& lua) {
    WriteRoomLog(folder_ / "room.clf", 10);
    WriteFile(folder_ / "test.lua", lua);
    return RunCommand(
        "slam",
        {"-input_filename", folder_ / "room.clf", "-configuration_directory",
         folder_.path() + ",configuration_files", "-configuration_basename",
         "test.lua", "-pbstream_filename", folder_ / "map.pbstream"});
  }

  // Exit code 1 and a message with `hint`; no crash, no output.
  void ExpectRefused(const std::string& lua, const std::string& hint) {
    const CommandResult result = RunWith(lua);
    EXPECT_EQ(result.exit_code, 1) << lua;
    EXPECT_THAT(result.error, HasSubstr(hint)) << lua;
    EXPECT_THAT(result.error, HasSubstr("test.lua")) << lua;
    EXPECT_TRUE(ReadFile(folder_ / "map.pbstream").empty());
  }

  const std::string head_ = "include \"common_2d.lua\"\n";
  const std::string tail_ =
      "\nreturn { map_builder = MAP_BUILDER, trajectory_builder = "
      "TRAJECTORY_BUILDER }\n";
  const TemporaryFolder folder_;
};

TEST_F(LuaTest, GoodFilesWork) {
  const CommandResult result = RunWith(head_ + tail_);
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(LuaTest, UnknownKey) {
  ExpectRefused(head_ + "POSE_GRAPH.constraint_builder.min_skore = 0.5" + tail_,
                "min_skore");
}

TEST_F(LuaTest, MissingKey) {
  ExpectRefused(head_ + "POSE_GRAPH.constraint_builder.min_score = nil" + tail_,
                "min_score");
}

TEST_F(LuaTest, WrongType) {
  ExpectRefused(
      head_ + "POSE_GRAPH.constraint_builder.min_score = \"high\"" + tail_,
      "min_score");
}

TEST_F(LuaTest, ErrorsNameFileAndLine) {
  ExpectRefused(head_ + "if x then" + tail_, "): test.lua:");
  ExpectRefused(head_ + "POSE_GRPAH.a = 1" + tail_, "): test.lua:2: ");
}

TEST_F(LuaTest, MissingInclude) {
  ExpectRefused("include \"nowhere.lua\"" + tail_, "nowhere.lua");
}

TEST_F(LuaTest, LocalisationNeedsAMap) {
  ExpectRefused(head_ +
                    "TRAJECTORY_BUILDER.pure_localization_trimmer = { "
                    "max_submaps_to_keep = 3 }" +
                    tail_,
                "-load_state_filename");
}

TEST_F(LuaTest, AByteOrderMarkIsSkipped) {
  EXPECT_EQ(RunWith("\xef\xbb\xbf" + head_ + tail_).exit_code, 0);
}

TEST_F(LuaTest, NeitherTwoNorThreeDimensions) {
  ExpectRefused(head_ + "MAP_BUILDER.use_trajectory_builder_2d = false" + tail_,
                "use_trajectory_builder");
}

TEST_F(LuaTest, ImuWantedButAbsent) {
  ExpectRefused(head_ + "TRAJECTORY_BUILDER_2D.use_imu_data = true" + tail_,
                "use_imu_data");
}

TEST_F(LuaTest, ValuesThatGiveNoMap) {
  const std::string local = head_ + "TRAJECTORY_BUILDER_2D.";
  ExpectRefused(local + "min_range = 100." + tail_, "below max_range");
  ExpectRefused(local + "submaps.grid_options_2d.resolution = 0" + tail_,
                "TRAJECTORY_BUILDER_2D.submaps.grid_options_2d.resolution");
  // Only the run shows that nothing is within these heights.
  ExpectRefused(local + "min_z = 1." + tail_, "none of the 10 scans");
}

TEST_F(LuaTest, EndingTheProgram) { ExpectRefused("os.exit(0)", "os.exit"); }

TEST_F(LuaTest, MissingFile) {
  WriteRoomLog(folder_ / "room.clf", 10);
  const CommandResult result =
      RunCommand("slam", {"-input_filename", folder_ / "room.clf",
                          "-configuration_basename", "nowhere.lua"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("nowhere.lua"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
