// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

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
  EXPECT_EQ(goals.exit_code, 1);
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

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
