// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/damage_report.h"

#include "cartographer_ext/io/ros/ros_container.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

TEST(DamageReportTest, SaysWhereAndHowMuch) {
  DamageReport report;
  EXPECT_TRUE(report.empty());
  EXPECT_TRUE(report.first_problem().ok());
  report.AddMessage(FromSeconds(10.));
  report.AddDamage(3, 800000, absl::DataLossError("first"));
  // The same chunk.
  report.AddDamage(3, 700000, absl::DataLossError("second"));
  report.AddMessage(FromSeconds(12.1));
  report.AddMessage(FromSeconds(12.2));
  EXPECT_FALSE(report.empty());
  EXPECT_EQ(report.first_problem().message(), "first");
  EXPECT_EQ(report.Text(24100000),
            "left out 1 damaged part (in chunk 3), 0.8 of 24.1 MB and 2.1 s of "
            "messages; what is whole around it is read");
}

TEST(DamageReportTest, CountsParts) {
  DamageReport report;
  report.AddDamage(0, 1000, absl::DataLossError("first"));
  EXPECT_FALSE(report.any_message());
  report.AddDamage(0, 1000, absl::DataLossError("second"));
  report.AddMessage(FromSeconds(5.));
  EXPECT_TRUE(report.any_message());
  // Nothing is known of the time before the first message.
  EXPECT_EQ(report.Text(10000),
            "left out 2 damaged parts, 0.002 of 0.01 MB; what is whole around "
            "them is read");
}

TEST(DamageReportTest, AnyTimesAddUp) {
  DamageReport report;
  report.AddMessage(-kMaxRecorded);
  for (int i = 0; i != 3; ++i) {
    report.AddDamage(0, 1000, absl::DataLossError("gap"));
    report.AddMessage(kMaxRecorded);
    report.AddMessage(-kMaxRecorded);
  }
  EXPECT_EQ(report.Text(10000),
            "left out 3 damaged parts, 0.003 of 0.01 MB and 24000000000.0 s of "
            "messages; what is whole around them is read");
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
