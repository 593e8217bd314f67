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

TEST(SectionWorstTest, WithoutLoopsThereIsNothing) {
  ReportData data = test::ExampleData(false);
  data.runs[0].graph.constraints.clear();
  Markup page;
  AddWorstLoops(data, test::Prepare(data), &page);
  EXPECT_TRUE(page.empty());
}

TEST(SectionWorstTest, TheSuspiciousOneComesFirst) {
  const ReportData data = test::ExampleData(false);
  Markup page;
  AddWorstLoops(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<h2 id=\"worst\">"));
  EXPECT_THAT(html, HasSubstr("The 3 worst of 3 loops of the map as stored"));
  EXPECT_LT(html.find("(0, 3)"), html.find("(0, 2)"));
  EXPECT_THAT(html, HasSubstr("3.0 s"));
  EXPECT_THAT(html, HasSubstr("2.000 m"));
  EXPECT_THAT(html, HasSubstr("none near"));
  EXPECT_THAT(html, HasSubstr("not known"));
  // There are no scans to draw.
  EXPECT_THAT(html, Not(HasSubstr("<figure")));
}

TEST(SectionWorstTest, ScansAreDrawnOncePerVisit) {
  ReportData data = test::ExampleData(false);
  evaluation::MapContents contents;
  for (int i = 2; i < 5; ++i) contents.scans[{0, i}] = {{1., 0.}, {0., 1.}};
  data.contents = &contents;
  Prepared prepared = test::Prepare(data);
  prepared.evidence[0][1].truth = evaluation::LoopVerdict::kWrong;
  prepared.evidence[0][1].truth_translation = 2.05;
  prepared.evidence[0][0].truth = evaluation::LoopVerdict::kCorrect;
  prepared.evidence[0][2].partners = 4;
  prepared.evidence[0][2].open_share = 0.25;
  Markup page;
  AddWorstLoops(data, prepared, &page);
  const std::string& html = page.str();
  // The three nodes are one visit of the submap.
  EXPECT_EQ(test::Count(html, "<figure"), 1u);
  EXPECT_EQ(test::Count(html, "class=\"dots "), 2u);
  EXPECT_THAT(html, HasSubstr("submap (0, 0), node (0, 3)"));
  EXPECT_THAT(html, HasSubstr("wrong (2.05 m)"));
  EXPECT_THAT(html, HasSubstr("right (0.00 m)"));
  EXPECT_THAT(html, HasSubstr("25 % of 4"));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
