// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/dropin/lua_options.h"

#include <memory>
#include <string>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "gtest/gtest.h"
#include "sample_options.pb.h"

namespace cartographer_ext {
namespace options {
namespace {

using cartographer::common::ConfigurationFileResolver;
using cartographer::common::LuaParameterDictionary;

bool Read(const std::string& code, test::SampleOptions* const sample) {
  LuaParameterDictionary dictionary(
      code,
      absl::make_unique<ConfigurationFileResolver>(std::vector<std::string>{}));
  return ReadExtension("POSE_GRAPH.sample", &dictionary, sample);
}

TEST(LuaOptionsTest, AbsentBlockReadsNothing) {
  test::SampleOptions sample;
  EXPECT_FALSE(Read("return {}", &sample));
}

TEST(LuaOptionsTest, EmptyBlockGivesDefaults) {
  test::SampleOptions sample;
  EXPECT_TRUE(Read("return { cartographer_ext = {} }", &sample));
  EXPECT_EQ(sample.window().length(), 10);
}

TEST(LuaOptionsTest, ReadsEveryKind) {
  test::SampleOptions sample;
  EXPECT_TRUE(
      Read("return { cartographer_ext = { enabled = false, mode = 'as_printed',"
           " window = { length = 4, gamma = 0.5 } } }",
           &sample));
  EXPECT_FALSE(sample.enabled());
  EXPECT_EQ(sample.mode(), test::SampleOptions::AS_PRINTED);
  EXPECT_EQ(sample.window().length(), 4);
  EXPECT_EQ(sample.window().gamma(), 0.5);
}

TEST(LuaOptionsDeathTest, ErrorsNameKeyValueAndRange) {
  test::SampleOptions sample;
  EXPECT_DEATH(Read("return { cartographer_ext = { windw = {} } }", &sample),
               "POSE_GRAPH.sample.cartographer_ext.windw: unknown key, "
               "allowed: enabled, "
               "mode, window");
  EXPECT_DEATH(
      Read("return { cartographer_ext = { window = { size = 4 } } }", &sample),
      "window.size: unknown key, now called length; allowed: length");
  EXPECT_DEATH(
      Read("return { cartographer_ext = { window = { width = 4 } } }", &sample),
      "window.width: unknown key, removed, it is a constant now "
      ".docs/options.md.; allowed: length, gamma");
  EXPECT_DEATH(Read("return { cartographer_ext = { schema = 1 } }", &sample),
               "schema: unknown key, allowed: ");
  EXPECT_DEATH(
      Read("return { cartographer_ext = { window = { length = 0 } } }",
           &sample),
      "POSE_GRAPH.sample.cartographer_ext.window.length: 0 is out of range");
  EXPECT_DEATH(
      Read("return { cartographer_ext = { window = { length = 2.5 } } }",
           &sample),
      "window.length: 2.5 is not an integer, allowed: >= 1 and <= 100");
  EXPECT_DEATH(
      Read("return { cartographer_ext = { mode = 'exact' } }", &sample),
      "mode: \"exact\" is not allowed, one of: as_printed, proper");
}

TEST(LuaOptionsDeathTest, WrongTypesNameKeyValueAndRange) {
  test::SampleOptions sample;
  const auto expect_error = [&sample](const std::string& block,
                                      const std::string& error) {
    EXPECT_DEATH(Read("return { cartographer_ext = " + block + " }", &sample),
                 "POSE_GRAPH.sample.cartographer_ext" + error);
  };
  expect_error("3", ": 3(.000000)? is not a table");
  expect_error("{ enabled = 'yes' }",
               ".enabled: \"yes\" is not a boolean, allowed: true, false");
  expect_error("{ enabled = 1 }", ".enabled: 1(.000000)? is not a boolean");
  expect_error("{ mode = true }",
               ".mode: true is not a string, one of: as_printed, proper");
  expect_error("{ window = 4 }",
               ".window: 4(.000000)? is not a table, allowed: length, gamma");
  expect_error("{ window = { length = '4' } }",
               ".window.length: \"4\" is not a number, allowed: >= 1 and <= "
               "100");
  expect_error("{ window = { gamma = {} } }",
               ".window.gamma: \\{ ... \\} is not a number, allowed: > 0");
  expect_error("{ window = { gamma = 0 / 0 } }", ".window.gamma: ");
  expect_error("{ window = { gamma = math.huge } }",
               ".window.gamma: inf is out of range, allowed: > 0");
}

}  // namespace
}  // namespace options
}  // namespace cartographer_ext
