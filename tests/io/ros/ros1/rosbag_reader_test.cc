// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_ext/io/ros/ros1/rosbag_writer.h"
#include "cartographer_ext/io/sensor_source.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

#ifdef CARTOGRAPHER_EXT_HAS_ROSBAG
#include "rosbag/bag.h"
#include "sensor_msgs/Imu.h"
#include "sensor_msgs/LaserScan.h"
#include "tf2_msgs/TFMessage.h"
#endif

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

#ifdef CARTOGRAPHER_EXT_HAS_ROSBAG

LaserScan MakeScan(TimeNs time, int n) {
  LaserScan scan;
  scan.time = time;
  scan.angle_min = -1.5;
  scan.angle_increment = 3. / n;
  scan.range_min = 0.1;
  scan.range_max = 30.;
  scan.laser_pose = Pose2(0.25, -0.1, 0.5);
  for (int i = 0; i < n; ++i) scan.ranges.push_back(1.f + 0.25f * i);
  return scan;
}

ImuReading MakeImu(TimeNs time) {
  ImuReading reading;
  reading.time = time;
  reading.linear_acceleration = Eigen::Vector3d(0.1, -0.2, 9.8);
  reading.angular_velocity = Eigen::Vector3d(0.01, 0.02, -0.3);
  return reading;
}

OdometryReading MakeOdometry(TimeNs time, const Pose2& pose) {
  OdometryReading reading;
  reading.time = time;
  reading.pose = pose;
  return reading;
}

// Ten steps of 0.1 s: odometry, IMU and scan with equal stamps.
void WriteSample(const std::string& file, const std::string& compression,
                 int num_beams = 8) {
  RosbagWriterOptions options;
  options.compression = compression;
  auto writer = RosbagWriter::Open(file, options);
  ASSERT_TRUE(writer.ok()) << writer.status();
  for (int i = 1; i <= 10; ++i) {
    const TimeNs time = 100000000LL * i;
    // The scan first, so that the reader has to put it behind the others.
    ASSERT_TRUE((*writer)->AddScan(MakeScan(time, num_beams)).ok());
    ASSERT_TRUE(
        (*writer)->AddOdometry(MakeOdometry(time, Pose2(i, -i, 0.1 * i))).ok());
    ASSERT_TRUE((*writer)->AddImu(MakeImu(time)).ok());
  }
  ASSERT_TRUE((*writer)->Finish().ok());
  EXPECT_FALSE((*writer)->Finish().ok());
}

std::vector<SensorEvent> ReadAll(SensorSource* source) {
  std::vector<SensorEvent> events;
  SensorEvent event;
  while (true) {
    const auto more = source->Next(&event);
    EXPECT_TRUE(more.ok()) << more.status();
    if (!more.ok() || !*more) return events;
    events.push_back(event);
  }
}

class CompressionTest : public ::testing::TestWithParam<const char*> {};

TEST_P(CompressionTest, RoundTrip) {
  test::TemporaryFile file(".bag");
  WriteSample(file.path(), GetParam());
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  const SensorSourceInfo& info = (*source)->info();
  EXPECT_EQ(info.format, "rosbag");
  EXPECT_EQ(info.num_scans, 10);
  EXPECT_EQ(info.num_odometry, 10);
  EXPECT_EQ(info.num_imu, 10);
  EXPECT_EQ(info.begin, 100000000);
  EXPECT_EQ(info.end, 1000000000);
  EXPECT_TRUE(info.warnings.empty()) << info.warnings.front();
  const std::vector<SensorEvent> events = ReadAll(source->get());
  ASSERT_EQ(events.size(), 30u);
  for (int i = 1; i <= 10; ++i) {
    const auto* odometry =
        absl::get_if<OdometryReading>(&events[3 * (i - 1) + 0]);
    const auto* imu = absl::get_if<ImuReading>(&events[3 * (i - 1) + 1]);
    const auto* scan = absl::get_if<LaserScan>(&events[3 * (i - 1) + 2]);
    ASSERT_TRUE(odometry != nullptr && imu != nullptr && scan != nullptr);
    EXPECT_EQ(odometry->time, 100000000LL * i);
    EXPECT_NEAR(odometry->pose.x, i, 1e-12);
    EXPECT_NEAR(odometry->pose.y, -i, 1e-12);
    EXPECT_NEAR(odometry->pose.theta, 0.1 * i, 1e-12);
    EXPECT_FALSE(odometry->inside_scan);
    EXPECT_TRUE(imu->linear_acceleration.isApprox(
        Eigen::Vector3d(0.1, -0.2, 9.8), 1e-12));
    EXPECT_TRUE(imu->angular_velocity.isApprox(
        Eigen::Vector3d(0.01, 0.02, -0.3), 1e-12));
    EXPECT_EQ(scan->time, 100000000LL * i);
    EXPECT_EQ(scan->ranges, MakeScan(0, 8).ranges);
    EXPECT_NEAR(scan->angle_min, -1.5, 1e-6);
    EXPECT_NEAR(scan->angle_increment, 0.375, 1e-6);
    EXPECT_EQ(scan->range_max, std::nextafter(30.f, 0.f));
    EXPECT_NEAR(scan->laser_pose.x, 0.25, 1e-12);
    EXPECT_NEAR(scan->laser_pose.y, -0.1, 1e-12);
    EXPECT_NEAR(scan->laser_pose.theta, 0.5, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(All, CompressionTest,
                         ::testing::Values("none", "bz2", "lz4"));

TEST(RosbagReaderTest, SortsLateMessagesAndReadsEchoesAndSweeps) {
  test::TemporaryFile file(".bag");
  auto writer = RosbagWriter::Open(file.path(), {});
  ASSERT_TRUE(writer.ok()) << writer.status();
  LaserScan scan = MakeScan(2000000000, 3);
  scan.time_increment = 0.25;
  scan.echoes = {{1.f, 2.f}, {}, {4.f}};
  ASSERT_TRUE((*writer)->AddScan(scan).ok());
  scan.time = 1500000000;
  ASSERT_TRUE((*writer)->AddScan(scan).ok());
  ASSERT_TRUE((*writer)->Finish().ok());
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  const std::vector<SensorEvent> events = ReadAll(source->get());
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(EventTime(events[0]), 1500000000);
  EXPECT_EQ(EventTime(events[1]), 2000000000);
  const auto& read = absl::get<LaserScan>(events[1]);
  EXPECT_EQ(read.echoes, scan.echoes);
  EXPECT_EQ(read.ranges[0], 1.f);
  EXPECT_TRUE(std::isnan(read.ranges[1]));
  EXPECT_EQ(read.ranges[2], 4.f);
  EXPECT_NEAR(read.time_increment, 0.25, 1e-9);
}

TEST(RosbagReaderTest, TopicErrorsListTheTopics) {
  test::TemporaryFile file(".bag");
  WriteSample(file.path(), "bz2");
  SensorSourceOptions options;
  options.scan_topic = "/front";
  auto source = OpenSensorSource(file.path(), options);
  EXPECT_EQ(source.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(source.status().message()), HasSubstr(file.path()));
  EXPECT_THAT(std::string(source.status().message()),
              HasSubstr("/imu (sensor_msgs/Imu), /odom (nav_msgs/Odometry), "
                        "/scan (sensor_msgs/LaserScan)"));
  options.scan_topic = "/odom";
  source = OpenSensorSource(file.path(), options);
  EXPECT_EQ(source.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(source.status().message()),
              HasSubstr("/odom has type nav_msgs/Odometry"));
  options.scan_topic = "scan";  // The slash may be missing.
  options.tracking_frame = "laser";
  source = OpenSensorSource(file.path(), options);
  ASSERT_TRUE(source.ok()) << source.status();
  // Tracking the laser: its pose is the identity, odometry moves with it.
  const std::vector<SensorEvent> events = ReadAll(source->get());
  EXPECT_NEAR(absl::get<LaserScan>(events[2]).laser_pose.x, 0., 1e-12);
  const Pose2 expected = Pose2(1., -1., 0.1) * Pose2(0.25, -0.1, 0.5);
  const Pose2 pose = absl::get<OdometryReading>(events[0]).pose;
  EXPECT_NEAR(pose.x, expected.x, 1e-9);
  EXPECT_NEAR(pose.y, expected.y, 1e-9);
  EXPECT_NEAR(pose.theta, expected.theta, 1e-9);
}

TEST(RosbagReaderTest, UnknownTrackingFrameFallsBackToOdometry) {
  test::TemporaryFile file(".bag");
  WriteSample(file.path(), "none");
  SensorSourceOptions options;
  options.tracking_frame = "/nowhere";
  auto source = OpenSensorSource(file.path(), options);
  ASSERT_TRUE(source.ok()) << source.status();
  ASSERT_EQ((*source)->info().warnings.size(), 1u);
  EXPECT_THAT((*source)->info().warnings[0],
              HasSubstr("\"nowhere\" does not occur; taking \"base_link\""));
  EXPECT_NEAR(absl::get<LaserScan>(ReadAll(source->get())[2]).laser_pose.x,
              0.25, 1e-12);
}

TEST(RosbagReaderTest, UpsideDownLaserAndTurnedImuWithoutStamps) {
  test::TemporaryFile file(".bag");
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    tf2_msgs::TFMessage transforms;
    transforms.transforms.resize(2);
    transforms.transforms[0].header.frame_id = "/base_link";
    transforms.transforms[0].child_frame_id = "laser";
    transforms.transforms[0].transform.translation.x = 0.5;
    transforms.transforms[0].transform.rotation.x = 1.;  // half a turn of roll
    transforms.transforms[1].header.frame_id = "base_link";
    transforms.transforms[1].child_frame_id = "imu";
    transforms.transforms[1].transform.rotation.z = std::sqrt(0.5);
    transforms.transforms[1].transform.rotation.w = std::sqrt(0.5);
    bag.write("/tf", ros::Time(5, 0), transforms);
    sensor_msgs::LaserScan scan;
    scan.header.frame_id = "laser";
    scan.angle_min = -0.5f;
    scan.angle_increment = 0.25f;
    scan.range_max = 10.f;
    scan.ranges = {1.f, 2.f, 3.f};
    bag.write("/scan", ros::Time(6, 500), scan);
    sensor_msgs::Imu imu;
    imu.header.frame_id = "imu";
    imu.linear_acceleration.x = 1.;
    bag.write("/imu", ros::Time(6, 600), imu);
    bag.close();
  }
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_TRUE((*source)->info().warnings.empty());
  const std::vector<SensorEvent> events = ReadAll(source->get());
  ASSERT_EQ(events.size(), 2u);
  const auto& scan = absl::get<LaserScan>(events[0]);
  EXPECT_EQ(scan.time, 6000000500);  // when it was recorded
  EXPECT_EQ(scan.angle_min, 0.5);
  EXPECT_EQ(scan.angle_increment, -0.25);
  EXPECT_NEAR(scan.laser_pose.x, 0.5, 1e-12);
  EXPECT_NEAR(scan.laser_pose.theta, 0., 1e-12);
  // x of the IMU is y of the robot.
  EXPECT_TRUE(absl::get<ImuReading>(events[1]).linear_acceleration.isApprox(
      Eigen::Vector3d(0., 1., 0.)));
}

TEST(RosbagReaderTest, WriterErrors) {
  EXPECT_FALSE(RosbagWriter::Open("/nonexistent/a.bag", {}).ok());
  test::TemporaryFile file(".bag");
  RosbagWriterOptions options;
  options.compression = "zip";
  EXPECT_FALSE(RosbagWriter::Open(file.path(), options).ok());
  {
    auto writer = RosbagWriter::Open(file.path(), {});
    ASSERT_TRUE(writer.ok());
    EXPECT_FALSE((*writer)->AddScan(MakeScan(0, 3)).ok());
    EXPECT_FALSE((*writer)->AddImu(MakeImu(-5)).ok());
    ASSERT_TRUE((*writer)->AddScan(MakeScan(5, 3)).ok());
  }
  EXPECT_FALSE(test::Exists(file.path()));  // Not finished.
  if (!test::Exists("/dev/full")) return;
  auto writer = RosbagWriter::Open("/dev/full", {});
  absl::Status status = writer.status();
  if (writer.ok()) {
    for (int i = 1; i < 300 && status.ok(); ++i) {
      status = (*writer)->AddScan(MakeScan(i, 1000));
    }
    if (status.ok()) status = (*writer)->Finish();
  }
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr("/dev/full"));
}

TEST(RosbagReaderTest, TruncatedAndForeignFilesAreErrors) {
  test::TemporaryFile file(".bag");
  WriteSample(file.path(), "bz2");
  const std::string bytes = test::ReadBytes(file.path());
  for (const size_t size :
       {size_t{5}, size_t{13}, size_t{2000}, size_t{4500}}) {
    test::WriteBytes(file.path(), bytes.substr(0, size));
    const auto source = OpenSensorSource(file.path(), {});
    EXPECT_FALSE(source.ok()) << size;
    EXPECT_THAT(std::string(source.status().message()), HasSubstr(file.path()));
  }
  test::WriteBytes(file.path(), "FLASER 1 2 0 0 0 0 0 0 1 h 1\n");
  EXPECT_FALSE(OpenSensorSource(file.path(), {}).ok());
}

// What is read from `bytes` in place of a bag.
std::vector<SensorEvent> ReadBytesAsBag(const std::string& bytes,
                                        std::vector<std::string>* warnings) {
  test::TemporaryFile file(".bag");
  test::WriteBytes(file.path(), bytes);
  auto source = OpenSensorSource(file.path(), {});
  EXPECT_TRUE(source.ok()) << source.status();
  if (!source.ok()) return {};
  *warnings = (*source)->info().warnings;
  return ReadAll(source->get());
}

TEST(RosbagReaderTest, ReadsWithoutTheIndex) {
  test::TemporaryFile file(".bag");
  WriteSample(file.path(), "bz2");
  const std::string bytes = test::ReadBytes(file.path());
  std::vector<std::string> warnings;
  EXPECT_EQ(ReadBytesAsBag(bytes, &warnings).size(), 30u);
  EXPECT_TRUE(warnings.empty());
  // Cut off behind the only chunk, as when the recorder was killed.
  for (const size_t missing : {size_t{1}, size_t{100}}) {
    EXPECT_EQ(ReadBytesAsBag(bytes.substr(0, bytes.size() - missing), &warnings)
                  .size(),
              30u);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0], HasSubstr("cut off at byte"));
  }
  // The head of a bag that was not closed.
  std::string unfinished = bytes;
  const size_t index_position = unfinished.find("index_pos=") + 10;
  unfinished.replace(index_position, 8, std::string(8, '\0'));
  EXPECT_EQ(ReadBytesAsBag(unfinished, &warnings).size(), 30u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("no index"));
}

TEST(RosbagReaderTest, ReadsIndexRecordsOfWrongLength) {
  const std::string bag = test::SharedData("wild/index_length_wrong.bag");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(bag);
  auto source = OpenSensorSource(bag, {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_GT((*source)->info().num_scans, 300);
  ASSERT_FALSE((*source)->info().warnings.empty());
  EXPECT_THAT((*source)->info().warnings,
              ::testing::Contains(HasSubstr("wrong length")));
  EXPECT_GT(ReadAll(source->get()).size(), 300u);
}

TEST(RosbagReaderTest, SurvivesMutations) {
  for (const char* compression : {"none", "bz2", "lz4"}) {
    test::TemporaryFile file(".bag");
    WriteSample(file.path(), compression, 3);
    const std::string sample = test::ReadBytes(file.path());
    int num_opened = 0;
    test::ForEachMutation(
        sample,
        [&](const std::string& damaged) {
          test::WriteBytes(file.path(), damaged);
          auto source = OpenSensorSource(file.path(), {});
          if (!source.ok()) return;
          ++num_opened;
          SensorEvent event;
          int count = 0;
          while (count++ < 100000) {
            const auto more = (*source)->Next(&event);
            if (!more.ok() || !*more) break;
          }
          EXPECT_LT(count, 100000);
        },
        100);
    EXPECT_LT(num_opened, test::FuzzIterations(100));
  }
}

TEST(RosbagReaderTest, SharedData) {
  const std::string bag = test::SharedData("bags/mit-csail.sort.bag");
  const std::string log = test::SharedData("carmen/mit-csail.clf.xz");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(bag);
  auto source = OpenSensorSource(bag, {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_scans, 1988);
  EXPECT_EQ((*source)->info().num_odometry, 1988);
  EXPECT_TRUE((*source)->info().warnings.empty());
  auto carmen = OpenSensorSource(log, {});
  ASSERT_TRUE(carmen.ok());
  const std::vector<SensorEvent> from_bag = ReadAll(source->get());
  const std::vector<SensorEvent> from_log = ReadAll(carmen->get());
  ASSERT_EQ(from_bag.size(), from_log.size());
  for (size_t i = 0; i < from_bag.size(); ++i) {
    ASSERT_EQ(from_bag[i].index(), from_log[i].index()) << i;
    ASSERT_NEAR(EventTime(from_bag[i]), EventTime(from_log[i]), 1000.) << i;
    if (const auto* scan = absl::get_if<LaserScan>(&from_bag[i])) {
      const auto& other = absl::get<LaserScan>(from_log[i]);
      ASSERT_EQ(scan->ranges.size(), other.ranges.size());
      EXPECT_NEAR(scan->angle_increment, other.angle_increment, 1e-7);
      EXPECT_NEAR(scan->ranges[7], other.ranges[7], 1e-5);
    }
  }
}

TEST(RosbagReaderTest, SharedAces) {
  const std::string bag = test::SharedData("bags/aces.sort.bag");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(bag);
  auto source = OpenSensorSource(bag, {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_scans, 7374);
  const std::vector<SensorEvent> events = ReadAll(source->get());
  for (const SensorEvent& event : events) {
    if (const auto* scan = absl::get_if<LaserScan>(&event)) {
      // As recorded in the bag, though the laser steps by pi / 180.
      EXPECT_NEAR(scan->angle_increment, M_PI / 179., 1e-6);
      break;
    }
  }
}

#else

TEST(RosbagReaderTest, SaysWhatIsMissing) {
  test::TemporaryFile file(".bag");
  const auto writer = RosbagWriter::Open(file.path(), {});
  EXPECT_EQ(writer.status().code(), absl::StatusCode::kUnimplemented);
  EXPECT_THAT(std::string(writer.status().message()),
              HasSubstr("librosbag-storage"));
}

#endif

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
