// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/evaluation_report.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

RelationsMetric Relations(double fraction_of_loops) {
  RelationsMetric metric;
  metric.all.count = 1100;
  metric.all.translation.mean = 0.25;
  metric.loop.count = 100;
  metric.loop.fraction_above_half_metre = fraction_of_loops;
  metric.sequential.count = 1000;
  return metric;
}

TEST(EvaluationReportTest, NothingKnownIsUnknown) {
  const Evaluation evaluation;
  EXPECT_EQ(Judge(evaluation).word, "unknown");
  EXPECT_EQ(ToJson(evaluation)["verdict"], "unknown");
  EXPECT_THAT(ToText(evaluation), testing::HasSubstr("Verdict: unknown"));
}

TEST(EvaluationReportTest, LoopRelationsDecide) {
  Evaluation evaluation;
  evaluation.relations = Relations(0.);
  EXPECT_EQ(Judge(evaluation).word, "sound");
  evaluation.relations = Relations(0.01);
  EXPECT_EQ(Judge(evaluation).word, "doubtful");
  evaluation.relations = Relations(0.05);
  EXPECT_EQ(Judge(evaluation).word, "broken");
  ASSERT_EQ(Judge(evaluation).reasons.size(), 1u);
  EXPECT_THAT(Judge(evaluation).reasons[0], testing::HasSubstr("5.0 %"));
}

TEST(EvaluationReportTest, TheWorstSignDecides) {
  Evaluation evaluation;
  evaluation.relations = Relations(0.);
  evaluation.trajectory.emplace();
  evaluation.trajectory->ate.rmse = 0.1;
  EXPECT_EQ(Judge(evaluation).word, "sound");
  evaluation.trajectory->ate.rmse = 0.7;
  EXPECT_EQ(Judge(evaluation).word, "doubtful");
  evaluation.trajectory->ate.rmse = 7.;
  EXPECT_EQ(Judge(evaluation).word, "broken");
}

TEST(EvaluationReportTest, LoopsAgainstTheMapRaiseDoubts) {
  Evaluation evaluation;
  evaluation.loops.emplace();
  evaluation.loops->accepted = 2;
  evaluation.loops->loops.resize(2);
  evaluation.loops->loops[0].residual_translation = 0.01;
  EXPECT_EQ(Judge(evaluation).word, "unknown");
  evaluation.loops->loops[1].residual_translation = 3.;
  EXPECT_EQ(Judge(evaluation).word, "doubtful");
}

TEST(EvaluationReportTest, JsonHasTheAgreedKeys) {
  Evaluation evaluation;
  evaluation.relations = Relations(0.05);
  evaluation.trajectory.emplace();
  evaluation.loops.emplace();
  evaluation.loops->accepted = 7;
  evaluation.loops->precision = 0.5;
  const auto json = ToJson(evaluation);
  EXPECT_EQ(json["relations"]["count"], 1100);
  EXPECT_EQ(json["relations"]["translation"]["mean"], 0.25);
  for (const char* part : {"loop", "sequential"}) {
    for (const char* quantity : {"translation", "rotation_degrees"}) {
      for (const char* key : {"mean", "std", "median"}) {
        EXPECT_TRUE(json["relations"][part][quantity][key].is_number());
        EXPECT_TRUE(json["relations"][quantity][key].is_number());
      }
    }
  }
  EXPECT_EQ(json["relations"]["loop"]["fraction_above_half_metre"], 0.05);
  for (const char* key : {"rmse", "mean", "max"}) {
    EXPECT_TRUE(json["ate"][key].is_number());
    EXPECT_TRUE(json["rpe"][key].is_number());
  }
  EXPECT_EQ(json["loops"]["accepted"], 7);
  EXPECT_TRUE(json["loops"]["rejected"].is_number());
  EXPECT_EQ(json["loops"]["precision"], 0.5);
  EXPECT_TRUE(json["loops"]["recall"].is_null());
  EXPECT_EQ(json["verdict"], "broken");
}

TEST(EvaluationReportTest, TextShowsEveryPart) {
  Evaluation evaluation;
  evaluation.relations = Relations(0.05);
  evaluation.trajectory.emplace();
  evaluation.loops.emplace();
  const std::string text = ToText(evaluation);
  for (const char* part : {"Relations", "sequential", "Absolute trajectory",
                           "Relative error", "Loops", "Verdict: broken"}) {
    EXPECT_THAT(text, testing::HasSubstr(part));
  }
  EXPECT_EQ(text.back(), '\n');
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
