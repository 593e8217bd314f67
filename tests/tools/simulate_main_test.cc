// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(SimulateMainTest, WrongUsageIsExitCodeTwo) {
  EXPECT_THAT(RunCommand("simulate", {}).error,
              HasSubstr("give -world_filename or -generate"));
  const auto check = [](const std::string& flag, const std::string& value,
                        const std::string& message) {
    const CommandResult result = RunCommand(
        "simulate", {"-generate", "office", flag, value, "-json", "-"});
    EXPECT_EQ(result.exit_code, 2) << flag;
    EXPECT_THAT(result.error, HasSubstr(message));
  };
  check("-generate", "castle",
        "-generate=castle is none of office, hotel, warehouse, hall, street, "
        "campus");
  check("-laser", "sonar",
        "-laser=sonar is none of depth_camera, rplidar_a1, ld06, urg_04lx, "
        "utm_30lx, sick_lms");
  check("-robot", "boat", "is none of differential, mecanum, car");
  check("-odometry", "bad", "is none of good, fair, poor, none");
  check("-laps", "0", "-laps=0 is outside [1, 20]");
  check("-world_filename", "x.world", "exclude each other");
}

TEST(SimulateMainTest, BadInputIsExitCodeOne) {
  const CommandResult car = RunCommand(
      "simulate", {"-generate", "hotel", "-robot", "car", "-json", "-"});
  EXPECT_EQ(car.exit_code, 1);
  EXPECT_THAT(car.error, HasSubstr("hotel, seed 0: "));
  EXPECT_EQ(RunCommand("simulate", {"-world_filename", "/no/such.world",
                                    "-laser", "ld06", "-json", "-"})
                .exit_code,
            1);
}

// The world written gives the very readings of the run that wrote it.
TEST(SimulateMainTest, GeneratedWorldReadsBack) {
  const TemporaryFolder folder;
  const CommandResult first = RunCommand(
      "simulate", {"-generate", "office", "-seed", "4", "-laser",
                   "depth_camera", "-odometry", "poor", "-robot", "mecanum",
                   "-output_filestem", folder / "first", "-truth_map=false",
                   "-world_output_filename", folder / "office.world"});
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_THAT(first.out, HasSubstr(folder / "office.world"));
  const CommandResult second = RunCommand(
      "simulate", {folder / "office.world", "-seed", "4", "-output_filestem",
                   folder / "second", "-truth_map=false"});
  ASSERT_EQ(second.exit_code, 0) << second.error;
  for (const char* suffix : {".clf", ".tum", ".relations", ".faults.csv"}) {
    const std::string content =
        ReadFile(folder / ("first" + std::string(suffix)));
    EXPECT_FALSE(content.empty()) << suffix;
    EXPECT_EQ(content, ReadFile(folder / ("second" + std::string(suffix))))
        << suffix;
  }
}

TEST(SimulateMainTest, PresetsReplaceThoseOfAWorld) {
  const CommandResult result =
      RunCommand("simulate", {"configuration_files/worlds/office.world",
                              "-laser", "urg_04lx", "-robot", "differential",
                              "-odometry", "none", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("\"laser_beams_per_second\": 6830"));
}

TEST(SimulateMainTest, WritesAllFilesOrNone) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  const TemporaryFolder folder;
  const std::string world = "configuration_files/worlds/l_corner.world";
  const CommandResult result = RunCommand(
      "simulate", {world, "-output_filestem", folder / "run", "-json",
                   "/dev/full", "-world_output_filename", folder / "x.world"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(folder.Names(), testing::IsEmpty());
  EXPECT_EQ(RunCommand("simulate", {world, "-picture_filename",
                                    folder / "x.png", "-resolution", "0"})
                .exit_code,
            2);
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
