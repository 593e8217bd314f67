// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_line.h"

#include <string>

#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

TEST(CarmenLineTest, FieldLayouts) {
  CarmenLine line;
  const auto kind = [&line](const std::string& text) {
    ParseCarmenLine(text, &line);
    return line.kind;
  };
  const std::string scan = "FLASER 2 1.5 2.5 ";
  // Stamp, host, logger's stamp; without the last; without host.
  for (const char* tail :
       {"0.3 0 0 0.1 0 0 7.5 host 1.0", "0.3 0 0 0.1 0 0 7.5 host",
        "0.3 0 0 0.1 0 0 7.5", "0.3 0 0 0.1 0 0 7.5 192 1.0"}) {
    ASSERT_EQ(kind(scan + tail), CarmenKind::kFrontLaser) << tail;
    EXPECT_EQ(line.time, 7500000000);
    EXPECT_EQ(line.laser_pose.x, 0.3);
    EXPECT_EQ(line.robot_pose.x, 0.1);
  }
  for (const char* tail : {"0.1 0 0 7.5 host 1.0", "0.1 0 0 7.5"}) {
    ASSERT_EQ(kind(scan + tail), CarmenKind::kFrontLaser) << tail;
    EXPECT_EQ(line.time, 7500000000);
    EXPECT_EQ(line.robot_pose.x, 0.1);
  }
  for (const char* tail :
       {"0.1 0 3 0.5 0.1 0 7.5 host 1.0", "0.1 0 3 0.5 0.1 0 7.5",
        "0.1 0 3 7.5 host 1.0", "0.1 0 3 7.5"}) {
    ASSERT_EQ(kind(std::string("ODOM ") + tail), CarmenKind::kOdometry) << tail;
    EXPECT_EQ(line.time, 7500000000) << tail;
  }
  const std::string raw = "RAWLASER1 0 -1.57 3.14 0.01 80 0.01 0 2 1 2 ";
  for (const char* tail :
       {"0 7.5 host 1", "2 10 20 7.5 host 1", "7.5 host 1"}) {
    ASSERT_EQ(kind(raw + tail), CarmenKind::kRawLaser) << tail;
    EXPECT_EQ(line.time, 7500000000) << tail;
  }
  EXPECT_EQ(kind("# FLASER"), CarmenKind::kIgnored);
  EXPECT_EQ(kind(""), CarmenKind::kIgnored);
  EXPECT_EQ(kind("TRUEPOS 1 2 3"), CarmenKind::kIgnored);
  EXPECT_EQ(kind("RLASER 1 1"), CarmenKind::kRearLaser);
}

TEST(CarmenLineTest, MalformedLines) {
  CarmenLine line;
  for (const char* text :
       {"FLASER", "FLASER x 1 2", "FLASER -1 0 0 0 0 0 0 1 h 1",
        "FLASER 0 0 0 0 0 0 0 1 h 1", "FLASER 99999 1 2 0 0 0 0 0 0 1 h 1",
        "FLASER 18446744073709551617 1 2 0 0 0 0 0 0 1 h 1",
        "FLASER 2 1 2 nan 0 0 0 0 0 1 h 1", "FLASER 2 1 2 0 0 0 0 0 0 -1 h 1",
        "FLASER 2 1 2 0 0 1e30 0 0 0 1 h 1", "FLASER 2 1 x 0 0 0 0 0 0 1 h 1",
        "FLASER 3 1 2 0 0 0 0 0 0 h", "ODOM 1 2", "ODOM 0 0 inf 0 0 0 1 h 1",
        "ODOM 0 0 0 0 0 0 h 1", "ROBOTLASER1 0 0 0 0",
        "ROBOTLASER1 0 -1 2 9 20 0 0 5 1 2 3 4 5 0 0 0 0 0 0 0 0 0 0 0 0 1 h",
        "RAWLASER1 0 -1 2 0 20 0 0 2 1 2 99999 1 h 1"}) {
    ParseCarmenLine(text, &line);
    EXPECT_EQ(line.kind, CarmenKind::kMalformed) << text;
    EXPECT_STRNE(line.error, "") << text;
  }
}

TEST(CarmenLineTest, BeamAngles) {
  const auto expect = [](int n, double first_degrees, double step_degrees) {
    double angle_min, angle_increment;
    FrontLaserAngles(n, &angle_min, &angle_increment);
    EXPECT_NEAR(RadToDeg(angle_min), first_degrees, 1e-9) << n;
    EXPECT_NEAR(RadToDeg(angle_increment), step_degrees, 1e-9) << n;
  };
  expect(180, -90., 1.);
  expect(181, -90., 1.);
  expect(360, -90., 0.5);
  expect(361, -90., 0.5);
  expect(401, -50., 0.25);
  expect(1, -90., 180.);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
