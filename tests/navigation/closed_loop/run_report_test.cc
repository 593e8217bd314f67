// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/run_report.h"

#include <cstdio>
#include <string>

#include "gtest/gtest.h"
#include "tests/navigation/closed_loop/small_run.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(RunReportTest, JsonHasTheKeysOfTheContract) {
  const auto json = ToJson(SmallRun());
  EXPECT_EQ(json["goals"], 2);
  EXPECT_EQ(json["reached"], 1);
  EXPECT_EQ(json["collisions"]["static"], 0);
  EXPECT_EQ(json["collisions"]["moving"], 0);
  EXPECT_NEAR(json["path_ratio"], 1.1, 1e-12);
  EXPECT_NEAR(json["localization"]["median"], 0.02, 1e-12);
  EXPECT_NEAR(json["localization"]["max"], 0.03, 1e-12);
  EXPECT_EQ(json["localization"]["jumps"], 0);
  EXPECT_NEAR(json["control_cycle_milliseconds"]["p50"], 51., 1.);
  EXPECT_NEAR(json["control_cycle_milliseconds"]["p99"], 100., 1.);
  EXPECT_NEAR(json["cpu_share"]["total"], 0.05, 1e-12);
  EXPECT_EQ(json["each_goal"][1]["reason"], "why </script>");
  ShadowLocalization shadow;
  shadow.errors = SmallRun().localization;
  shadow.cpu_seconds = 2.;
  EXPECT_NEAR(ToJson(shadow, 20.)["cpu_share"], 0.1, 1e-12);
}

TEST(RunReportTest, TextNamesTheGoalThatWasMissed) {
  const std::string text = ToText(SmallRun());
  EXPECT_NE(text.find("1 of 2 reached"), std::string::npos);
  EXPECT_NE(text.find("goal 2 not reached: why"), std::string::npos);
}

TEST(RunReportTest, WritesAPicture) {
  const std::string filename = testing::TempDir() + "/run_report_test.png";
  ASSERT_TRUE(WriteRunPicture(SmallRun(), "a drive", filename).ok());
  EXPECT_EQ(Read(filename).substr(1, 3), "PNG");
  std::remove(filename.c_str());
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
