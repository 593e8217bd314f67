// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/objective.h"

#include "cartographer_ext/configuration/lua_value.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;

TEST(ObjectiveTest, ReadsWeights) {
  const auto name = ParseWeights(nlohmann::json("ate"));
  ASSERT_TRUE(name.ok());
  EXPECT_EQ(name->at("ate"), 1.);
  const auto table = ParseWeights(*evaluation::EvaluateLua(
      "return { relations = 1, cpu_seconds = 0.01 }", "t", {}));
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(table->at("cpu_seconds"), 0.01);
  const auto flag = ParseWeights(std::string("relations:2,wall_seconds"));
  ASSERT_TRUE(flag.ok());
  EXPECT_EQ(flag->at("relations"), 2.);
  EXPECT_EQ(flag->at("wall_seconds"), 1.);
}

TEST(ObjectiveTest, RefusesUnknownNamesAndWeights) {
  EXPECT_THAT(
      std::string(ParseWeights(std::string("beauty")).status().message()),
      HasSubstr("unknown objective 'beauty'"));
  EXPECT_FALSE(ParseWeights(std::string("ate:-1")).ok());
  EXPECT_FALSE(ParseWeights(std::string("ate:x")).ok());
  EXPECT_FALSE(ParseWeights(std::string("")).ok());
  EXPECT_FALSE(ParseWeights(nlohmann::json(3)).ok());
  EXPECT_FALSE(ParseWeights(nlohmann::json({{"ate", "much"}})).ok());
  EXPECT_FALSE(ParseAggregation("sum").ok());
}

TEST(ObjectiveTest, WeighsTheNumbersOfARun) {
  Objective objective;
  objective.weights = {{"relations", 2.}, {"cpu_seconds", 0.1}};
  const auto value =
      EvaluateRun(objective, {{"relations", 0.5}, {"cpu_seconds", 30.}});
  ASSERT_TRUE(value.ok());
  EXPECT_NEAR(*value, 4., 1e-12);
  EXPECT_THAT(
      std::string(
          EvaluateRun(objective, {{"cpu_seconds", 1.}}).status().message()),
      HasSubstr("no 'relations'"));
}

TEST(ObjectiveTest, PrecisionAtRecall) {
  Objective objective;
  objective.weights = {{"precision_at_recall", 1.}};
  objective.target_recall = 0.5;
  const auto at = [&](double precision, double recall) {
    return *EvaluateRun(
        objective, {{"loop_precision", precision}, {"loop_recall", recall}});
  };
  EXPECT_NEAR(at(0.9, 0.6), 0.1, 1e-12);
  EXPECT_NEAR(at(0.9, 0.5), 0.1, 1e-12);
  // Too few loops are worse than all loops wrong.
  EXPECT_NEAR(at(1., 0.25), 1.5, 1e-12);
  EXPECT_NEAR(at(1., 0.), 2., 1e-12);
  EXPECT_FALSE(EvaluateRun(objective, {{"loop_precision", 1.}}).ok());
}

TEST(ObjectiveTest, AggregatesOverRecordings) {
  Objective objective;
  EXPECT_NEAR(Aggregate(objective, {1., 3.}), 2., 1e-12);
  objective.aggregation = *ParseAggregation("max");
  EXPECT_NEAR(Aggregate(objective, {1., 3., 2.}), 3., 1e-12);
  objective.aggregation = *ParseAggregation("geometric_mean");
  EXPECT_NEAR(Aggregate(objective, {0.1, 10.}), 1., 1e-12);
}

TEST(WhyNotBetterTest, ClearGainsAreBelieved) {
  EXPECT_EQ(WhyNotBetter({1.}, {0.9}, 0.005), "");
  EXPECT_EQ(WhyNotBetter({1., 2.}, {0.9, 1.9}, 0.005), "");
  EXPECT_EQ(WhyNotBetter({1., 2., 3.}, {0.9, 1.7, 2.6}, 0.005), "");
}

TEST(WhyNotBetterTest, NothingAndLossesAreNot) {
  EXPECT_THAT(WhyNotBetter({1.}, {1.}, 0.005), HasSubstr("change by -0.0 %"));
  EXPECT_THAT(WhyNotBetter({1.}, {1.1}, 0.005), HasSubstr("+9.1 %"));
  EXPECT_THAT(WhyNotBetter({1.}, {0.998}, 0.005), HasSubstr("-0.2 %"));
  EXPECT_THAT(WhyNotBetter({1., 1.}, {0.5, 1.01}, 0.005),
              HasSubstr("not all of them"));
  EXPECT_THAT(WhyNotBetter({}, {}, 0.005), HasSubstr("could be judged"));
  EXPECT_THAT(WhyNotBetter({0.}, {0.}, 0.005), HasSubstr("change by"));
}

TEST(WhyNotBetterTest, ChanceIsNot) {
  // -1.2 % in the mean, of gains and losses.
  EXPECT_THAT(WhyNotBetter({1., 1., 1., 1.}, {0.9, 1.05, 0.95, 1.052}, 0.005),
              HasSubstr("is not significant"));
  // t = 2.4 at three degrees of freedom: above 2.353; at two below 2.920.
  EXPECT_EQ(WhyNotBetter({1., 1., 1., 1.}, {0.98, 0.98, 0.98, 1.0}, 0.005), "");
  EXPECT_THAT(WhyNotBetter({1., 1., 1.}, {0.98, 0.98, 1.0}, 0.005),
              HasSubstr("is not significant"));
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
