// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/sections.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/report/report_example.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SectionSummaryTest, HeadingsHaveAnchors) {
  Markup page;
  AddHeading("loops", "Loops & more", &page);
  EXPECT_THAT(page.str(), HasSubstr("<h2 id=\"loops\">Loops &amp; more</h2>"));
}

TEST(SectionSummaryTest, TilesAndOnlyRowsThatTell) {
  ReportData data = test::ExampleData(true);
  data.notes = {"a < b"};
  Markup page;
  AddSummary(data, &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<b>5</b>\n<span>nodes</span>"));
  EXPECT_THAT(html, HasSubstr("<b>2</b>\n<span>submaps</span>"));
  EXPECT_THAT(html, HasSubstr("<b>3</b>\n<span>loops</span>"));
  EXPECT_THAT(html, HasSubstr("<b>4.0 m</b>\n<span>path</span>"));
  EXPECT_THAT(html, HasSubstr("<p>a &lt; b</p>"));
  // Columns of both runs.
  EXPECT_THAT(html, HasSubstr("as stored"));
  EXPECT_THAT(html, HasSubstr("ours"));
  EXPECT_THAT(html, HasSubstr("loop residual, mean"));
  // Two metres of one loop in three.
  EXPECT_THAT(html, HasSubstr("0.667 m"));
  // There is no truth, and nothing about self-consistency.
  EXPECT_THAT(html, Not(HasSubstr("relations, mean error")));
  EXPECT_THAT(html, Not(HasSubstr("mean map entropy")));
  EXPECT_THAT(html, Not(HasSubstr("trajectory error")));
}

TEST(SectionSummaryTest, TruthAndVerdict) {
  ReportData data = test::ExampleData(false);
  evaluation::Evaluation& evaluation = data.runs[0].evaluation;
  evaluation.consistency = test::ExampleConsistency();
  evaluation.relations.emplace();
  evaluation.relations->all.translation.mean = 0.1234;
  evaluation.relations->all.fraction_above_half_metre = 0.25;
  evaluation.trajectory.emplace();
  evaluation.trajectory->ate.rmse = 0.5;
  evaluation.loops->judged = 3;
  evaluation.loops->correct = 2;
  evaluation.loops->recall = 0.5;
  Markup page;
  AddSummary(data, &page);
  const std::string& html = page.str();
  const evaluation::Verdict verdict = evaluation::Judge(evaluation);
  EXPECT_THAT(html, HasSubstr("class=\"verdict " + verdict.word + "\""));
  EXPECT_THAT(html, HasSubstr("<b>0.123 m</b>"));
  EXPECT_THAT(html, HasSubstr("0.1234 m"));
  EXPECT_THAT(html, HasSubstr("25.0 %"));
  EXPECT_THAT(html, HasSubstr("<b>0.500 m</b>"));
  EXPECT_THAT(html, HasSubstr("2 / 3"));
  EXPECT_THAT(html, HasSubstr("<b>40.0 %</b>"));
  EXPECT_THAT(html, HasSubstr("open loop cycles"));
}

// Headline, reasons and JSON say one verdict whatever truth and the map itself
// say.
TEST(SectionSummaryTest, OneVerdictOneVoice) {
  const std::vector<std::string> words = {"unknown", "sound", "doubtful",
                                          "broken"};
  const std::string otherwise = "without ground truth the verdict would be ";
  for (const std::string& by_map : words) {
    for (const double fraction : {-1., 0., 0.01, 0.5}) {
      ReportData data = test::ExampleData(false);
      evaluation::Evaluation& evaluation = data.runs[0].evaluation;
      evaluation.consistency = test::ExampleConsistency();
      evaluation.consistency->word = by_map;
      evaluation.consistency->reasons = {"the headline", "a figure"};
      if (fraction >= 0.) {
        evaluation.relations.emplace();
        evaluation.relations->loop.count = 100;
        evaluation.relations->loop.fraction_above_half_metre = fraction;
      }
      const std::string word = evaluation::Judge(evaluation).word;
      EXPECT_EQ(word, fraction < 0.    ? by_map
                      : fraction == 0. ? "sound"
                      : fraction < 0.1 ? "doubtful"
                                       : "broken");
      const auto json = evaluation::ToJson(evaluation);
      EXPECT_EQ(json["verdict"], word);
      Markup page;
      AddSummary(data, &page);
      EXPECT_THAT(page.str(), HasSubstr("<div class=\"verdict " + word));
      EXPECT_THAT(page.str(), HasSubstr("Map " + word));
      bool is_named = false;
      for (std::string reason : json["reasons"]) {
        EXPECT_THAT(page.str(), HasSubstr("<li>" + reason));
        if (reason.rfind(otherwise, 0) == 0) {
          is_named = true;
          EXPECT_EQ(reason, otherwise + by_map + ": the headline");
          continue;
        }
        for (const std::string& other : words) {
          EXPECT_THAT(reason, Not(HasSubstr(other)));
        }
      }
      EXPECT_EQ(is_named, word != by_map);
    }
  }
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
