// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_survey.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

class CarmenSurveyTest : public testing::Test {
 protected:
  ~CarmenSurveyTest() override { std::remove(filename_.c_str()); }

  absl::StatusOr<CarmenPlan> Survey(const std::string& text,
                                    const std::string& odometry = "auto") {
    std::ofstream(filename_) << text;
    return SurveyCarmenLog(filename_, odometry);
  }

  // Two poses a scan: the laser is 0.3 m ahead of the robot.
  static std::string Scans(const int begin, const int end) {
    std::string text;
    for (int i = begin; i < end; ++i) {
      absl::StrAppend(&text, "FLASER 3 1.0 2.0 3.0 ", i, ".3 0 0 ", i, " 0 0 ",
                      100 + i, " robot ", i, "\n");
    }
    return text;
  }

  const std::string filename_ =
      absl::StrCat(testing::TempDir(), "carmen_survey_test_", getpid(), ".clf");
};

TEST_F(CarmenSurveyTest, LaserPoseAndTimesComeFromTheScans) {
  const auto plan = Survey(Scans(0, 20));
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->scan_kind, CarmenKind::kFrontLaser);
  EXPECT_TRUE(plan->use_scan_poses);
  EXPECT_FALSE(plan->use_odometry_lines);
  EXPECT_NEAR(plan->laser_pose.x, 0.3, 1e-9);
  EXPECT_EQ(plan->info.num_scans, 20);
  EXPECT_EQ(plan->info.num_odometry, 20);
  EXPECT_EQ(plan->info.begin, TimeNs{100} * 1000000000);
  EXPECT_EQ(plan->info.end, TimeNs{119} * 1000000000);
  EXPECT_EQ(plan->line_spacing, 0);
}

TEST_F(CarmenSurveyTest, TheSourceOfTheOdometryCanBeChosen) {
  std::string text = Scans(0, 20);
  for (int i = 0; i < 40; ++i) {
    absl::StrAppend(&text, "ODOM ", 0.5 * i, " 0 0 0 0 0 ", 100 + 0.5 * i,
                    " robot ", 0.5 * i, "\n");
  }
  const auto lines = Survey(text, "odom");
  ASSERT_TRUE(lines.ok()) << lines.status();
  EXPECT_TRUE(lines->use_odometry_lines);
  EXPECT_FALSE(lines->use_scan_poses);
  const auto both = Survey(text, "both");
  ASSERT_TRUE(both.ok()) << both.status();
  EXPECT_TRUE(both->use_odometry_lines);
  EXPECT_TRUE(both->use_scan_poses);
  EXPECT_EQ(both->info.num_odometry, lines->info.num_odometry + 20);
}

TEST_F(CarmenSurveyTest, NoScansAndNoFileAreErrors) {
  const auto text = Survey("PARAM robot_frontlaser_offset 0.3\nhello\n");
  EXPECT_EQ(text.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(text.status().message()),
              testing::HasSubstr("no laser scan"));
  EXPECT_FALSE(SurveyCarmenLog("/nonexistent.clf", "auto").ok());
}

TEST(CarmenEventsOfLineTest, OdometryComesBeforeTheScanItWasTakenFrom) {
  CarmenPlan plan;
  plan.use_scan_poses = true;
  int64_t ordinal = 7;
  CarmenEvent events[2];
  ASSERT_EQ(
      CarmenEventsOfLine(plan, CarmenKind::kFrontLaser, 5, &ordinal, events),
      2);
  EXPECT_TRUE(events[0].inside_scan);
  EXPECT_FALSE(events[0].is_scan);
  EXPECT_TRUE(events[1].is_scan);
  EXPECT_TRUE(events[0].key < events[1].key);
  EXPECT_EQ(events[0].key.ordinal, 7);
  EXPECT_EQ(events[1].key.ordinal, 8);
  EXPECT_EQ(ordinal, 9);
  // Neither lines of odometry that are not used nor scans of another laser.
  EXPECT_EQ(
      CarmenEventsOfLine(plan, CarmenKind::kOdometry, 5, &ordinal, events), 0);
  EXPECT_EQ(
      CarmenEventsOfLine(plan, CarmenKind::kRawLaser, 5, &ordinal, events), 0);
  EXPECT_EQ(ordinal, 9);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
