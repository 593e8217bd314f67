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
#include "tests/io/ros/ros2_sample.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class MemoryContainer : public RosContainer {
 public:
  void Add(const std::string& topic, const std::string& type, const std::string& data) {
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
      if (static_cast<int>(at_) == fail_after_) return absl::DataLossError("memory: gone");
      *message = messages_[at_++];
      if (wanted_.count(message->topic) > 0) return true;
    }
    return false;
  }
  std::vector<std::string> warnings() const override { return {"memory: rather short"}; }

 private:
  RosTopics topics_;
  std::deque<RosMessage> messages_;
  std::set<std::string> wanted_;
  size_t at_ = 0;
  int fail_after_ = -1;
};

TEST(RosRecordingTest, TypesOfRos2) {
  EXPECT_STREQ(TypeOfRos2("sensor_msgs/msg/LaserScan").md5sum.c_str(), kRosLaserScan.md5sum);
  EXPECT_EQ(TypeOfRos2("sensor_msgs/msg/LaserScan").name, "sensor_msgs/msg/LaserScan");
  EXPECT_EQ(TypeOfRos2("sensor_msgs/LaserScan").md5sum, "");
  EXPECT_EQ(TypeOfRos2("my_msgs/msg/LaserScan").md5sum, "");
}

TEST(RosRecordingTest, WarningsOfTheContainerAndDamagedMessagesAreReported) {
  auto container = absl::make_unique<MemoryContainer>();
  container->Add("scan", kRos2LaserScan, EncodeLaserScan(test::SampleScan(2000000000, 5), "base_link"));
  container->Add("scan", kRos2LaserScan, "not a scan");
  auto source = OpenRosRecording("memory", std::move(container), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().num_scans, 1);
  EXPECT_THAT((*source)->info().warnings, ElementsAre(HasSubstr("1 messages on scan cannot be decoded; skipped"),
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
  container->Add("scan", kRos2LaserScan, EncodeLaserScan(test::SampleScan(2000000000, 5), "base_link"));
  container->Add("scan", kRos2LaserScan, EncodeLaserScan(test::SampleScan(3000000000, 5), "base_link"));
  container->FailAfter(1);
  EXPECT_EQ(OpenRosRecording("memory", std::move(container), {}).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(
                  OpenRosRecording("memory", absl::make_unique<MemoryContainer>(), {}).status().message()),
              HasSubstr("memory: no topic of type sensor_msgs/LaserScan"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
