// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(NavigateMainTest, WrongUsageIsExitCodeTwo) {
  const CommandResult none = RunCommand("navigate", {});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.error, HasSubstr("-pbstream_filename is missing"));
  const CommandResult no_world =
      RunCommand("navigate", {"-pbstream_filename", "x.pbstream"});
  EXPECT_EQ(no_world.exit_code, 2);
  EXPECT_THAT(no_world.error, HasSubstr("-world_filename is missing"));
  EXPECT_EQ(RunCommand("navigate", {"-pbstream_filename", "x",
                                    "-world_filename", "y", "-obstacles", "-1"})
                .exit_code,
            2);
}

TEST(NavigateMainTest, BadInputIsExitCodeOne) {
  const std::string world = "configuration_files/worlds/office.world";
  const CommandResult goals = RunCommand(
      "navigate",
      {"-pbstream_filename", "x", "-world_filename", world, "-goals", "1,2;3"});
  EXPECT_EQ(goals.exit_code, 2);
  EXPECT_THAT(goals.error, HasSubstr("-goals: goal 2 \"3\" is not X,Y"));
  const CommandResult no_map = RunCommand(
      "navigate",
      {"-pbstream_filename", "/no/such.pbstream", "-world_filename", world});
  EXPECT_EQ(no_map.exit_code, 1);
  EXPECT_THAT(no_map.error, HasSubstr("such.pbstream"));
  const CommandResult no_plan_map =
      RunCommand("navigate", {"-pbstream_filename", "x", "-world_filename",
                              world, "-map_filename", "/no/such.yaml"});
  EXPECT_EQ(no_plan_map.exit_code, 1);
  EXPECT_THAT(no_plan_map.error, HasSubstr("such.yaml"));
  const CommandResult no_world = RunCommand(
      "navigate",
      {"-pbstream_filename", "x", "-world_filename", "/no/such.world"});
  EXPECT_EQ(no_world.exit_code, 1);
  EXPECT_THAT(no_world.error, HasSubstr("such.world"));
}

TEST(NavigateMainTest, FindsTheConfigurationFromAnyFolder) {
  char* const here = getcwd(nullptr, 0);
  ASSERT_EQ(chdir("/"), 0);
  const CommandResult result = RunCommand(
      "navigate",
      {"-pbstream_filename", "x", "-world_filename", "/no/such.world"});
  ASSERT_EQ(chdir(here), 0);
  std::free(here);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("such.world"));
}

TEST(NavigateMainTest, DrivesThatCannotBeAreWrongUsage) {
  for (const std::vector<std::string>& flags :
       {std::vector<std::string>{"-max_seconds", "0"},
        std::vector<std::string>{"-num_goals", "2000000000"}}) {
    EXPECT_EQ(RunCommand("navigate",
                         {"x", "-world_filename", "y", flags[0], flags[1]})
                  .exit_code,
              2)
        << flags[0];
  }
  const CommandResult other =
      RunCommand("navigate", {"x", "-world_filename", "/no/such.world",
                              "-other_configuration_basename", "no_such.lua"});
  EXPECT_THAT(other.error, HasSubstr("no_such.lua"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
