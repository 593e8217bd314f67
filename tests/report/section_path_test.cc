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

TEST(SectionPathTest, WithoutSelfConsistencyThereIsNothing) {
  const ReportData data = test::ExampleData(false);
  Markup page;
  AddPath(data, test::Prepare(data), &page);
  EXPECT_TRUE(page.empty());
}

TEST(SectionPathTest, ContradictionAndOdometry) {
  ReportData data = test::ExampleData(true);
  data.runs[0].evaluation.consistency = test::ExampleConsistency();
  Markup page;
  AddPath(data, test::Prepare(data), &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<h2 id=\"path\">"));
  EXPECT_THAT(html, HasSubstr("Contradiction along the path"));
  EXPECT_THAT(html, HasSubstr("nodes (0, 1) to (0, 2)"));
  EXPECT_THAT(html, HasSubstr("severe"));
  EXPECT_THAT(html, HasSubstr("Local SLAM against odometry"));
  EXPECT_THAT(html, HasSubstr("wrong turn"));
  EXPECT_THAT(html, Not(HasSubstr("Degeneracy")));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  EXPECT_EQ(test::Count(html, "<figure"), 2u);
}

TEST(SectionPathTest, NoOdometryNoChartOfIt) {
  ReportData data = test::ExampleData(false);
  data.runs[0].evaluation.consistency = test::ExampleConsistency();
  data.runs[0].evaluation.consistency->motion = {};
  Markup page;
  AddPath(data, test::Prepare(data), &page);
  EXPECT_EQ(test::Count(page.str(), "<figure"), 1u);
}

TEST(SectionPathTest, DegeneratePiecesAreShaded) {
  ReportData data = test::ExampleData(false);
  data.runs[0].evaluation.consistency = test::ExampleConsistency();
  data.runs[0].evaluation.consistency->motion = {};
  for (int i = 0; i < 5; ++i) {
    DegeneracySample sample;
    sample.time = (100 + i) * test::kSecond;
    sample.ratio = 0.1 * i;
    // One in the middle, and one that goes on to the end.
    sample.degenerate = i == 1 || i == 4;
    data.degeneracy.push_back(sample);
  }
  Markup with;
  AddPath(data, test::Prepare(data), &with);
  EXPECT_THAT(with.str(), HasSubstr("Degeneracy along the path"));
  for (DegeneracySample& sample : data.degeneracy) sample.degenerate = false;
  Markup without;
  AddPath(data, test::Prepare(data), &without);
  EXPECT_EQ(test::Count(with.str(), "s6"),
            test::Count(without.str(), "s6") + 2);
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
