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

TEST(SectionLoopsTest, LinesByVerdict) {
  const ReportData data = test::ExampleData(true);
  Markup page;
  AddLoops(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<h2 id=\"loops\">Loops</h2>"));
  EXPECT_EQ(test::Count(html, "<figure"), 2u);
  // Two fine and one suspicious; then one of each and the rejected candidate.
  EXPECT_EQ(test::Count(html, "class=\"loop s5\""), 3u);
  EXPECT_EQ(test::Count(html, "class=\"loop s2 bad\""), 2u);
  EXPECT_EQ(test::Count(html, "class=\"loop s6 bad\""), 1u);
  EXPECT_EQ(test::Count(html, "rejected candidate"), 1u);
  EXPECT_THAT(html, Not(HasSubstr("right by ground truth")));
  EXPECT_THAT(html, Not(HasSubstr("th is drawn")));
}

TEST(SectionLoopsTest, ALoopHasWhatAClickShows) {
  ReportData data = test::ExampleData(false);
  evaluation::MapContents contents;
  contents.scans[{0, 3}] = {{1.234, -0.5}, {2., 0.}};
  contents.scans[{0, 0}] = {{7., 7.}};  // of no loop
  data.contents = &contents;
  const Prepared prepared = test::Prepare(data);
  Markup page;
  AddLoops(data, prepared, &page);
  AddScans(data, prepared, &page);
  const std::string& html = page.str();
  // The second loop: two metres off where the map has its node.
  EXPECT_THAT(html, HasSubstr("data-id=\"0:0:0:3\" "
                              "data-pose=\"3.000:2.000:0.0000\" data-t=\"3\" "
                              "data-loop=\"3 2 0\" data-map=\"3 0 0\""));
  EXPECT_THAT(html, HasSubstr("{\"0:3\":[123,-50,200,0]}"));
  EXPECT_THAT(html, Not(HasSubstr("700")));
}

TEST(SectionLoopsTest, LoopsOfWhatIsNotThereAreLeftOut) {
  ReportData data = test::ExampleData(false);
  data.runs[0].graph.constraints[0].node_id = {3, 3};
  Prepared prepared = test::Prepare(data);
  prepared.evidence[0][0].node_id = {3, 3};
  Markup page;
  AddLoops(data, prepared, &page);
  EXPECT_EQ(test::Count(page.str(), "class=\"loop "), 2u);
}

TEST(SectionLoopsTest, OneRunHasNothingToCompare) {
  Markup page;
  AddComparison(test::ExampleData(false), &page);
  EXPECT_TRUE(page.empty());
}

TEST(SectionLoopsTest, WhatBecameOfTheLoops) {
  Markup page;
  AddComparison(test::ExampleData(true), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<h2 id=\"comparison\">"));
  EXPECT_THAT(html, HasSubstr("2 of 3 (66.7 %)"));
  EXPECT_THAT(html, HasSubstr("2 within 5 cm"));
  // Verdicts of the records.
  EXPECT_THAT(html, HasSubstr("accepted: confirmed by subset"));
  EXPECT_THAT(html, HasSubstr("rejected: low temporal score"));
  EXPECT_THAT(html, HasSubstr("not searched: budget"));
  // The third stored loop has no record in the run.
  EXPECT_THAT(html, HasSubstr("not a candidate there"));
  EXPECT_THAT(html, HasSubstr("accepted by both"));
  EXPECT_THAT(html, HasSubstr("accepted by ours only"));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
