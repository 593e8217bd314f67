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

TEST(SectionOriginTest, TimesOnlyOfRunsAndOnlyWhenWanted) {
  Markup stored_only;
  AddTiming(test::ExampleData(false), &stored_only);
  EXPECT_TRUE(stored_only.empty());
  ReportData data = test::ExampleData(true);
  data.with_times = false;
  Markup without;
  AddTiming(data, &without);
  EXPECT_TRUE(without.empty());
}

TEST(SectionOriginTest, TimesInOneTable) {
  ReportData data = test::ExampleData(true);
  Markup page;
  AddTiming(data, &page);
  const std::string& html = page.str();
  EXPECT_THAT(html, HasSubstr("<h2 id=\"timing\">"));
  EXPECT_THAT(html, HasSubstr("3.25 s"));
  // As a whole, and as what is left: no search was measured.
  EXPECT_EQ(test::Count(html, "2.50 s"), 2u);
  EXPECT_THAT(html, HasSubstr("5 MiB"));
  EXPECT_THAT(html, Not(HasSubstr("as stored")));
  data.runs[1].rerun->searches = 0;
  Markup without_searches;
  AddTiming(data, &without_searches);
  EXPECT_THAT(without_searches.str(), Not(HasSubstr("nan")));
}

TEST(SectionOriginTest, CommandLineAndVersions) {
  ReportData data = test::ExampleData(false);
  Markup plain;
  AddOrigin(data, &plain);
  EXPECT_THAT(plain.str(), HasSubstr("<pre>evaluate &lt;map&gt;</pre>"));
  EXPECT_THAT(plain.str(), Not(HasSubstr("Assumed")));
  EXPECT_THAT(plain.str(), Not(HasSubstr("Versions")));
  EXPECT_THAT(plain.str(), Not(HasSubstr("Options")));
  data = test::ExampleData(true);
  data.assumptions = {"scans are right"};
  data.option_differences = {"a = 1", "b = 2"};
  data.stock_name = "stock.lua";
  data.ours_name = "default.lua";
  data.versions = {{"Eigen", "3.4.0"}};
  Markup full;
  AddOrigin(data, &full);
  const std::string& html = full.str();
  EXPECT_THAT(html, HasSubstr("<li>scans are right</li>"));
  EXPECT_THAT(html, HasSubstr("from stock (stock.lua) to ours (default.lua)"));
  EXPECT_THAT(html, HasSubstr("<pre>a = 1\nb = 2</pre>"));
  EXPECT_THAT(html, HasSubstr("3.4.0"));
  EXPECT_THAT(html, HasSubstr("Local SLAM is not repeated"));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
