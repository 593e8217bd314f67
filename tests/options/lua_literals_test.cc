// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/lua_literals.h"

#include <string>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace options {
namespace {

using cartographer::common::ConfigurationFileResolver;
using cartographer::common::LuaParameterDictionary;

TEST(LuaLiteralsTest, TellsTheKindsApart) {
  const auto literals = LuaLiterals(
      "{\n  a = 1.500000,\n  b = -math.huge,\n  c = true,\n  d = \"x\",\n"
      "  e = {\n    a = false,\n  },\n  f = {},\n  g = <function>,\n}");
  ASSERT_EQ(literals.size(), 7u);
  EXPECT_EQ(literals.at("a").kind, LuaKind::NUMBER);
  EXPECT_EQ(literals.at("a").text, "1.500000");
  EXPECT_EQ(literals.at("b").kind, LuaKind::NUMBER);
  EXPECT_EQ(literals.at("c").kind, LuaKind::BOOLEAN);
  EXPECT_EQ(literals.at("d").kind, LuaKind::STRING);
  EXPECT_EQ(literals.at("d").text, "\"x\"");
  EXPECT_EQ(literals.at("e").kind, LuaKind::TABLE);
  EXPECT_EQ(literals.at("e").text, "{ ... }");
  EXPECT_EQ(literals.at("f").kind, LuaKind::TABLE);
  EXPECT_EQ(literals.at("g").kind, LuaKind::OTHER);
}

TEST(LuaLiteralsTest, StringsMayLookLikeTables) {
  const auto literals =
      LuaLiterals("{\n  a = \"x, b = 1, } \\\" {\",\n  c = 2,\n}\nrest = 3, }");
  ASSERT_EQ(literals.size(), 2u);
  EXPECT_EQ(literals.at("a").kind, LuaKind::STRING);
  EXPECT_EQ(literals.at("c").kind, LuaKind::NUMBER);
}

TEST(LuaLiteralsTest, TextThatIsNoTable) {
  for (const std::string text :
       {"", "{", "{}", "x = 1", "{ = 1", "{ a", "{ a =", "{ \"a", "{{{"}) {
    EXPECT_LE(LuaLiterals(text).size(), 1u) << text;
  }
}

TEST(LuaLiteralsTest, UnderstandsWhatTheDictionaryPrints) {
  const auto dictionary = LuaParameterDictionary::NonReferenceCounted(
      "return { 7, 'array', number = 1e-9, integer = 3, infinite = -math.huge,"
      " flag = false, text = 'say \"so\",\\n} b = 2', empty = {},"
      " table = { number = 'inner', { 1, 2 } } }",
      absl::make_unique<ConfigurationFileResolver>(std::vector<std::string>{}));
  const auto literals = LuaLiterals(dictionary->ToString());
  ASSERT_EQ(literals.size(), 7u) << dictionary->ToString();
  EXPECT_EQ(literals.at("number").kind, LuaKind::NUMBER);
  EXPECT_EQ(literals.at("integer").kind, LuaKind::NUMBER);
  EXPECT_EQ(literals.at("infinite").kind, LuaKind::NUMBER);
  EXPECT_EQ(literals.at("flag").kind, LuaKind::BOOLEAN);
  EXPECT_EQ(literals.at("text").kind, LuaKind::STRING);
  EXPECT_EQ(literals.at("empty").kind, LuaKind::TABLE);
  EXPECT_EQ(literals.at("table").kind, LuaKind::TABLE);
}

}  // namespace
}  // namespace options
}  // namespace cartographer_ext
