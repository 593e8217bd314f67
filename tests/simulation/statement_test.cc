// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/statement.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using ::testing::HasSubstr;

std::string Message(Statement* const statement) {
  return std::string(statement->Finish().message());
}

TEST(StatementTest, ReadsValuesAndOptions) {
  Statement statement(
      "  circle 3 -4.5 name\tr=0.3 at=1,2 at=-3,4 kind=glass # r=7 end",
      "a.world:12");
  EXPECT_EQ(statement.keyword(), "circle");
  EXPECT_EQ(statement.Point("centre"), Eigen::Vector2d(3., -4.5));
  EXPECT_EQ(statement.Word("name"), "name");
  EXPECT_FALSE(statement.has_values());
  EXPECT_TRUE(statement.Has("r"));
  EXPECT_FALSE(statement.Has("end"));
  EXPECT_EQ(statement.Option("r", 1., 0., 1.), 0.3);
  EXPECT_EQ(statement.Option("absent", 0.25, 0., 1.), 0.25);
  EXPECT_EQ(statement.WordOption("kind", "wall"), "glass");
  EXPECT_EQ(statement.WordOption("absent", "wall"), "wall");
  const std::vector<std::vector<double>> expected = {{1., 2.}, {-3., 4.}};
  EXPECT_EQ(statement.ListOptions("at", 2, 10.), expected);
  EXPECT_TRUE(statement.Finish().ok());
}

TEST(StatementTest, NothingButACommentHasNoKeyword) {
  EXPECT_EQ(Statement("", "w").keyword(), "");
  EXPECT_EQ(Statement("  # circle 1 2", "w").keyword(), "");
}

TEST(StatementTest, MistakesNamePlaceValueAndRange) {
  Statement missing("turn", "a.world:3");
  EXPECT_EQ(missing.Number("angle", -360., 360.), 0.);
  EXPECT_EQ(Message(&missing), "a.world:3: 'turn': angle is missing");
  Statement text("turn x7", "w");
  text.Number("angle", -360., 360.);
  EXPECT_THAT(Message(&text), HasSubstr("angle 'x7' is not a number"));
  Statement infinite("turn inf", "w");
  infinite.Number("angle", -360., 360.);
  EXPECT_THAT(Message(&infinite), HasSubstr("angle 'inf' is not a number"));
  Statement large("turn 361", "w");
  large.Number("angle", -360., 360.);
  EXPECT_THAT(Message(&large), HasSubstr("angle 361 is outside [-360, 360]"));
  Statement word("world a/b", "w");
  EXPECT_EQ(word.Word("name"), "");
  EXPECT_THAT(Message(&word), HasSubstr("name 'a/b' may hold letters"));
  Statement few("line 1 2", "w");
  few.Points(2);
  EXPECT_THAT(Message(&few), HasSubstr("needs at least 2 points, got 1"));
  Statement list("wall at=1,2,3", "w");
  list.ListOptions("at", 2, 10.);
  EXPECT_THAT(Message(&list),
              HasSubstr("option at needs 2 comma separated numbers, got 3"));
  Statement twice("robot r=1 r=2", "w");
  twice.Option("r", 0., 0., 9.);
  EXPECT_THAT(Message(&twice), HasSubstr("option r is given twice"));
}

TEST(StatementTest, WhatIsLeftOverIsAMistake) {
  Statement value("turn 90 80", "w");
  value.Number("angle", -360., 360.);
  EXPECT_THAT(Message(&value), HasSubstr("unexpected value '80'"));
  Statement option("turn 90 spede=2", "w");
  option.Number("angle", -360., 360.);
  EXPECT_THAT(Message(&option), HasSubstr("unknown option 'spede'"));
}

TEST(StatementTest, TheFirstMistakeIsTold) {
  Statement statement("turn x y=1", "w");
  statement.Number("angle", -360., 360.);
  statement.Fail("something else");
  EXPECT_THAT(Message(&statement), HasSubstr("angle 'x' is not a number"));
}

// Rubbish is neither printed as it is nor at any length.
TEST(StatementTest, QuotesRubbishSafely) {
  Statement statement("turn \x01" + std::string(100, 'z'), "w");
  statement.Number("angle", -360., 360.);
  EXPECT_THAT(Message(&statement),
              HasSubstr("'?" + std::string(39, 'z') + "...' is not"));
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
