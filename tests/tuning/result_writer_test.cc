// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/result_writer.h"

#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/tuning/sensitivity_plot.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Trial MakeTrial(const Point& point, const std::vector<double>& objectives) {
  Trial trial;
  trial.ok = true;
  trial.point = point;
  trial.objectives = objectives;
  trial.objective = (objectives[0] + objectives[1]) / 2.;
  return trial;
}

ResultContext Context() {
  ResultContext context;
  context.configuration = "stock.lua";
  context.directories = {"/conf"};
  context.filename = "tuned.lua";
  context.objective = "relations";
  context.parameters.resize(2);
  context.parameters[0].key = "A.score";
  context.parameters[1].key = "A.cartographer_ext.fusion.window";
  context.parameters[1].low = 1.;
  context.parameters[1].high = 100.;
  context.parameters[1].log_scale = true;
  context.inputs.resize(2);
  context.inputs[0].name = "one.clf@12+one.tum@345";
  context.inputs[1].name = "t@2wo.world#3@67";
  return context;
}

TuneResult Result() {
  TuneResult result;
  result.baseline = MakeTrial({0.5, 10}, {1., 3.});
  result.best = MakeTrial({0.625, 20}, {0.5, 0.5});
  result.trials = {result.best, MakeTrial({0.9, 2}, {4., 4.})};
  Trial failed;
  failed.point = {0.1, 1};
  failed.message = "it crashed";
  result.trials.push_back(failed);
  result.keys.resize(2);
  result.keys[0].key = "A.score";
  result.keys[0].before = 0.5;
  result.keys[0].after = 0.625;
  result.keys[0].gain = 0.25;
  result.keys[0].better_on = 2;
  result.keys[1].key = "A.cartographer_ext.fusion.window";
  result.keys[1].before = 10;
  result.keys[1].after = 20;
  result.baseline_holdout = MakeTrial({0.5, 10}, {8., 8.});
  result.best_holdout = MakeTrial({0.625, 20}, {6., 6.});
  return result;
}

TEST(ResultWriterTest, TheLuaFileSetsTheKeys) {
  const std::string text = ToLuaFile(Result(), Context());
  EXPECT_THAT(text, HasSubstr("relations, 2 -> 0.5 (-75.0 %)"));
  // Without the sizes that the journal has.
  EXPECT_THAT(text, HasSubstr("--   one.clf: 1 -> 0.5\n"));
  EXPECT_THAT(text, HasSubstr("--   t@2wo.world#3: 3 -> 0.5\n"));
  EXPECT_THAT(text, HasSubstr("Held out: 8 -> 6"));
  EXPECT_THAT(text, HasSubstr("Before: 0.5; gain 0.25 (50.0 % of the result), "
                              "better on 2 of 2 recordings; confidence: "
                              "medium"));
  EXPECT_THAT(text, HasSubstr("confidence: not measured"));
  // Tables of the block that the configuration leaves out are made.
  const auto value = evaluation::EvaluateLua(
      "A = { score = 0.5, cartographer_ext = { other = 3 } }\n"
      "function include(name) return { a = A, name = name } end\n" +
          text,
      "t", {});
  ASSERT_TRUE(value.ok()) << value.status();
  EXPECT_EQ((*value)["name"], "stock.lua");
  const auto& table = (*value)["a"];
  EXPECT_EQ(table["score"], 0.625);
  EXPECT_EQ(table["cartographer_ext"]["fusion"]["window"], 20);
  EXPECT_EQ(table["cartographer_ext"]["other"], 3);
  EXPECT_THAT(text, HasSubstr("-configuration_directory=.,/conf "
                              "-configuration_basename=tuned.lua"));
}

TEST(ResultWriterTest, FilesAreIncludedFirst) {
  TuneResult result = Result();
  result.keys[1].key = "include.front_end";
  result.keys[1].before = "";
  result.keys[1].after = "front_end_default.lua";
  const std::string text = ToLuaFile(result, Context());
  const size_t include = text.find("\ninclude \"front_end_default.lua\"\n");
  ASSERT_NE(include, std::string::npos) << text;
  EXPECT_LT(include, text.find("A.score = 0.625"));
}

TEST(ResultWriterTest, SaysWhenNothingWasBetter) {
  TuneResult result = Result();
  result.best = result.baseline;
  result.keys.clear();
  EXPECT_THAT(
      ToLuaFile(result, Context()),
      testing::AllOf(HasSubstr("Nothing was better"),
                     testing::EndsWith("return include \"stock.lua\"\n")));
  EXPECT_THAT(ToText(result, Context()), HasSubstr("Nothing was better"));
  result.not_confirmed = "held-out recordings change by +3.0 %";
  for (const std::string& text :
       {ToLuaFile(result, Context()), ToText(result, Context())}) {
    EXPECT_THAT(text, HasSubstr("is not confirmed, held-out recordings change "
                                "by +3.0 %."));
  }
}

TEST(ResultWriterTest, Confidence) {
  KeyResult key;
  EXPECT_EQ(Confidence(key, 2), "not measured");
  key.gain = 1.;
  key.better_on = 3;
  EXPECT_EQ(Confidence(key, 3), "high");
  EXPECT_EQ(Confidence(key, 4), "medium");
  EXPECT_EQ(Confidence(key, 5), "low");
  key.better_on = 1;
  EXPECT_EQ(Confidence(key, 1), "low");
  EXPECT_EQ(Confidence(key, 2), "low");
  key.better_on = 2;
  EXPECT_EQ(Confidence(key, 2), "medium");
}

TEST(ResultWriterTest, TheTableNamesEveryKey) {
  const std::string text = ToText(Result(), Context());
  EXPECT_THAT(text, HasSubstr("Trials     3 (0 on a part"));
  EXPECT_THAT(text, HasSubstr("1 failed"));
  EXPECT_THAT(text, HasSubstr("A.score\n  0.5 -> 0.625"));
  EXPECT_THAT(text, HasSubstr("Held out   8 -> 6  -25.0 %"));
  EXPECT_THAT(text, HasSubstr("Sensitivity: unknown from 2 trials on whole"));
}

TEST(ResultWriterTest, JsonHasTheAgreedKeys) {
  const auto json = ToJson(Result(), Context());
  EXPECT_EQ(json["best"]["objective"], 0.5);
  EXPECT_EQ(json["best"]["holdout"], 6.);
  EXPECT_EQ(json["best"]["keys"]["A.score"], 0.625);
  EXPECT_EQ(json["trials"], 3);
  EXPECT_EQ(json["baseline"]["objective"], 2.);
  EXPECT_EQ(json["trial_list"][2]["status"], "failed");
  TuneResult without = Result();
  without.best_holdout.reset();
  EXPECT_TRUE(ToJson(without, Context())["best"]["holdout"].is_null());
}

TEST(SensitivityPlotTest, WritesPngAndSvg) {
  const test::Folder folder;
  ASSERT_TRUE(
      WriteSensitivityPlot(Result(), Context(), folder.path() + "/a.png").ok());
  EXPECT_THAT(folder.Read("a.png"), StartsWith("\x89PNG"));
  ASSERT_TRUE(
      WriteSensitivityPlot(Result(), Context(), folder.path() + "/a.svg").ok());
  EXPECT_THAT(folder.Read("a.svg"), HasSubstr("<svg"));
  EXPECT_FALSE(
      WriteSensitivityPlot(Result(), Context(), folder.path() + "/no/a.png")
          .ok());
}

TEST(SensitivityPlotTest, SurvivesASearchWithoutTrials) {
  const test::Folder folder;
  TuneResult result = Result();
  result.trials.clear();
  result.best = result.baseline;
  EXPECT_TRUE(
      WriteSensitivityPlot(result, Context(), folder.path() + "/a.png").ok());
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
