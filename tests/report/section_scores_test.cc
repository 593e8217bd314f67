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

TEST(SectionScoresTest, WithoutLoopsThereIsNothing) {
  ReportData data = test::ExampleData(false);
  data.runs[0].graph.constraints.clear();
  Markup page;
  AddScores(data, test::Prepare(data), &page);
  EXPECT_TRUE(page.empty());
}

TEST(SectionScoresTest, WithoutScoresThereAreNoHistograms) {
  const ReportData data = test::ExampleData(false);
  Markup page;
  AddScores(data, test::Prepare(data), &page);
  EXPECT_THAT(page.str(), HasSubstr("<h2 id=\"scores\">"));
  EXPECT_THAT(page.str(), Not(HasSubstr("<figure")));
}

TEST(SectionScoresTest, FineAndSuspiciousLoopsStandOnEachOther) {
  ReportData data = test::ExampleData(false);
  data.stock_min_score = 0.55;
  Prepared prepared = test::Prepare(data);
  prepared.evidence[0][0].score = 0.81;
  prepared.evidence[0][1].score = 0.81;  // suspicious: two metres off
  Markup page;
  AddScores(data, prepared, &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("Scores of loops"));
  EXPECT_THAT(html, HasSubstr("min_score 0.55"));
  EXPECT_THAT(html, HasSubstr("Residuals of loops"));
  EXPECT_THAT(html, HasSubstr(": 1 fine"));
  EXPECT_THAT(html, HasSubstr(": 1 suspicious"));
  // Two loops lie where the map has them, in the first bar.
  EXPECT_THAT(html, HasSubstr("-3 to -2.89: 2 fine"));
  EXPECT_THAT(html, Not(HasSubstr("rejected or suspicious")));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(SectionScoresTest, TheTwoScoresAgainstEachOther) {
  ReportData data = test::ExampleData(true);
  Markup page;
  AddScores(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("Grid score against temporal score"));
  EXPECT_THAT(html, HasSubstr("submap (0, 0) - node (0, 2)"));
  EXPECT_THAT(html, HasSubstr("S_g 0.600, S_t 0.200"));
  EXPECT_THAT(html, HasSubstr("rejected or suspicious"));
  // No mixture was in force.
  EXPECT_THAT(html, Not(HasSubstr("ellipses")));
  auto* const parts = data.runs[1].rerun->decisions[0].mutable_fusion();
  for (auto* part :
       {parts->mutable_true_loops(), parts->mutable_false_loops()}) {
    part->set_mean_grid(0.7);
    part->set_mean_temporal(0.5);
    part->set_variance_grid(0.01);
    part->set_variance_temporal(0.01);
  }
  Markup with_mixture;
  AddScores(data, test::Prepare(data), &with_mixture);
  EXPECT_THAT(with_mixture.str(), HasSubstr("ellipses"));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
