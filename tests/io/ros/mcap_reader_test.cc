// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_reader.h"

#include <fstream>
#include <limits>
#include <string>

#include "cartographer_ext/io/expansion_budget.h"
#include "cartographer_ext/io/ros/mcap_writer.h"
#include "cartographer_ext/io/ros/ros2_messages.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/ros/ros2_sample.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Chunks are 768 KiB, so that these make several of them.
constexpr int kManySteps = 100;
constexpr int kManyBeams = 5000;

TEST(McapReaderTest, ReadsWhatWasWrittenWithAnyCompression) {
  for (const std::string compression : {"none", "lz4", "zstd"}) {
    for (const bool large : {false, true}) {
      const int num_steps = large ? kManySteps : 10,
                num_beams = large ? kManyBeams : 8;
      SCOPED_TRACE(compression);
      test::TemporaryFile file(".mcap");
      test::WriteRos2Sample(file.path(), Rosbag2Storage::kMcap, compression,
                            num_steps, num_beams);
      auto source = OpenSensorSource(file.path(), {});
      ASSERT_TRUE(source.ok()) << source.status();
      EXPECT_EQ((*source)->info().format, "mcap");
      EXPECT_THAT((*source)->info().warnings, IsEmpty());
      test::ExpectRos2Sample(source->get(), num_steps, num_beams);
    }
  }
}

TEST(McapReaderTest, TopicsHaveTheTypesOfTheirSchemas) {
  test::TemporaryFile file(".mcap");
  test::WriteRos2Sample(file.path(), Rosbag2Storage::kMcap, "lz4");
  auto container = OpenMcap(file.path());
  ASSERT_TRUE(container.ok()) << container.status();
  EXPECT_EQ(
      ListTopics((*container)->topics()),
      "/imu (sensor_msgs/msg/Imu), /odom (nav_msgs/msg/Odometry), /scan "
      "(sensor_msgs/msg/LaserScan), "
      "/tf (tf2_msgs/msg/TFMessage), /tf_static (tf2_msgs/msg/TFMessage)");
}

TEST(McapReaderTest, AFileThatWasCutOffIsReadAsFarAsItIsWhole) {
  test::TemporaryFile file(".mcap");
  test::WriteRos2Sample(file.path(), Rosbag2Storage::kMcap, "none", kManySteps,
                        kManyBeams);
  const std::string whole = test::ReadBytes(file.path());
  test::WriteBytes(file.path(), whole.substr(0, whole.size() / 2));
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_GT((*source)->info().num_scans, 1);
  EXPECT_LT((*source)->info().num_scans, kManySteps);
  EXPECT_THAT((*source)->info().warnings,
              ElementsAre(HasSubstr("cut off; read up to byte")));
}

TEST(McapReaderTest, DamageIsAnErrorThatNamesFileAndPlace) {
  test::TemporaryFile file(".mcap");
  test::WriteRos2Sample(file.path(), Rosbag2Storage::kMcap, "none");
  std::string bytes = test::ReadBytes(file.path());
  bytes[bytes.size() / 3] ^= 0x55;  // in the only chunk
  test::WriteBytes(file.path(), bytes);
  const auto container = OpenMcap(file.path());
  ASSERT_FALSE(container.ok());
  EXPECT_EQ(container.status().code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(container.status().message()),
              HasSubstr(file.path() + ": a chunk with a wrong checksum"));
  EXPECT_THAT(std::string(container.status().message()),
              HasSubstr("record at byte"));
  test::WriteBytes(file.path(), "\x89MCAP1\r\n");
  EXPECT_THAT(std::string(OpenMcap(file.path()).status().message()),
              HasSubstr("not an MCAP file of version 0"));
}

TEST(McapReaderTest, BombsEnd) {
  test::TemporaryFile file(".mcap");
  {
    std::ofstream out(file.path(), std::ios::binary);
    McapWriter writer(&out, "zstd");
    const uint16_t channel =
        writer.AddChannel("/scan", "sensor_msgs/msg/LaserScan", "");
    const std::string zeros(4 << 20, '\0');
    for (int i = 1; i <= 20; ++i)
      ASSERT_TRUE(writer.Write(channel, i, zeros).ok());
    ASSERT_TRUE(writer.Finish().ok());
  }
  ASSERT_LT(test::ReadBytes(file.path()).size(), 100000u);
  const auto container = OpenMcap(file.path());
  EXPECT_EQ(container.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(
      std::string(container.status().message()),
      HasSubstr(file.path() + ": expands to more than 50 times its size"));
  SetMaxExpansion(10000);
  EXPECT_TRUE(OpenMcap(file.path()).ok());
  SetMaxExpansion(50);
}

// A scan without a stamp has the time at which it was recorded. That may be any
// number, and a scan is later than its stamp by the time that it takes.
TEST(McapReaderTest, TimesOfRecordingThatCannotBeAreLimited) {
  test::TemporaryFile file(".mcap");
  LaserScan scan = test::SampleScan(0, 8);
  const TimeNs sweep = FromSeconds(SweepSeconds(scan));
  ASSERT_GT(sweep, 0);
  scan.time = sweep;
  {
    std::ofstream out(file.path(), std::ios::binary);
    McapWriter writer(&out, "");
    const uint16_t channel = writer.AddChannel("/scan", kRos2LaserScan, "");
    for (const TimeNs time : {TimeNs{5}, std::numeric_limits<TimeNs>::max(),
                              std::numeric_limits<TimeNs>::min()}) {
      ASSERT_TRUE(
          writer.Write(channel, time, EncodeLaserScan(scan, "base_link")).ok());
    }
    ASSERT_TRUE(writer.Finish().ok());
  }
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  SensorEvent event;
  for (const TimeNs time : {TimeNs{5}, kMaxRecorded, kMaxRecorded}) {
    ASSERT_TRUE((*source)->Next(&event).value());
    EXPECT_EQ(EventTime(event), time + sweep);
  }
}

TEST(McapReaderTest, SurvivesDamagedFiles) {
  for (const std::string compression : {"none", "lz4", "zstd"}) {
    test::TemporaryFile sample(".mcap");
    test::WriteRos2Sample(sample.path(), Rosbag2Storage::kMcap, compression);
    test::TemporaryFile file(".mcap");
    test::ForEachMutation(
        test::ReadBytes(sample.path()), [&](const std::string& damaged) {
          test::WriteBytes(file.path(), damaged);
          auto container = OpenMcap(file.path());
          if (!container.ok()) {
            EXPECT_THAT(std::string(container.status().message()),
                        HasSubstr(file.path()));
            return;
          }
          auto source =
              OpenRosRecording(file.path(), *std::move(container), {});
          SensorEvent event;
          for (int i = 0; source.ok() && i < 1000; ++i) {
            const auto more = (*source)->Next(&event);
            if (!more.ok() || !*more) break;
          }
        });
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
