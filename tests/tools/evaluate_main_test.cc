// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/metrics/trajectory.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

constexpr int kNumScans = 250;

class EvaluateMainTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    WriteRoomMap(*folder_, kNumScans);
    std::vector<io::StampedPose> truth;
    std::vector<io::StampedRelation> relations;
    for (int i = 0; i < kNumScans; ++i) {
      const io::TimeNs time = RoomSource::kStart + i * RoomSource::kStep;
      truth.push_back(io::MakeStampedPose(time, RoomSource::TruePose(i)));
      if (i % 25 == 0 && i >= 50) {
        io::StampedRelation relation;
        relation.time1 = truth[i - 50].time;
        relation.time2 = time;
        relation.relative = truth[i - 50].pose.inverse() * truth[i].pose;
        relations.push_back(relation);
      }
    }
    ASSERT_TRUE(io::WriteTumTrajectory(truth, *folder_ / "truth.tum").ok());
    ASSERT_TRUE(
        io::WriteRelations(relations, *folder_ / "room.relations").ok());
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string File(const std::string& name) { return *folder_ / name; }

  static TemporaryFolder* folder_;
};

TemporaryFolder* EvaluateMainTest::folder_ = nullptr;

TEST_F(EvaluateMainTest, FilesBesideTheReportAreOutputsToo) {
  const CommandResult result =
      RunCommand("evaluate", {File("room.pbstream"), "-report_filename",
                              File("r.html"), "-json", File("r.json")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error,
              HasSubstr("r.json: two files of the command have this name, one "
                        "of them an output (-json, and one that is written "
                        "beside another output)"));
}

TEST_F(EvaluateMainTest, WritesRelationsOfASoundMap) {
  const std::string own = File("own.relations");
  const CommandResult result =
      RunCommand("evaluate", {File("room.pbstream"), "-write_relations", own});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(ReadFile(own), testing::StartsWith("# From room.pbstream, which "
                                                 "was judged sound."));
  const auto relations = io::ReadRelations(own);
  ASSERT_TRUE(relations.ok()) << relations.status();
  EXPECT_GT(relations->size(), 5u);
  // The map agrees with itself.
  const CommandResult same = RunCommand(
      "evaluate",
      {File("room.pbstream"), "-relations_filename", own, "-json", "-"});
  ASSERT_EQ(same.exit_code, 0) << same.error;
  const auto json = ParseJson(same.out);
  EXPECT_LT(json["relations"]["translation"]["max"], 1e-6) << same.out;
  const CommandResult usage = RunCommand(
      "evaluate", {"-trajectory_filename", File("room.tum"),
                   "-relations_filename", own, "-write_relations", own});
  EXPECT_EQ(usage.exit_code, 2);
  EXPECT_THAT(usage.error, HasSubstr("-write_relations"));
}

TEST_F(EvaluateMainTest, AgainstTheTruth) {
  const CommandResult result = RunCommand(
      "evaluate",
      {"-pbstream_filename", File("room.pbstream"), "-trajectory_filename",
       File("room.tum"), "-relations_filename", File("room.relations"),
       "-reference_trajectory_filename", File("truth.tum"), "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_EQ(json["relations"]["count"], 8);
  EXPECT_EQ(json["relations"]["sequential"]["count"], 8);
  EXPECT_LT(json["relations"]["translation"]["mean"], 0.05);
  EXPECT_LT(json["ate"]["rmse"], 0.05);
  EXPECT_GT(json["ate"]["count"], 240);
  EXPECT_LT(json["rpe"]["mean"], 0.05);
  EXPECT_EQ(json["loops"]["accepted"], 0);
  EXPECT_EQ(json["verdict"], "sound");
}

TEST_F(EvaluateMainTest, NoPairOfPosesIsNoError) {
  const CommandResult result =
      RunCommand("evaluate", {"-trajectory_filename", File("room.tum"),
                              "-reference_trajectory_filename",
                              File("truth.tum"), "-rpe_distance", "1e4"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("unknown: no two poses are that far"));
}

TEST_F(EvaluateMainTest, NodesAloneAreInterpolated) {
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-relations_filename", File("room.relations")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("Relations"));
  EXPECT_THAT(result.out, HasSubstr("Verdict: sound"));
}

TEST_F(EvaluateMainTest, WithoutTruthTheLoopsAreCounted) {
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("accepted"));
}

TEST_F(EvaluateMainTest, WritesTables) {
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-relations_filename", File("room.relations"),
                              "-constraints_filename", File("constraints.csv"),
                              "-relation_errors_filename", File("errors.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(ReadFile(File("constraints.csv")), HasSubstr(",intra,"));
  const std::string errors = ReadFile(File("errors.csv"));
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 9);
}

TEST_F(EvaluateMainTest, RunsAgainAndReports) {
  const CommandResult result = RunCommand(
      "evaluate", {"-pbstream_filename", File("room.pbstream"),
                   "-rerun_configuration_directory", "configuration_files",
                   "-report_filename", File("room.html"), "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_TRUE(json.contains("consistency"));
  ASSERT_EQ(json["runs"].size(), 3u);
  EXPECT_EQ(json["runs"][1]["name"], "stock re-run");
  EXPECT_EQ(json["runs"][2]["name"], "ours");
  EXPECT_GE(json["runs"][1]["against_stored"]["fraction_of_stored"], 0.9);
  EXPECT_GT(json["assumptions"].size(), 0u);
  EXPECT_THAT(ReadFile(File("room.html")), HasSubstr("<!DOCTYPE html>"));
  EXPECT_EQ(ParseJson(ReadFile(File("room.json")))["verdict"], json["verdict"]);
  EXPECT_THAT(ReadFile(File("room.loop_evidence.csv")),
              HasSubstr("run,submap"));
}

TEST_F(EvaluateMainTest, SameReportForAnyNumberOfThreads) {
  std::string pages[2];
  for (const int threads : {1, 2}) {
    const CommandResult result = RunCommand(
        "evaluate",
        {"-pbstream_filename", File("room.pbstream"),
         "-rerun_configuration_directory", "configuration_files", "-notimes",
         absl::StrCat("-num_background_threads=", threads), "-report_filename",
         File("same.html")});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    pages[threads - 1] = ReadFile(File("same.html"));
    const std::string flag = absl::StrCat("num_background_threads=", threads);
    ASSERT_NE(pages[threads - 1].find(flag), std::string::npos);
    pages[threads - 1].replace(pages[threads - 1].find(flag), flag.size(), "");
  }
  EXPECT_TRUE(pages[0] == pages[1]);
}

TEST_F(EvaluateMainTest, BadConfigurationIsNamed) {
  WriteFile(File("bad.lua"),
            "include \"common_2d.lua\"\n"
            "POSE_GRAPH.constraint_builder.min_scor = 0.6\n"
            "return { map_builder = MAP_BUILDER, trajectory_builder = "
            "TRAJECTORY_BUILDER }\n");
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-rerun_configuration_directory",
                              absl::StrCat(File("."), ",configuration_files"),
                              "-rerun_configuration_basename", "bad.lua"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("bad.lua"));
  EXPECT_THAT(result.error, HasSubstr("min_scor"));
}

TEST_F(EvaluateMainTest, ReportsNeedAMap) {
  EXPECT_EQ(
      RunCommand("evaluate", {"-trajectory_filename", File("room.tum"),
                              "-relations_filename", File("room.relations"),
                              "-report_filename", File("x.html")})
          .exit_code,
      2);
  EXPECT_EQ(
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-rerun_configuration_basename", "default.lua"})
          .exit_code,
      2);
  EXPECT_EQ(RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                                    "-report_filename", "/nowhere/x.html"})
                .exit_code,
            1);
}

TEST_F(EvaluateMainTest, WrongUsage) {
  EXPECT_EQ(RunCommand("evaluate", {}).exit_code, 2);
  const CommandResult alone =
      RunCommand("evaluate", {"-trajectory_filename", File("room.tum")});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.error, HasSubstr("-relations_filename"));
  EXPECT_EQ(RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                                    "-rpe_distance", "0"})
                .exit_code,
            2);
}

TEST_F(EvaluateMainTest, TruncatedMap) {
  const std::string whole = ReadFile(File("room.pbstream"));
  WriteFile(File("cut.pbstream"), whole.substr(0, whole.size() / 2));
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("cut.pbstream")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("cut.pbstream"));
}

TEST_F(EvaluateMainTest, RelationsOfAnotherRecording) {
  WriteFile(File("other.relations"), "1 2 0 0 0 0 0 0\n");
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-relations_filename", File("other.relations")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("other.relations"));
  EXPECT_THAT(result.error, HasSubstr("none of the 1 relations"));
}

TEST_F(EvaluateMainTest, MalformedRelationsNameTheLine) {
  WriteFile(File("bad.relations"), "1 2 0 0 0 0 0 0\n1 2 x\n");
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-relations_filename", File("bad.relations")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("bad.relations:2"));
}

TEST_F(EvaluateMainTest, UnwritableJson) {
  const CommandResult result =
      RunCommand("evaluate", {"-pbstream_filename", File("room.pbstream"),
                              "-json", "/nowhere/x.json"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("/nowhere/x.json"));
}

TEST_F(EvaluateMainTest, UnknownTrajectory) {
  const CommandResult result = RunCommand(
      "evaluate",
      {"-pbstream_filename", File("room.pbstream"), "-trajectory_id", "5"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("trajectory 5"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
