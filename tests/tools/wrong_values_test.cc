// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Flags with a value that they cannot have: every command answers with exit
// code 2, names the flag and says what it takes, before it reads anything.
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct WrongValue {
  std::string command;
  std::string flag;
  std::string value;
  std::string takes;                     // in the message
  std::vector<std::string> others = {};  // further flags
};

const char kNone[] = "/nowhere/input";

std::vector<WrongValue> WrongWords() {
  return {
      {"slam", "odometry_source", "odo", "did you mean 'odom'?"},
      {"tune", "odometry_source", "foo", "odom, scan, both, auto"},
      {"tune", "method", "foo", "grid, random, halving"},
      {"tune", "objective", "foo", "foo", {"-search_filename=x"}},
      {"optimize", "kernel", "hubert", "did you mean 'huber'?"},
      {"optimize", "norm", "foo", "spectral, determinant, root, information"},
      {"robustness", "kernels", "auto,foo", "gnc_tls, auto, r_isam"},
      {"robustness", "outlier_types", "R,X", "R, L, RG, LG"},
      {"robustness", "norm", "foo", "spectral, determinant"},
      {"robustness", "family", "ring,moon", "ring, road"},
      {"robustness", "preset", "a_table_3", "did you mean 'a_table_2'?"},
      {"simulate", "generate", "castle", "office, hotel"},
      {"simulate", "laser", "foo", "depth_camera, rplidar_a1"},
      {"simulate", "robot", "boat", "differential, mecanum, car"},
      {"simulate", "odometry", "bad", "good, fair, poor, none"},
      {"evaluate", "fail_on", "foo", "broken, doubtful or worse", {kNone}},
      {"repair", "only", "loops,foo", "loops, local"},
      {"benchmark_search", "matcher", "foo", "stock, ours, both"},
      {"print_options", "format", "foo", "text, markdown, lua, reference"},
  };
}

// Values that are more than one word.
std::vector<WrongValue> WrongForms() {
  return {
      {"slam",
       "initial_pose",
       "1,2",
       "X,Y,DEGREES",
       {kNone, "-load_state_filename=x"}},
      {"slam",
       "min_range",
       "30",
       "no range is between",
       {kNone, "-max_range=5"}},
      {"robustness", "outlier_counts", "many", "'many'"},
      {"robustness", "outlier_counts", "120%", "'120%'"},
      {"robustness", "ate_limits", "intel", "name=metres"},
      {"robustness", "truths", "intel", "name=file"},
      {"simulate",
       "odometry_faults",
       "stale:3,foo:2",
       "stale:N",
       {"-generate=office", "-json=-"}},
      {"navigate",
       "goals",
       "1,2;3",
       "X,Y",
       {kNone, "-world_filename=/nowhere/x.world"}},
  };
}

std::vector<WrongValue> WrongEndings() {
  const std::string world = "-world_filename=/nowhere/x.world";
  return {
      {"slam", "picture_filename", "map.jpg", ".png", {kNone}},
      {"export", "picture_filename", "map.pgm", ".png", {kNone}},
      {"optimize", "picture_filename", "graph.svg", ".png", {kNone}},
      {"optimize", "output_filename", "graph.txt", ".g2o or .tum", {kNone}},
      {"optimize", "output_filename", "x.pbstream", "pbstream", {"a.g2o"}},
      {"robustness", "picture_filename", "a.pdf", ".png"},
      {"simulate", "picture_filename", "plan.gif", ".png", {kNone}},
      {"navigate", "picture_filename", "drive.jpeg", ".png", {kNone, world}},
      {"tune", "picture_filename", "a.jpg", ".png or .svg"},
      {"label_loops", "picture_filename", "a.png", ".svg", {kNone}},
  };
}

void ExpectUsage(const std::vector<WrongValue>& cases) {
  for (const WrongValue& wrong : cases) {
    SCOPED_TRACE(wrong.command + " -" + wrong.flag + "=" + wrong.value);
    std::vector<std::string> arguments = wrong.others;
    arguments.push_back("-" + wrong.flag + "=" + wrong.value);
    const CommandResult result = RunCommand(wrong.command, arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("-" + wrong.flag));
    EXPECT_THAT(result.error, HasSubstr(wrong.takes));
    EXPECT_THAT(result.error, HasSubstr(" -help"));
    EXPECT_THAT(result.out, IsEmpty());
  }
}

TEST(WrongValuesTest, Words) { ExpectUsage(WrongWords()); }

TEST(WrongValuesTest, Forms) { ExpectUsage(WrongForms()); }

TEST(WrongValuesTest, Endings) { ExpectUsage(WrongEndings()); }

TEST(WrongValuesTest, NothingIsWrittenUnderAnotherEnding) {
  const TemporaryFolder folder;
  const CommandResult result = RunCommand(
      "simulate", {"-world_filename=configuration_files/worlds/office.world",
                   "-picture_filename", folder / "plan.jpg"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(folder.Names(), IsEmpty());
}

// A flag of another kind of recording is no error, but it is said.
TEST(WrongValuesTest, FlagsWithoutEffectAreNamed) {
  const TemporaryFolder folder;
  WriteRoomLog(folder / "room.clf", 30);
  const std::vector<std::string> command = {
      "-input_filename", folder / "room.clf", "-trajectory_filename",
      folder / "room.tum"};
  std::vector<std::string> wrong = command;
  wrong.insert(wrong.end(), {"-scan_topic", "/scan", "-seed", "3",
                             "-odometry_source", "scan"});
  const CommandResult result = RunCommand("slam", wrong);
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("note: -scan_topic has no effect: it is "
                                      "for ROS recordings\n"));
  EXPECT_THAT(result.error,
              HasSubstr("note: -seed has no effect: it is for worlds\n"));
  EXPECT_THAT(result.error, testing::Not(HasSubstr("-odometry_source")));
  EXPECT_THAT(RunCommand("slam", command).error,
              testing::Not(HasSubstr("no effect")));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
