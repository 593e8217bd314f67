// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/lua_value.h"

#include <limits>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;

TEST(LuaValueTest, ReadsScalarsTablesAndLists) {
  const auto value = EvaluateLua(
      "return { a = 1, b = 2.5, c = 'x', d = true, "
      "list = { 3, 'y', { z = 4. } }, empty = {} }",
      "test.lua", {});
  ASSERT_TRUE(value.ok()) << value.status();
  EXPECT_TRUE((*value)["a"].is_number_integer());
  EXPECT_EQ((*value)["a"], 1);
  EXPECT_TRUE((*value)["b"].is_number_float());
  EXPECT_EQ((*value)["b"], 2.5);
  EXPECT_EQ((*value)["c"], "x");
  EXPECT_EQ((*value)["d"], true);
  EXPECT_EQ((*value)["list"].size(), 3u);
  EXPECT_EQ((*value)["list"][2]["z"], 4.);
  EXPECT_TRUE((*value)["empty"].is_object());
}

TEST(LuaValueTest, IncludesFromTheFirstDirectoryThatHasTheFile) {
  const test::Folder first, second;
  first.Write("one.lua", "ONE = 1");
  second.Write("one.lua", "ONE = 2");
  second.Write("two.lua", "TWO = choose(ONE == 1, 'yes', 'no')");
  const auto value = EvaluateLua(
      "include 'one.lua' include 'two.lua' return { ONE, TWO, read 'one.lua' }",
      "test.lua", {first.path(), second.path()});
  ASSERT_TRUE(value.ok()) << value.status();
  EXPECT_EQ((*value)[0], 1);
  EXPECT_EQ((*value)[1], "yes");
  EXPECT_EQ((*value)[2], "ONE = 1");
}

// Files are read whole up to 16 MB, and refused beyond.
TEST(LuaValueTest, FilesAreReadUpToALimit) {
  const test::Folder folder;
  const std::string text = std::string(50000, 'x') + "end";
  folder.Write("long.lua", text);
  const auto read = ReadFromDirectories("long.lua", {folder.path()});
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(*read, text);
  folder.Write("largest.lua", std::string(16 << 20, ' '));
  EXPECT_TRUE(ReadFromDirectories("largest.lua", {folder.path()}).ok());
  folder.Write("larger.lua", std::string((16 << 20) + 1, ' '));
  EXPECT_THAT(std::string(ReadFromDirectories("larger.lua", {folder.path()})
                              .status()
                              .message()),
              HasSubstr("more than 16 MB"));
  // A folder of that name is none of the files.
  EXPECT_THAT(
      std::string(ReadFromDirectories(".", {folder.path()}).status().message()),
      HasSubstr("cannot find or read"));
}

std::string ErrorOf(const std::string& code,
                    const std::vector<std::string>& directories = {}) {
  const auto value = EvaluateLua(code, "test.lua", directories);
  EXPECT_FALSE(value.ok()) << code;
  return std::string(value.status().message());
}

TEST(LuaValueTest, ErrorsNameFileAndLine) {
  EXPECT_THAT(ErrorOf("return {\n 1,,"), HasSubstr("test.lua:2:"));
  EXPECT_THAT(ErrorOf("\n\nreturn nothing.x"), HasSubstr("test.lua:3:"));
  EXPECT_THAT(ErrorOf("include 'absent.lua'"), HasSubstr("absent.lua"));
  EXPECT_THAT(ErrorOf("include(1)"), HasSubstr("file name"));
  const test::Folder folder;
  folder.Write("twice.lua", "x = 1");
  folder.Write("bad.lua", "x = ");
  EXPECT_THAT(
      ErrorOf("include 'twice.lua' include 'twice.lua'", {folder.path()}),
      HasSubstr("included twice"));
  EXPECT_THAT(ErrorOf("include 'bad.lua'", {folder.path()}),
              HasSubstr("bad.lua:1:"));
}

TEST(LuaValueTest, UnsuitableResultsAreErrors) {
  EXPECT_THAT(ErrorOf("return { f = function() end }"),
              HasSubstr("f is a fun"));
  EXPECT_THAT(ErrorOf("return { a = { 1, x = 2 } }"), HasSubstr("both names"));
  EXPECT_THAT(ErrorOf("return { a = { [true] = 1 } }"),
              HasSubstr("a has keys"));
}

TEST(LuaValueTest, BombsAreErrorsOfTheirOwnKind) {
  const struct {
    const char* code;
    const char* hint;
  } bombs[] = {
      {"t = {} t.t = t return t", "contain itself"},
      {"t = {} for i = 1, 40 do t = { x = t, y = t } end return t",
       "too many values"},
      {"while true do pcall(function() while true do end end) end",
       "does not terminate"},
      {"local t = {} for i = 1, 1e9 do t[i] = { i } end", "not enough memory"},
      {"return string.rep('a', 1e9)", "not enough memory"},
  };
  for (const auto& bomb : bombs) {
    const auto value = EvaluateLua(bomb.code, "test.lua", {});
    EXPECT_EQ(value.status().code(), absl::StatusCode::kResourceExhausted)
        << bomb.code;
    EXPECT_THAT(std::string(value.status().message()), HasSubstr(bomb.hint));
    EXPECT_LT(value.status().message().size(), 300u);
  }
}

TEST(LuaValueTest, TheProgramIsNotEnded) {
  EXPECT_THAT(ErrorOf("os.exit(0)"), HasSubstr("os.exit"));
}

TEST(LuaValueTest, RestrictedCodeSeesNoSystem) {
  RestrictLua(true);
  for (const char* const code :
       {"return os.getenv('HOME')", "return io.open('/dev/null')",
        "return dofile('/dev/null')", "return loadfile('/dev/null')",
        "return require('x')", "return debug.getinfo(1)"}) {
    EXPECT_THAT(ErrorOf(code), HasSubstr("nil value")) << code;
  }
  EXPECT_TRUE(EvaluateLua("return { math.rad(180.) }", "t", {}).ok());
  RestrictLua(false);
  EXPECT_TRUE(EvaluateLua("return { os.getenv('HOME') }", "t", {}).ok());
}

TEST(LuaValueTest, TablesReadBackFromTheirCode) {
  const auto value = EvaluateLua(
      "return { a = { 1, 2.5, 'x\\n\\r' }, ['b c'] = { d = true }, e = {}, "
      "f = 1 / 0 }",
      "t", {});
  ASSERT_TRUE(value.ok()) << value.status();
  const auto again = EvaluateLua(ToLuaCode(*value), "t", {});
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(*again, *value);
}

TEST(LuaValueTest, WritesScalarsThatReadBack) {
  EXPECT_EQ(ToLua(true), "true");
  EXPECT_EQ(ToLua(90), "90");
  EXPECT_EQ(ToLua(10.), "10.");
  EXPECT_EQ(ToLua(0.55), "0.55");
  EXPECT_EQ(ToLua(1e5), "100000.");
  EXPECT_EQ(ToLua(1e20), "1e+20");
  EXPECT_EQ(ToLua("a\"b"), "\"a\\\"b\"");
  EXPECT_EQ(ToLua(std::numeric_limits<double>::infinity()), "math.huge");
  for (const double number : {0.1, 1. / 3., 12345678.9, -1e-7, 3e300}) {
    const auto value = EvaluateLua("return " + ToLua(number), "t", {});
    ASSERT_TRUE(value.ok());
    EXPECT_EQ(value->get<double>(), number);
  }
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
