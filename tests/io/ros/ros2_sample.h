// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A short recording with all that a ROS recording can have.
#ifndef TESTS_IO_ROS_ROS2_SAMPLE_H_
#define TESTS_IO_ROS_ROS2_SAMPLE_H_

#include <string>
#include <vector>

#include "cartographer_ext/io/ros/rosbag2_writer.h"
#include "cartographer_ext/io/sensor_source.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace test {

inline io::LaserScan SampleScan(const io::TimeNs time, const int num_beams) {
  io::LaserScan scan;
  scan.time = time;
  scan.time_increment = 1. / 131072.;  // exact as a float
  scan.angle_min = -1.5;
  scan.angle_increment = 3. / num_beams;
  scan.range_min = 0.1;
  scan.range_max = 30.;
  scan.laser_pose = Pose2(0.25, -0.1, 0.5);
  for (int i = 0; i < num_beams; ++i) scan.ranges.push_back(1.f + 0.25f * i);
  return scan;
}

// Steps of 0.1 s from 1000.1 s on: odometry, IMU and scan with equal stamps.
inline void WriteRos2Sample(const std::string& filename,
                            const io::Rosbag2Storage storage,
                            const std::string& compression,
                            const int num_steps = 10, const int num_beams = 8) {
  io::RosbagWriterOptions options;
  options.compression = compression;
  auto writer = io::OpenRosbag2Writer(filename, storage, options);
  ASSERT_TRUE(writer.ok()) << writer.status();
  for (int i = 1; i <= num_steps; ++i) {
    const io::TimeNs time = 1000000000000 + i * io::TimeNs{100000000};
    io::OdometryReading odometry;
    odometry.time = time;
    odometry.pose = Pose2(0.1 * i, -0.1 * i, 0.01 * i);
    ASSERT_TRUE((*writer)->AddOdometry(odometry, 1., 0.1).ok());
    io::ImuReading imu;
    imu.time = time;
    imu.linear_acceleration = Eigen::Vector3d(0.1, -0.2, 9.8);
    imu.angular_velocity = Eigen::Vector3d(0.01, 0.02, -0.3);
    ASSERT_TRUE((*writer)->AddImu(imu).ok());
    ASSERT_TRUE((*writer)->AddScan(SampleScan(time, num_beams)).ok());
  }
  const absl::Status status = (*writer)->Finish();
  ASSERT_TRUE(status.ok()) << status;
}

// What WriteRos2Sample wrote.
inline void ExpectRos2Sample(io::SensorSource* const source,
                             const int num_steps = 10,
                             const int num_beams = 8) {
  EXPECT_EQ(source->info().num_scans, num_steps);
  EXPECT_EQ(source->info().num_odometry, num_steps);
  EXPECT_EQ(source->info().num_imu, num_steps);
  io::SensorEvent event;
  for (int i = 1; i <= num_steps; ++i) {
    const io::TimeNs time = 1000000000000 + i * io::TimeNs{100000000};
    ASSERT_TRUE(source->Next(&event).value());
    ASSERT_TRUE(absl::holds_alternative<io::OdometryReading>(event));
    const io::OdometryReading odometry = absl::get<io::OdometryReading>(event);
    EXPECT_EQ(odometry.time, time);
    EXPECT_DOUBLE_EQ(odometry.pose.x, 0.1 * i);
    EXPECT_DOUBLE_EQ(odometry.pose.y, -0.1 * i);
    EXPECT_NEAR(odometry.pose.theta, 0.01 * i, 1e-12);
    ASSERT_TRUE(source->Next(&event).value());
    ASSERT_TRUE(absl::holds_alternative<io::ImuReading>(event));
    const io::ImuReading imu = absl::get<io::ImuReading>(event);
    EXPECT_EQ(imu.time, time);
    EXPECT_EQ(imu.linear_acceleration, Eigen::Vector3d(0.1, -0.2, 9.8));
    EXPECT_EQ(imu.angular_velocity, Eigen::Vector3d(0.01, 0.02, -0.3));
    ASSERT_TRUE(source->Next(&event).value());
    ASSERT_TRUE(absl::holds_alternative<io::LaserScan>(event));
    const io::LaserScan scan = absl::get<io::LaserScan>(event);
    const io::LaserScan expected = SampleScan(time, num_beams);
    EXPECT_EQ(scan.time, time);
    EXPECT_EQ(scan.ranges, expected.ranges);
    EXPECT_NEAR(scan.laser_pose.x, 0.25, 1e-12);
    EXPECT_NEAR(scan.laser_pose.theta, 0.5, 1e-12);
    EXPECT_FLOAT_EQ(scan.angle_increment, expected.angle_increment);
  }
  EXPECT_FALSE(source->Next(&event).value());
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_IO_ROS_ROS2_SAMPLE_H_
