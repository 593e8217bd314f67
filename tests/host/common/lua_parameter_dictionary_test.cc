// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/lua_parameter_dictionary.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

using ::testing::ElementsAre;

// Files that exist in memory only.
class FakeResolver : public FileResolver {
 public:
  explicit FakeResolver(std::map<std::string, std::string> files = {})
      : files_(std::move(files)) {}
  std::string GetFullPathOrDie(const std::string& basename) override {
    return "/etc/" + basename;
  }
  std::string GetFileContentOrDie(const std::string& basename) override {
    return files_.at(basename);
  }

 private:
  const std::map<std::string, std::string> files_;
};

std::unique_ptr<LuaParameterDictionary> Load(
    const std::string& code, std::map<std::string, std::string> files = {}) {
  return std::unique_ptr<LuaParameterDictionary>(new LuaParameterDictionary(
      code, std::unique_ptr<FileResolver>(new FakeResolver(std::move(files)))));
}

std::unique_ptr<LuaParameterDictionary> LoadLoosely(const std::string& code) {
  return LuaParameterDictionary::NonReferenceCounted(
      code, std::unique_ptr<FileResolver>(new FakeResolver));
}

TEST(LuaParameterDictionaryTest, ValuesOfEveryType) {
  const auto dictionary = Load(
      "return { text = 'a', number = 0.5, whole = 3, yes = true, "
      "part = { deep = { leaf = -2 } } }");
  EXPECT_EQ(dictionary->GetString("text"), "a");
  EXPECT_EQ(dictionary->GetDouble("number"), 0.5);
  EXPECT_EQ(dictionary->GetInt("whole"), 3);
  EXPECT_TRUE(dictionary->GetBool("yes"));
  const auto part = dictionary->GetDictionary("part");
  const auto deep = part->GetDictionary("deep");
  EXPECT_EQ(deep->GetInt("leaf"), -2);
}

TEST(LuaParameterDictionaryTest, IntegersReadAsDoubles) {
  EXPECT_EQ(Load("return { x = 3 }")->GetDouble("x"), 3.);
}

TEST(LuaParameterDictionaryTest, WholeDoublesReadAsIntegers) {
  EXPECT_EQ(Load("return { x = 3. }")->GetInt("x"), 3);
}

TEST(LuaParameterDictionaryTest, LookingIsNotReading) {
  const auto dictionary = Load("return { b = 1, a = 2, 'first' }");
  EXPECT_TRUE(dictionary->HasKey("a"));
  EXPECT_FALSE(dictionary->HasKey("c"));
  EXPECT_THAT(dictionary->GetKeys(), ElementsAre("a", "b"));
  dictionary->ToString();
  EXPECT_EQ(dictionary->GetInt("a"), 2);
  EXPECT_EQ(dictionary->GetNonNegativeInt("b"), 1);
}

TEST(LuaParameterDictionaryTest, Arrays) {
  const auto dictionary = Load(
      "return { n = { 1, 2.5, 3 }, t = { 'x', 'y' }, d = { {a=1}, {a=2} } }");
  EXPECT_THAT(dictionary->GetDictionary("n")->GetArrayValuesAsDoubles(),
              ElementsAre(1., 2.5, 3.));
  EXPECT_THAT(dictionary->GetDictionary("t")->GetArrayValuesAsStrings(),
              ElementsAre("x", "y"));
  const auto array = dictionary->GetDictionary("d");
  const auto parts = array->GetArrayValuesAsDictionaries();
  ASSERT_EQ(parts.size(), 2);
  EXPECT_EQ(parts[0]->GetInt("a"), 1);
  EXPECT_EQ(parts[1]->GetInt("a"), 2);
}

TEST(LuaParameterDictionaryTest, ChooseIncludeRead) {
  const auto dictionary = Load(
      "include 'values.lua'\n"
      "return { a = choose(A > 3, 'big', 'small'), b = read 'text.txt' }",
      {{"values.lua", "A = 4"}, {"text.txt", "line\nline"}});
  EXPECT_EQ(dictionary->GetString("a"), "big");
  EXPECT_EQ(dictionary->GetString("b"), "line\nline");
}

TEST(LuaParameterDictionaryTest, IncludeReturnsValues) {
  EXPECT_EQ(Load("return include 'x.lua'", {{"x.lua", "return { v = 7 }"}})
                ->GetInt("v"),
            7);
}

TEST(LuaParameterDictionaryTest, ToStringIsLua) {
  const auto dictionary = LoadLoosely(
      "return { b = true, a = { x = 0.1, 5, 'q\"' }, c = math.huge }");
  const std::string text = dictionary->ToString();
  EXPECT_EQ(text,
            "{\n  a = {\n    x = 0.1,\n    5,\n    \"q\\\"\",\n  },\n"
            "  b = true,\n  c = math.huge,\n}");
  const auto again = LoadLoosely("return " + text);
  EXPECT_EQ(again->ToString(), text);
}

TEST(LuaParameterDictionaryTest, NotCounted) {
  const auto dictionary = LoadLoosely("return { a = 1, b = 2, c = { d = 1 } }");
  EXPECT_EQ(dictionary->GetInt("a"), 1);
  EXPECT_EQ(dictionary->GetInt("a"), 1);
  EXPECT_TRUE(dictionary->GetDictionary("c")->HasKey("d"));
}

TEST(LuaParameterDictionaryDeathTest, UnreadKey) {
  EXPECT_DEATH(Load("return { a = 1, surplus = 2 }")->GetInt("a"),
               "Key 'surplus' is not an option");
}

TEST(LuaParameterDictionaryDeathTest, KeyReadTwice) {
  EXPECT_DEATH(
      {
        const auto dictionary = Load("return { a = 1 }");
        dictionary->GetInt("a");
        dictionary->GetInt("a");
      },
      "Key 'a' was read 2 times");
}

TEST(LuaParameterDictionaryDeathTest, MessagesNameTheWholePath) {
  const auto read = [](const std::string& leaf) {
    const auto dictionary =
        Load("return { outer = { inner = { " + leaf + " } } }");
    const auto outer = dictionary->GetDictionary("outer");
    const auto inner = outer->GetDictionary("inner");
    inner->GetNonNegativeInt("leaf");
  };
  read("leaf = 1");
  EXPECT_DEATH(read("leaf = 1, other = 2"),
               "Key 'outer.inner.other' is not an option");
  EXPECT_DEATH(read(""), "Key 'outer.inner.leaf' is missing");
  EXPECT_DEATH(read("leaf = 'x'"), "Key 'outer.inner.leaf' is string, not a");
  EXPECT_DEATH(read("leaf = -1"), "Key 'outer.inner.leaf' is negative");
}

TEST(LuaParameterDictionaryDeathTest, ArrayElementsAreNamed) {
  EXPECT_DEATH(Load("return { a = { {}, { x = 1 } } }")
                   ->GetDictionary("a")
                   ->GetArrayValuesAsDictionaries(),
               "Key 'a.2.x' is not an option");
}

TEST(LuaParameterDictionaryDeathTest, WrongTypes) {
  EXPECT_DEATH(Load("return { a = 1 }")->GetBool("a"), "not a boolean");
  EXPECT_DEATH(Load("return { a = true }")->GetDouble("a"), "not a number");
  EXPECT_DEATH(Load("return { a = {} }")->GetString("a"), "not a string");
  EXPECT_DEATH(Load("return { a = 1 }")->GetDictionary("a"), "not a table");
}

TEST(LuaParameterDictionaryDeathTest, NoIntegers) {
  EXPECT_DEATH(Load("return { a = 2.5 }")->GetInt("a"),
               "Key 'a' is 2.5, not an integer");
  EXPECT_DEATH(Load("return { a = 3000000000 }")->GetInt("a"),
               "Key 'a' is 3e.09, not an integer");
}

TEST(LuaParameterDictionaryDeathTest, BrokenCode) {
  EXPECT_DEATH(Load("return {"), "expected");
  EXPECT_DEATH(Load("error('stop here')"), "stop here");
  EXPECT_DEATH(Load("return 5"), "does not return a table");
  EXPECT_DEATH(Load("return { a = choose(1, 2, 3) }"), "condition");
  EXPECT_DEATH(Load("include 'bad.lua'", {{"bad.lua", "A = = 1"}}),
               "/etc/bad.lua:1");
}

TEST(LuaParameterDictionaryDeathTest, IncludedTwice) {
  EXPECT_DEATH(
      Load("include 'a.lua'\ninclude 'a.lua'\nreturn {}", {{"a.lua", ""}}),
      "included again");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
