// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/swaps.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(PrintOptionsMainTest, TheCommentedLuaFileIsUpToDate) {
  const CommandResult result = RunCommand("print_options", {"-format=lua"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  // After a change of an option, write it again with the command itself.
  EXPECT_EQ(result.out, ReadFile("configuration_files/cartographer_ext.lua"));
}

TEST(PrintOptionsMainTest, TheReferenceIsUpToDate) {
  const CommandResult result = RunCommand(
      "print_options",
      {"-format=reference", "-effects_filename=docs/option_effects.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.out, ReadFile("docs/options.md"));
}

TEST(PrintOptionsMainTest, StockConfigurationHasNoBlock) {
  const CommandResult lua = RunCommand(
      "print_options", {"-configuration_basename=stock.lua", "-format=lua"});
  ASSERT_EQ(lua.exit_code, 0) << lua.error;
  EXPECT_EQ(lua.out, "");
}

#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
TEST(PrintOptionsMainTest, PrintsABlockInFull) {
  const TemporaryFolder folder;
  WriteFile(folder / "mine.lua",
            "include \"common_2d.lua\"\n"
            "POSE_GRAPH.optimization_problem.cartographer_ext = {}\n"
            "return { map_builder = MAP_BUILDER,\n"
            "         trajectory_builder = TRAJECTORY_BUILDER }\n");
  const std::string directories =
      "-configuration_directory=" + folder.path() + ",configuration_files";
  const CommandResult text = RunCommand(
      "print_options", {directories, "-configuration_basename=mine.lua"});
  ASSERT_EQ(text.exit_code, 0) << text.error;
  EXPECT_THAT(text.out,
              HasSubstr("POSE_GRAPH.optimization_problem.cartographer_ext\n"));
  const CommandResult lua = RunCommand(
      "print_options",
      {directories, "-format=lua", "-configuration_basename=mine.lua"});
  ASSERT_EQ(lua.exit_code, 0) << lua.error;
  EXPECT_THAT(
      lua.out,
      HasSubstr("POSE_GRAPH.optimization_problem.cartographer_ext = {\n"));

  // An unknown key: the full name, and no crash.
  WriteFile(folder / "mine.lua",
            "include \"common_2d.lua\"\n"
            "POSE_GRAPH.optimization_problem.cartographer_ext = { krnl = 1 }\n"
            "return { map_builder = MAP_BUILDER,\n"
            "         trajectory_builder = TRAJECTORY_BUILDER }\n");
  const CommandResult wrong = RunCommand(
      "print_options", {directories, "-configuration_basename=mine.lua"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.error,
              HasSubstr("POSE_GRAPH.optimization_problem.cartographer_ext.krnl"
                        ": unknown key"));
}
#endif

TEST(PrintOptionsMainTest, WrongUsage) {
  EXPECT_EQ(RunCommand("print_options", {"-format=html"}).exit_code, 2);
  EXPECT_EQ(RunCommand("print_options", {"-format=reference",
                                         "-configuration_basename=stock.lua"})
                .exit_code,
            2);
  EXPECT_EQ(RunCommand("print_options",
                       {"-format=reference", "-effects_filename=no_such_file"})
                .exit_code,
            1);
  const CommandResult missing =
      RunCommand("print_options", {"-configuration_basename=no_such_file.lua"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.error, HasSubstr("no_such_file.lua"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
