// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/open_recording.h"

#include <cstdio>
#include <fstream>

#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(OpenRecordingTest, OpensLogsAndWorlds) {
  const auto log = OpenRecording(test::OwnData("flaser.clf"), {}, 0);
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_EQ((*log)->info().format, "carmen");
  const auto world =
      OpenRecording("configuration_files/worlds/circular_room.world", {}, 1);
  ASSERT_TRUE(world.ok()) << world.status();
  EXPECT_EQ((*world)->info().format, "world");
  EXPECT_GT((*world)->info().num_scans, 0);
}

TEST(OpenRecordingTest, MissingFilesAreErrors) {
  EXPECT_FALSE(OpenRecording("/nowhere/run.clf", {}, 0).ok());
  EXPECT_FALSE(OpenRecording("/nowhere/run.world", {}, 0).ok());
}

TEST(OpenRecordingTest, AFinishedMapIsNoRecording) {
  const std::string filename = testing::TempDir() + "open_recording_test.clf";
  std::ofstream(filename, std::ios::binary) << io::PbstreamMagic();
  const auto map = OpenRecording(filename, {}, 0);
  std::remove(filename.c_str());
  ASSERT_FALSE(map.ok());
  EXPECT_EQ(map.status().message(),
            filename + ": a finished map, not a recording");
}

TEST(OpenRecordingTest, FilesAreNamedAfterTheRecording) {
  EXPECT_EQ(RecordingStem("logs/run.clf.gz"), "run");
  EXPECT_EQ(RecordingStem("run.1.bag"), "run.1");
  EXPECT_EQ(RecordingStem("/logs/rosbag2_2024.05.01//"), "rosbag2_2024.05.01");
  EXPECT_EQ(RecordingStem("aces"), "aces");
  EXPECT_EQ(RecordingStem("logs/.bag"), "map");
  EXPECT_EQ(RecordingStem("/"), "map");
}

TEST(OpenRecordingTest, TakesTheSettingsOfTheConfiguration) {
  SensorSettings settings;
  settings.odometry_source = "scan";
  settings.tracking_frame = "base_footprint";
  const io::SensorSourceOptions options = ToSourceOptions(settings);
  EXPECT_EQ(options.odometry_source, "scan");
  EXPECT_EQ(options.tracking_frame, "base_footprint");
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
