// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/robustness_report.h"

#include <algorithm>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using testing::HasSubstr;
using testing::Not;

SweepRun MakeRun(const std::string& kernel, const double cpu_seconds,
                 const double ate) {
  SweepRun run;
  run.dataset = "intel";
  run.kernel = kernel;
  run.type = "R";
  run.count = 1000;
  run.cpu_seconds = cpu_seconds;
  run.ate = ate;
  run.recall = 1.;
  run.precision = 1.;
  run.converged = true;
  run.success = ate < 0.01;
  run.success_by_ate = run.success;
  return run;
}

TEST(RobustnessReportTest, CellsAreMediansOverSeeds) {
  const auto cells =
      Summarize({MakeRun("acs", 1., 0.002), MakeRun("sc", 9., 0.5),
                 MakeRun("acs", 3., 0.03), MakeRun("acs", 2., 0.001)});
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].kernel, "acs");
  EXPECT_EQ(cells[0].runs, 3);
  EXPECT_EQ(cells[0].cpu_seconds, 2.);
  EXPECT_EQ(cells[0].ate, 0.002);
  EXPECT_EQ(cells[0].ate_largest, 0.03);
  EXPECT_NEAR(cells[0].success_rate, 2. / 3., 1e-12);
  EXPECT_EQ(cells[1].kernel, "sc");
  EXPECT_EQ(cells[1].success_rate, 0.);
}

TEST(RobustnessReportTest, TableHasOneLinePerCell) {
  const std::string table = SweepTable(
      Summarize({MakeRun("acs", 1., 0.002), MakeRun("sc", 9., 0.5)}));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_THAT(table, HasSubstr("0.0020"));
  EXPECT_THAT(table, HasSubstr("100%"));
}

TEST(RobustnessReportTest, ComparesWithThePaper) {
  PrintedRow row;
  row.dataset = "intel";
  row.type = "R";
  row.count = 1000;
  row.baseline = 4.;
  row.method = 2.;
  PrintedRow other = row;
  other.type = "LG";
  std::vector<SweepRun> runs = {MakeRun("acs", 1., 0.), MakeRun("sc", 9., 0.)};
  std::string table = PrintedComparison(Summarize(runs), {row, other}, "acs");
  // Nothing was run for the other row.
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
  EXPECT_THAT(table, HasSubstr("9x"));
  EXPECT_THAT(table, HasSubstr("2x"));
  EXPECT_THAT(table, Not(HasSubstr(">")));
  // A run that was stopped gives a lower bound only.
  runs[1].converged = false;
  table = PrintedComparison(Summarize(runs), {row}, "acs");
  EXPECT_THAT(table, HasSubstr(">9"));
}

SweepRun MakeRunWithOutliers(const double share, const bool success,
                             const bool undecidable) {
  SweepRun run = MakeRun("auto", 1., success ? 0. : 1.);
  run.outlier_share = share;
  run.undecidable = undecidable;
  run.precision = success ? 1. : 0.5;
  return run;
}

// A failure where the data favour a wrong map is the limit, one below it is a
// miss.
TEST(RobustnessReportTest, CountsWhatIsWellBelowTheLimit) {
  const std::vector<SweepRun> runs = {MakeRunWithOutliers(0.1, true, false),
                                      MakeRunWithOutliers(0.5, false, false),
                                      // At 91 % of the limit.
                                      MakeRunWithOutliers(0.73, false, false),
                                      MakeRunWithOutliers(0.8, false, true),
                                      MakeRunWithOutliers(0.9, true, false)};
  const auto scores = ScoreByLimits(runs);
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_EQ(scores[0].runs, 5);
  EXPECT_EQ(scores[0].successes, 2);
  EXPECT_EQ(scores[0].undecidable, 1);
  EXPECT_EQ(scores[0].missed, 2);
  EXPECT_EQ(scores[0].below, 2);
  EXPECT_EQ(scores[0].below_successes, 1);
  EXPECT_EQ(scores[0].below_precision, 0.75);
  const std::string table = LimitTable(runs);
  EXPECT_THAT(table, HasSubstr("intel R undecidable from 80.0% outliers on"));
  EXPECT_THAT(table, HasSubstr("below 90% of the limit 1 of 2 (50.0%)"));
  EXPECT_EQ(SweepJson(runs)["by_limits"][0]["missed"], 2);
}

TEST(RobustnessReportTest, NamesSuccessesThatTheDataDoNotTell) {
  SweepRun run = MakeRun("auto", 1., 0.5);
  run.success = true;
  run.success_by_ate = false;
  EXPECT_THAT(SweepTable(Summarize({run})), HasSubstr("same by data 1"));
}

TEST(RobustnessReportTest, JsonHasRunsAndCells) {
  const auto json =
      SweepJson({MakeRun("acs", 1., 0.002), MakeRun("acs", 3., 0.004)});
  EXPECT_EQ(json["runs"].size(), 2u);
  EXPECT_EQ(json["cells"].size(), 1u);
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
