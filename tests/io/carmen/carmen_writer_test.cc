// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_writer.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/carmen/carmen_line.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

LaserScan MakeScan(TimeNs time, int num_beams, bool front, Random* random) {
  LaserScan scan;
  scan.time = time;
  if (front) {
    FrontLaserAngles(num_beams, &scan.angle_min, &scan.angle_increment);
  } else {
    scan.angle_min = -kPi;
    scan.angle_increment = 2. * kPi / num_beams;
  }
  scan.range_max = 25.;
  scan.laser_pose = Pose2(0.2, -0.05, 0.01);
  for (int i = 0; i < num_beams; ++i) {
    scan.ranges.push_back(static_cast<float>(random->Uniform(0.1, 25.)));
  }
  scan.ranges[0] = std::numeric_limits<float>::quiet_NaN();
  scan.ranges[1] = std::numeric_limits<float>::infinity();
  scan.ranges[2] = 26.f;
  return scan;
}

class RoundTripTest : public ::testing::TestWithParam<bool> {};

TEST_P(RoundTripTest, ReadsBackWhatWasWritten) {
  const bool front = GetParam();
  Random random(5);
  test::TemporaryFile file(".clf");
  std::vector<LaserScan> scans;
  std::vector<OdometryReading> odometry;
  auto writer = CarmenWriter::Open(file.path(), "a comment\nof two lines");
  ASSERT_TRUE(writer.ok()) << writer.status();
  for (int i = 0; i < 50; ++i) {
    OdometryReading reading;
    reading.time = 1134864629895182123 + 100000001LL * i;
    reading.pose = Pose2(random.Uniform(-100., 100.),
                         random.Uniform(-100., 100.), random.Uniform(-3., 3.));
    odometry.push_back(reading);
    ASSERT_TRUE((*writer)->AddOdometry(reading, 0.5, -0.1).ok());
    scans.push_back(MakeScan(reading.time + 10000007, 360, front, &random));
    ASSERT_TRUE((*writer)->AddScan(scans.back(), reading.pose).ok());
  }
  EXPECT_FALSE(test::Exists(file.path()));  // Not before Finish.
  ASSERT_TRUE((*writer)->Finish().ok());

  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_TRUE((*source)->info().warnings.empty());
  EXPECT_EQ((*source)->info().num_scans, 50);
  EXPECT_EQ((*source)->info().num_odometry, 50);
  SensorEvent event;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(*(*source)->Next(&event));
    const auto& reading = absl::get<OdometryReading>(event);
    EXPECT_EQ(reading.time, odometry[i].time);
    EXPECT_NEAR(reading.pose.x, odometry[i].pose.x, 6e-7);
    EXPECT_NEAR(reading.pose.y, odometry[i].pose.y, 6e-7);
    EXPECT_NEAR(reading.pose.theta, odometry[i].pose.theta, 6e-7);
    ASSERT_TRUE(*(*source)->Next(&event));
    const auto& scan = absl::get<LaserScan>(event);
    EXPECT_EQ(scan.time, scans[i].time);
    EXPECT_NEAR(scan.angle_min, scans[i].angle_min, 1e-9);
    EXPECT_NEAR(scan.angle_increment, scans[i].angle_increment, 1e-9);
    EXPECT_NEAR(scan.laser_pose.x, 0.2, 1e-5);
    EXPECT_NEAR(scan.laser_pose.y, -0.05, 1e-5);
    EXPECT_NEAR(scan.laser_pose.theta, 0.01, 1e-5);
    ASSERT_EQ(scan.ranges.size(), 360u);
    for (int k = 0; k < 360; ++k) {
      if (k < 3) {
        EXPECT_GT(scan.ranges[k], scan.range_max);
      } else {
        EXPECT_NEAR(scan.ranges[k], scans[i].ranges[k], 5.1e-4);
        EXPECT_LE(scan.ranges[k], scan.range_max);
      }
    }
  }
  EXPECT_FALSE(*(*source)->Next(&event));
  const std::string text = test::ReadBytes(file.path());
  EXPECT_THAT(text, HasSubstr(front ? "\nFLASER 360 " : "\nROBOTLASER1 "));
  EXPECT_THAT(text, HasSubstr("# a comment\n# of two lines\nODOM "));
}

INSTANTIATE_TEST_SUITE_P(All, RoundTripTest, ::testing::Bool());

TEST(CarmenWriterTest, Errors) {
  EXPECT_FALSE(CarmenWriter::Open("/nonexistent/a.clf", "").ok());
  test::TemporaryFile file(".clf");
  {
    auto writer = CarmenWriter::Open(file.path(), "");
    ASSERT_TRUE(writer.ok());
    EXPECT_FALSE((*writer)->AddScan(LaserScan(), Pose2()).ok());
    OdometryReading reading;
    reading.pose.x = std::nan("");
    EXPECT_FALSE((*writer)->AddOdometry(reading).ok());
    reading = OdometryReading();
    reading.time = -1;
    EXPECT_FALSE((*writer)->AddOdometry(reading).ok());
  }
  EXPECT_FALSE(test::Exists(file.path()));
  if (!test::Exists("/dev/full")) return;
  auto writer = CarmenWriter::Open("/dev/full", "");
  ASSERT_TRUE(writer.ok());
  Random random(1);
  ASSERT_TRUE(
      (*writer)->AddScan(MakeScan(1, 360, true, &random), Pose2()).ok());
  EXPECT_EQ((*writer)->Finish().code(), absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
