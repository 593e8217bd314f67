// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/rosbag2_writer.h"

#include <fstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/ros/ros2_sample.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

TEST(Rosbag2WriterTest, NothingIsLeftBehindWithoutFinish) {
  for (const Rosbag2Storage storage :
       {Rosbag2Storage::kMcap, Rosbag2Storage::kDb3}) {
    test::TemporaryFile file(".ros2");
    {
      RosbagWriterOptions options;
      options.compression = "none";
      auto writer = OpenRosbag2Writer(file.path(), storage, options);
      ASSERT_TRUE(writer.ok()) << writer.status();
      ASSERT_TRUE((*writer)->AddScan(test::SampleScan(1000000000, 8)).ok());
    }
    EXPECT_FALSE(std::ifstream(file.path()).good());
  }
}

TEST(Rosbag2WriterTest, ErrorsNameTheFile) {
  RosbagWriterOptions options;
  options.compression = "none";
  EXPECT_THAT(std::string(OpenRosbag2Writer("/nonexistent/a.mcap",
                                            Rosbag2Storage::kMcap, options)
                              .status()
                              .message()),
              HasSubstr("/nonexistent"));
  EXPECT_FALSE(
      OpenRosbag2Writer("/nonexistent/a.db3", Rosbag2Storage::kDb3, options)
          .ok());
  test::TemporaryFile file(".mcap");
  auto writer = OpenRosbag2Writer(file.path(), Rosbag2Storage::kMcap, options);
  ASSERT_TRUE(writer.ok());
  EXPECT_EQ((*writer)->AddScan(test::SampleScan(-5, 8)).code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_TRUE((*writer)->Finish().ok());
  EXPECT_EQ((*writer)->Finish().code(), absl::StatusCode::kFailedPrecondition);
  options.compression = "bz2";
  EXPECT_THAT(
      std::string(OpenRosbag2Writer(file.path(), Rosbag2Storage::kMcap, options)
                      .status()
                      .message()),
      HasSubstr("must be none, lz4 or zstd"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
