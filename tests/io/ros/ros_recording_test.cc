// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What holds whatever the container is; topics, frames and stamps of bags are
// tested in rosbag_reader_test.cc.
#include <deque>

#include "absl/memory/memory.h"
#include "cartographer_ext/io/ros/ros2_messages.h"
#include "cartographer_ext/io/ros/ros_container.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/ros/message_bytes.h"
#include "tests/io/ros/ros2_sample.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class MemoryContainer : public RosContainer {
 public:
  void Add(const std::string& topic, const std::string& type,
           const std::string& data) {
    topics_[topic] = TypeOfRos2(type);
    RosMessage message;
    message.topic = topic;
    message.received = 77;
    message.data = data;
    messages_.push_back(message);
  }
  void FailAfter(const int messages) { fail_after_ = messages; }

  std::string format() const override { return "memory"; }
  RosEncoding encoding() const override { return RosEncoding::kCdr; }
  const RosTopics& topics() const override { return topics_; }
  absl::Status Rewind(const std::set<std::string>& topics) override {
    wanted_ = topics;
    at_ = 0;
    return absl::OkStatus();
  }
  absl::StatusOr<bool> Next(RosMessage* message) override {
    while (at_ < messages_.size()) {
      if (static_cast<int>(at_) == fail_after_)
        return absl::DataLossError("memory: gone");
      *message = messages_[at_++];
      if (wanted_.count(message->topic) > 0) return true;
    }
    return false;
  }
  std::vector<std::string> warnings() const override {
    return {"memory: rather short"};
  }

 private:
  RosTopics topics_;
  std::deque<RosMessage> messages_;
  std::set<std::string> wanted_;
  size_t at_ = 0;
  int fail_after_ = -1;
};

// Twenty scans a tenth of a second apart, whose beams claim to take `sweep`.
std::unique_ptr<MemoryContainer> TwentyScans(const double sweep) {
  auto container = absl::make_unique<MemoryContainer>();
  LaserScan scan;
  scan.angle_min = -kPi;
  scan.angle_increment = 2. * kPi / 5.;
  scan.range_max = 10.;
  scan.ranges = {1.f, 2.f, 3.f, 4.f, 5.f};
  scan.time_increment = sweep / 4.;
  for (int i = 0; i < 20; ++i) {
    // EncodeLaserScan stamps the first beam.
    scan.time = FromSeconds(10. + 0.1 * i + sweep);
    container->Add("/scan", kRos2LaserScan, EncodeLaserScan(scan, "base_link"));
  }
  return container;
}

TEST(RosRecordingTest, TypesOfRos2) {
  EXPECT_STREQ(TypeOfRos2("sensor_msgs/msg/LaserScan").md5sum.c_str(),
               kRosLaserScan.md5sum);
  EXPECT_EQ(TypeOfRos2("sensor_msgs/msg/LaserScan").name,
            "sensor_msgs/msg/LaserScan");
  EXPECT_EQ(TypeOfRos2("sensor_msgs/LaserScan").md5sum, "");
  EXPECT_EQ(TypeOfRos2("my_msgs/msg/LaserScan").md5sum, "");
}

TEST(RosRecordingTest, WarningsOfTheContainerAndDamagedMessagesAreReported) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("scan", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(2000000000, 5), "base_link"));
  container->Add("scan", kRos2LaserScan, "not a scan");
  auto source = OpenRosRecording("memory", std::move(container), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_scans, 1);
  EXPECT_THAT((*source)->info().warnings,
              ElementsAre(HasSubstr("1 messages on scan are damaged or have "
                                    "values that are not numbers; skipped"),
                          "memory: rather short"));
}

TEST(RosRecordingTest, WithoutStampTheTimeOfRecordingCounts) {
  auto container = absl::make_unique<MemoryContainer>();
  LaserScan scan = test::SampleScan(0, 1);
  container->Add("scan", kRos2LaserScan, EncodeLaserScan(scan, "base_link"));
  auto source = OpenRosRecording("memory", std::move(container), {});
  ASSERT_TRUE(source.ok()) << source.status();
  SensorEvent event;
  ASSERT_TRUE((*source)->Next(&event).value());
  EXPECT_EQ(EventTime(event), 77);
}

TEST(RosRecordingTest, ErrorsOfTheContainerArePassedOn) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("scan", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(2000000000, 5), "base_link"));
  container->Add("scan", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(3000000000, 5), "base_link"));
  container->FailAfter(1);
  EXPECT_EQ(
      OpenRosRecording("memory", std::move(container), {}).status().code(),
      absl::StatusCode::kDataLoss);
  EXPECT_THAT(
      std::string(
          OpenRosRecording("memory", absl::make_unique<MemoryContainer>(), {})
              .status()
              .message()),
      HasSubstr("memory: no topic of type sensor_msgs/LaserScan"));
}

std::vector<SensorEvent> ReadAll(SensorSource* const source) {
  std::vector<SensorEvent> events;
  SensorEvent event;
  while (source->Next(&event).value()) events.push_back(event);
  return events;
}

TEST(RosRecordingTest, SeveralLasersAreReadTogether) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("/front", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(2000000000, 5), "base_link"));
  container->Add("/rear", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(3000000000, 5), "base_link"));
  SensorSourceOptions options;
  options.scan_topic = "front,rear";
  auto source = OpenRosRecording("memory", std::move(container), options);
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_scans, 2);
  EXPECT_THAT((*source)->info().lasers, ElementsAre("/front", "/rear"));
  const auto events = ReadAll(source->get());
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(absl::get<LaserScan>(events[0]).sensor_id, "/front");
  EXPECT_EQ(absl::get<LaserScan>(events[1]).sensor_id, "/rear");
}

// Transforms from a robot to "odom" at 1 s and 2 s, and a scan between.
std::unique_ptr<MemoryContainer> OdometryInTransforms(const Pose2& first,
                                                      const Pose2& second) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("/tf", kRos2Transforms,
                 EncodeTransform(1000000000, "odom", "base_link", first));
  container->Add("/scan", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(1500000000, 5), "base_link"));
  container->Add("/tf", kRos2Transforms,
                 EncodeTransform(2000000000, "odom", "base_link", second));
  container->Add("/tf", kRos2Transforms,
                 EncodeTransform(2000000000, "map", "odom", Pose2(9., 9., 0.)));
  return container;
}

TEST(RosRecordingTest, OdometryFromTransforms) {
  auto source = OpenRosRecording(
      "memory", OdometryInTransforms(Pose2(1., 2., 0.5), Pose2(2., 2., 0.6)),
      {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_odometry, 2);
  EXPECT_THAT((*source)->info().warnings,
              testing::Contains(HasSubstr(
                  "taking the transforms from \"base_link\" to \"odom\"")));
  const auto events = ReadAll(source->get());
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(EventTime(events[0]), 1000000000);
  EXPECT_NEAR(absl::get<OdometryReading>(events[0]).pose.x, 1., 1e-12);
  EXPECT_NEAR(absl::get<OdometryReading>(events[2]).pose.theta, 0.6, 1e-12);
}

TEST(RosRecordingTest, OdometryWithoutFrameIsThatOfTheLaser) {
  auto container = TwentyScans(0.);
  OdometryReading reading;
  reading.time = FromSeconds(10.);
  container->Add("/ground_truth", kRos2Odometry,
                 EncodeOdometry(reading, 0., 0., "odom", ""));
  SensorSourceOptions options;
  options.tracking_frame = "nowhere";
  auto source = OpenRosRecording("memory", std::move(container), options);
  ASSERT_TRUE(source.ok()) << source.status();
  const std::vector<std::string>& warnings = (*source)->info().warnings;
  EXPECT_THAT(warnings,
              ::testing::Contains(HasSubstr(
                  "\"nowhere\" does not occur; taking \"base_link\"")));
  EXPECT_THAT(warnings,
              ::testing::Contains(HasSubstr(
                  "messages without a frame; taken to be at \"base_link\"")));
}

TEST(RosRecordingTest, TheFrameOfTheOdometryOccurs) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("/scan", kRos2LaserScan,
                 EncodeLaserScan(test::SampleScan(2000000000, 5), "laser"));
  OdometryReading reading;
  reading.time = FromSeconds(1.);
  container->Add("/odom", kRos2Odometry,
                 EncodeOdometry(reading, 0., 0., "odom", "base_link"));
  auto source = OpenRosRecording("memory", std::move(container), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_THAT((*source)->info().warnings,
              ElementsAre("memory: rather short",
                          HasSubstr("no transform from \"laser\" to "
                                    "\"base_link\"; assumed to coincide")));
}

TEST(RosRecordingTest, TransformsThatNeverChangeAreNoOdometry) {
  auto source =
      OpenRosRecording("memory", OdometryInTransforms(Pose2(), Pose2()), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_odometry, 0);
  EXPECT_EQ(ReadAll(source->get()).size(), 1u);
}

TEST(RosRecordingTest, PointsOfAPlanarLaser) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("/points", "sensor_msgs/msg/PointCloud2",
                 test::PointCloud2Bytes(RosEncoding::kCdr, 2, "laser",
                                        {{1.f, 0.f, 0.f}, {0.f, 2.f, 0.01f}}));
  container->Add("/tf", kRos2Transforms,
                 EncodeTransform(1000000000, "base_link", "laser",
                                 Pose2(0.5, 0., kPi / 2.)));
  auto source = OpenRosRecording("memory", std::move(container), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_scans, 1);
  const auto events = ReadAll(source->get());
  const auto& scan = absl::get<LaserScan>(events.at(0));
  EXPECT_EQ(scan.time, 2000000000);
  EXPECT_TRUE(scan.ranges.empty());
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_NEAR((scan.points[1] - Eigen::Vector2d(0., 2.)).norm(), 0., 1e-9);
  EXPECT_NEAR(
      (scan.laser_pose * scan.points[0] - Eigen::Vector2d(0.5, 1.)).norm(), 0.,
      1e-9);
}

TEST(RosRecordingTest, TheScanIsStampedWithItsLastPoint) {
  constexpr uint8_t kUint32 = 6;
  const auto raw = [](const uint32_t nanoseconds) {
    return test::Bytes().Add(nanoseconds).data();
  };
  auto container = absl::make_unique<MemoryContainer>();
  container->Add(
      "/points", "sensor_msgs/msg/PointCloud2",
      test::PointCloud2Bytes(RosEncoding::kCdr, 2, "base_link",
                             {{1.f, 0.f, 0.f}, {0.f, 2.f, 0.f}}, "t", kUint32,
                             {raw(100000000), raw(25000000)}));
  auto source = OpenRosRecording("memory", std::move(container), {});
  ASSERT_TRUE(source.ok()) << source.status();
  const auto events = ReadAll(source->get());
  const auto& scan = absl::get<LaserScan>(events.at(0));
  EXPECT_EQ(scan.time, 2100000000);
  EXPECT_THAT(scan.point_times,
              ElementsAre(0.f, ::testing::FloatNear(-0.075f, 1e-6f)));
}

TEST(RosRecordingTest, BeamsThatTakeLongerThanThereIsTimeAreAtOnce) {
  auto source = OpenRosRecording("memory", TwentyScans(0.4), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_THAT((*source)->info().warnings,
              ::testing::Contains(HasSubstr(
                  "make a scan take 0.4 s, but one comes every 0.1 s")));
  const auto events = ReadAll(source->get());
  ASSERT_EQ(events.size(), 20u);
  EXPECT_EQ(absl::get<LaserScan>(events[0]).time_increment, 0.);
  EXPECT_EQ(EventTime(events[0]), FromSeconds(10.));
  EXPECT_EQ((*source)->info().begin, FromSeconds(10.));
}

TEST(RosRecordingTest, PossibleTimesOfBeamsAreKept) {
  auto source = OpenRosRecording("memory", TwentyScans(0.1), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_THAT((*source)->info().warnings,
              ::testing::Not(
                  ::testing::Contains(HasSubstr("treated as instantaneous"))));
  const auto events = ReadAll(source->get());
  EXPECT_NEAR(absl::get<LaserScan>(events.at(0)).time_increment, 0.025, 1e-9);
}

TEST(RosRecordingTest, MissingTimesOfBeamsAreSaid) {
  auto source = OpenRosRecording("memory", TwentyScans(0.), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_THAT((*source)->info().warnings,
              ::testing::Contains(HasSubstr("no times of beams on /scan")));
}

TEST(RosRecordingTest, ClocksThatDisagreeAreSaid) {
  for (const double offset : {0., 1.7e9}) {
    auto container = TwentyScans(0.);
    OdometryReading odometry;
    for (int i = 0; i < 3; ++i) {
      odometry.time = FromSeconds(10. + i + offset);
      container->Add("/odom", kRos2Odometry,
                     EncodeOdometry(odometry, 0., 0., "odom", "base_link"));
    }
    auto source = OpenRosRecording("memory", std::move(container), {});
    ASSERT_TRUE(source.ok()) << source.status();
    const auto warned = ::testing::Contains(
        HasSubstr("odometry has stamps from 1700000010.000000000 s"));
    if (offset == 0.) {
      EXPECT_THAT((*source)->info().warnings, ::testing::Not(warned));
    } else {
      EXPECT_THAT((*source)->info().warnings, warned);
    }
  }
}

TEST(RosRecordingTest, BeamsInOneDirectionAreNoScan) {
  LaserScan scan;
  scan.range_max = 10.;
  scan.ranges = {1.f, 2.f};
  scan.angle_increment = 0.;
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("/scan", kRos2LaserScan, EncodeLaserScan(scan, "base_link"));
  EXPECT_THAT(std::string(OpenRosRecording("memory", std::move(container), {})
                              .status()
                              .message()),
              HasSubstr("no valid scan on /scan: 1 messages are damaged or "
                        "have no beams, or angles"));
}

TEST(RosRecordingTest, PointsInSpaceAreRefused) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("/points", "sensor_msgs/msg/PointCloud2",
                 test::PointCloud2Bytes(RosEncoding::kCdr, 2, "base_link",
                                        {{1.f, 0.f, 0.f}, {0.f, 2.f, 1.f}}));
  EXPECT_THAT(std::string(OpenRosRecording("memory", std::move(container), {})
                              .status()
                              .message()),
              HasSubstr("do not lie in one plane"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
