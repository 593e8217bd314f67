// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a state is saved to.
#include <sys/stat.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "cartographer/mapping/map_builder.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

std::string ReadFile(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

class StateFileTest : public ::testing::Test {
 protected:
  const std::unique_ptr<MapBuilderInterface> builder_ = CreateMapBuilder(
      test::LoadSlamOptions("MAP_BUILDER.use_trajectory_builder_2d = true\n")
          .map_builder);
  const std::string file_ = ::testing::TempDir() + "state_file.pbstream";
};

TEST_F(StateFileTest, APipeIsWrittenIntoNotReplaced) {
  ASSERT_TRUE(builder_->SerializeStateToFile(true, file_));
  const std::string expected = ReadFile(file_);
  EXPECT_GT(expected.size(), 8u);
  std::remove(file_.c_str());
  ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&]() { read = ReadFile(file_); });
  EXPECT_TRUE(builder_->SerializeStateToFile(true, file_));
  struct stat after;
  ASSERT_EQ(::stat(file_.c_str(), &after), 0);
  ASSERT_TRUE(S_ISFIFO(after.st_mode));
  reader.join();
  EXPECT_EQ(read, expected);
  std::remove(file_.c_str());
}

TEST_F(StateFileTest, AFullDeviceIsAnErrorAndStays) {
  EXPECT_FALSE(builder_->SerializeStateToFile(true, "/dev/full"));
  struct stat after;
  ASSERT_EQ(::stat("/dev/full", &after), 0);
  EXPECT_TRUE(S_ISCHR(after.st_mode));
}

TEST_F(StateFileTest, AFolderThatDoesNotExistIsAnError) {
  EXPECT_FALSE(builder_->SerializeStateToFile(true, file_ + ".no/state"));
  // Nor is a folder a file.
  EXPECT_FALSE(builder_->SerializeStateToFile(true, ::testing::TempDir()));
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
