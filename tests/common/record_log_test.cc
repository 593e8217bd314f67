// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/record_log.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

std::string Read(const std::string& filename) {
  std::ifstream file(filename, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

TEST(RecordLogTest, WritesNothingWithoutAFolder) {
  RecordLog log("", "loops", "a,b\n");
  EXPECT_FALSE(log.is_on());
  EXPECT_TRUE(log.status().ok());
  log.Append("1,2\n", "bytes");
}

TEST(RecordLogTest, EachRunHasFilesOfItsOwn) {
  const std::string folder = testing::TempDir() + "record_log_test";
  for (const char* number : {"1", "2"}) {
    const std::string stem = folder + "/loops-" + number;
    RecordLog log(folder, "loops", "a,b\n");
    ASSERT_TRUE(log.is_on()) << log.status();
    EXPECT_EQ(log.filename(), stem + ".csv");
    EXPECT_EQ(Read(stem + ".csv"), "a,b\n");
    log.Append("1,2\n", "xy");
    log.Append("3,4\n", "z");
    // Before the log is closed.
    EXPECT_EQ(Read(stem + ".csv"), "a,b\n1,2\n3,4\n");
    EXPECT_EQ(Read(stem + ".pb"), "xyz");
  }
  for (const char* name : {"1.csv", "1.pb", "2.csv", "2.pb"}) {
    EXPECT_EQ(std::remove((folder + "/loops-" + name).c_str()), 0) << name;
  }
  std::remove(folder.c_str());
}

TEST(RecordLogTest, AnErrorNamesTheFileAndEndsTheLog) {
  RecordLog log("/nowhere/at/all", "loops", "a\n");
  EXPECT_FALSE(log.is_on());
  EXPECT_THAT(std::string(log.status().message()),
              testing::HasSubstr("/nowhere/at/all/loops-1.csv"));
  log.Append("1\n", "");
}

TEST(RecordLogTest, AFullDiskEndsTheLog) {
  // /dev/full takes no byte; the table is an ordinary file beside a link to it.
  const std::string folder = testing::TempDir() + "record_log_full_test";
  RecordLog first(folder, "loops", "a\n");
  ASSERT_TRUE(first.is_on());
  const std::string link = folder + "/loops-2.pb";
  ASSERT_EQ(symlink("/dev/full", link.c_str()), 0);
  RecordLog log(folder, "loops", "a\n");
  ASSERT_TRUE(log.is_on());
  log.Append("1\n", "bytes");
  EXPECT_FALSE(log.is_on());
  EXPECT_THAT(std::string(log.status().message()),
              testing::HasSubstr("loops-2"));
  for (const char* name : {"1.csv", "1.pb", "2.csv", "2.pb"}) {
    std::remove((folder + "/loops-" + name).c_str());
  }
  std::remove(folder.c_str());
}

}  // namespace
}  // namespace cartographer_ext
