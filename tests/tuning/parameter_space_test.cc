// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/parameter_space.h"

#include "cartographer_ext/configuration/lua_value.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

absl::StatusOr<std::vector<Parameter>> Parse(const std::string& lua) {
  return ParseParameters(
      *evaluation::EvaluateLua("return { " + lua + " }", "t", {}));
}

Parameter One(const std::string& lua) {
  const auto parameters = Parse(lua);
  EXPECT_TRUE(parameters.ok()) << parameters.status();
  return parameters->front();
}

TEST(ParameterSpaceTest, LinearRange) {
  const Parameter p = One("{ key = 'A.b', range = { 0.4, 0.8 } }");
  EXPECT_EQ(p.key, "A.b");
  EXPECT_EQ(p.FromUnit(0.), 0.4);
  EXPECT_EQ(p.FromUnit(0.5), 0.6);
  EXPECT_EQ(p.FromUnit(1.), 0.8);
  EXPECT_EQ(p.FromUnit(-3.), 0.4);
  EXPECT_EQ(p.FromUnit(7.), 0.8);
  // Four digits.
  EXPECT_EQ(p.FromUnit(1. / 3.), 0.5333);
  EXPECT_NEAR(p.ToUnit(0.5), 0.25, 1e-12);
  EXPECT_EQ(p.ToUnit(0.1), 0.);
  EXPECT_THAT(p.GridValues(), ElementsAre(0.4, 0.5, 0.6, 0.7, 0.8));
}

TEST(ParameterSpaceTest, LogarithmicRange) {
  const Parameter p =
      One("{ key = 'a', range = { 1, 1000 }, scale = 'log', steps = 4 }");
  EXPECT_THAT(p.GridValues(), ElementsAre(1., 10., 100., 1000.));
  EXPECT_NEAR(p.ToUnit(10.), 1. / 3., 1e-12);
}

TEST(ParameterSpaceTest, IntegersAreNotRepeated) {
  const Parameter p =
      One("{ key = 'a', range = { 1, 3 }, integer = true, steps = 9 }");
  EXPECT_THAT(p.GridValues(), ElementsAre(1, 2, 3));
  EXPECT_TRUE(p.FromUnit(0.3).is_number_integer());
}

TEST(ParameterSpaceTest, ChoicesShareTheUnitIntervalEqually) {
  const Parameter p = One("{ key = 'a', choices = { false, 7, 'x' } }");
  EXPECT_THAT(p.GridValues(), ElementsAre(false, 7, "x"));
  EXPECT_EQ(p.FromUnit(0.), false);
  EXPECT_EQ(p.FromUnit(0.34), 7);
  EXPECT_EQ(p.FromUnit(1.), "x");
  for (const Value& choice : p.choices) {
    EXPECT_EQ(p.FromUnit(p.ToUnit(choice)), choice);
  }
}

TEST(ParameterSpaceTest, FilesToIncludeAreChoices) {
  const Parameter p =
      One("{ include = 'front_end', choices = { '', 'a.lua' } }");
  EXPECT_TRUE(p.is_include());
  EXPECT_EQ(p.key, "include.front_end");
  EXPECT_EQ(p.FromUnit(0.9), "a.lua");
  EXPECT_FALSE(One("{ key = 'a', choices = { 1 } }").is_include());
  EXPECT_THAT(
      std::string(
          Parse("{ include = 'a', range = { 0, 1 } }").status().message()),
      HasSubstr("needs names of Lua files as choices"));
  EXPECT_THAT(
      std::string(
          Parse("{ include = 'a', choices = { true } }").status().message()),
      HasSubstr("parameters[1] (include.a) needs names"));
  EXPECT_THAT(
      std::string(Parse("{ include = 'a', key = 'b', choices = { '' } }")
                      .status()
                      .message()),
      HasSubstr("has key and include"));
}

TEST(ParameterSpaceTest, AssignmentIsInAlphabeticalOrder) {
  const auto parameters = *Parse(
      "{ key = 'b', range = { 0, 1 } }, { key = 'a', range = { 0, 1 } }");
  EXPECT_EQ(ToAssignment(parameters, {0.5, 2}).dump(), "{\"a\":2,\"b\":0.5}");
}

std::string ErrorOf(const std::string& lua) {
  const auto parameters = Parse(lua);
  EXPECT_FALSE(parameters.ok()) << lua;
  return std::string(parameters.status().message());
}

TEST(ParameterSpaceTest, ErrorsNameEntryAndKey) {
  EXPECT_THAT(ErrorOf("{ key = 'A.x', range = { 0.8, 0.4 } }"),
              testing::AllOf(HasSubstr("parameters[1] (A.x)"),
                             HasSubstr("empty range, 0.8 to 0.4")));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 1, 1 } }"),
              HasSubstr("empty range"));
  EXPECT_THAT(ErrorOf("{ range = { 1, 2 } }"), HasSubstr("no key"));
  EXPECT_THAT(ErrorOf("{ key = 'a b', range = { 1, 2 } }"),
              HasSubstr("not a Lua name"));
  EXPECT_THAT(ErrorOf("{ key = 'a..b', range = { 1, 2 } }"),
              HasSubstr("not a Lua name"));
  EXPECT_THAT(ErrorOf("{ key = 'a' }"), HasSubstr("either range"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 1 } }"), HasSubstr("low, high"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 0, math.huge } }"),
              HasSubstr("not finite"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 0, 1 }, scale = 'log' }"),
              HasSubstr("above 0"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 0, 1 }, scale = 'cubic' }"),
              HasSubstr("scale other"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 0, 1.5 }, integer = true }"),
              HasSubstr("integers"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 0, 1 }, steps = 1 }"),
              HasSubstr("steps"));
  EXPECT_THAT(ErrorOf("{ key = 'a', choices = {} }"), HasSubstr("no choices"));
  EXPECT_THAT(ErrorOf("{ key = 'a', choices = { 1, 1 } }"), HasSubstr("twice"));
  EXPECT_THAT(ErrorOf("{ key = 'a', choices = { {} } }"), HasSubstr("choice"));
  EXPECT_THAT(ErrorOf("{ key = 'a', range = { 0, 1 }, rang = 1 }"),
              HasSubstr("unknown key 'rang', did you mean 'range'?"));
  EXPECT_THAT(
      ErrorOf("{ key='a', range={ 0, 1 } }, { key='a', range={ 0, 1 } }"),
      HasSubstr("listed twice"));
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
