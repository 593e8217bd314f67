// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/run_summary.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(RunSummaryTest, TellsTheDriftThatWasLearnt) {
  SlamRun run;
  EXPECT_EQ(ToJson(run).at("drift").at("cycles"), 0);
  EXPECT_THAT(ToText(run), Not(HasSubstr("Drift")));  // nothing but the prior
  run.drift.num_cycles = 7;
  run.drift.mean.translation_per_metre = 0.1;
  run.drift.common.mean = Eigen::Vector3d(DegToRad(0.5), 0.01, -0.03);
  run.drift.common.covariance =
      Eigen::Vector3d(DegToRad(0.1) * DegToRad(0.1), 1e-4, 4e-6).asDiagonal();
  const auto drift = ToJson(run).at("drift");
  EXPECT_EQ(drift.at("translation_per_metre"), 0.1);
  EXPECT_EQ(drift.at("scale"), -0.03);
  EXPECT_NEAR(drift.at("scale_sigma"), 0.002, 1e-12);
  EXPECT_EQ(drift.at("cycles"), 7);
  EXPECT_THAT(
      ToText(run),
      HasSubstr("estimated from 7 cycles of loops: heading 0.50 +- 0.10 "
                "deg/m, rotation 1.0 +- 1.0 %, scale -3.0 +- 0.2 %"));
}

TEST(RunSummaryTest, TellsWhenAndWhereItWasLocalized) {
  SlamRun run;
  EXPECT_FALSE(ToJson(run).contains("localized"));
  EXPECT_THAT(ToText(run), testing::Not(testing::HasSubstr("Localised")));
  EXPECT_THAT(ToText(run), testing::HasSubstr("0 loops from 0 searches"));
  run.loaded_nodes = 5;
  run.loop_searches = 3222;
  run.loops_found = 812;
  EXPECT_THAT(ToText(run),
              testing::HasSubstr("loops found by 812 of 3222 searches"));
  EXPECT_TRUE(ToJson(run)["localized"].is_null());
  EXPECT_THAT(ToText(run), testing::HasSubstr("Localised  never"));
  run.local_scan_poses.push_back(io::MakeStampedPose(1000000000, Pose2()));
  run.localized_at =
      io::MakeStampedPose(14400000000, Pose2(3., -2., 0.5 * kPi));
  EXPECT_NEAR(ToJson(run)["localized"]["seconds"].get<double>(), 13.4, 1e-9);
  EXPECT_NEAR(ToJson(run)["localized"]["y"].get<double>(), -2., 1e-9);
  EXPECT_THAT(ToText(run),
              testing::HasSubstr("Localised  after 13.4 s, at x = 3.0 m, y = "
                                 "-2.0 m, 90 degrees in the map frame"));
}

TEST(RunSummaryTest, HasTheWarningsOfAll) {
  SlamRun run;
  EXPECT_TRUE(ToJson(run)["warnings"].empty());
  run.input_warnings = {"two lasers; taking /scan"};
  run.warnings = {"no odometry"};
  EXPECT_EQ(ToJson(run)["warnings"].size(), 2u);
  EXPECT_EQ(ToJson(run)["warnings"][0], "two lasers; taking /scan");
  EXPECT_EQ(ToJson(run)["warnings"][1], "no odometry");
}

TEST(RunSummaryTest, TellsTheLatency) {
  SlamRun run;
  EXPECT_THAT(ToText(run), Not(HasSubstr("Latency")));
  run.latency.scans = 3;
  run.latency.local_slam_p50 = 1.;
  run.latency.local_slam_p99 = 2.5;
  run.latency.local_slam_max = 4.;
  run.latency.max_backlog = 0.3;
  const auto latency = ToJson(run).at("latency");
  EXPECT_EQ(latency.at("local_slam_milliseconds").at("p50"), 1.);
  EXPECT_EQ(latency.at("local_slam_milliseconds").at("p99"), 2.5);
  EXPECT_EQ(latency.at("local_slam_milliseconds").at("max"), 4.);
  EXPECT_EQ(latency.at("backlog_seconds").at("max"), 0.3);
  EXPECT_THAT(ToText(run),
              HasSubstr("1.0 ms per scan (99 % within 2.5, at most "
                        "4.0); back end at most 0.3 s"));
}

TEST(RunSummaryTest, TellsWhichLoopsAreInForce) {
  SlamRun run;
  EXPECT_FALSE(ToJson(run).at("optimizations").contains("loops_off_map"));
  run.switched_loops.in_force.before = {40, 1};
  run.switched_loops.in_force.after = {40, 1};
  EXPECT_EQ(ToJson(run).at("optimizations").at("loops_off_map").at("before"),
            1);
  EXPECT_THAT(ToText(run), Not(HasSubstr("In force")));  // as usual
  run.switched_loops.in_force.tried = true;
  run.switched_loops.in_force.before.off = 9;
  run.switched_loops.in_force.after.off = 9;
  EXPECT_THAT(ToText(run), HasSubstr("all but 9 of 40 loops, which no single"));
  run.switched_loops.in_force.relaxed = true;
  run.switched_loops.in_force.after.off = 2;
  EXPECT_THAT(ToText(run),
              HasSubstr("all but 2 of 40 loops, all but 9 before"));
  EXPECT_EQ(
      ToJson(run).at("optimizations").at("loops_off_map").at("steps_gave_way"),
      true);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
