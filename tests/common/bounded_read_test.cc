// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/bounded_read.h"

#include <fstream>
#include <sstream>
#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(BoundedReadTest, ReadsToTheEnd) {
  for (const size_t size :
       {size_t{0}, size_t{1}, size_t{65536}, size_t{200001}}) {
    const std::string written(size, 'x');
    std::istringstream stream(written);
    std::string content = "head ";
    EXPECT_TRUE(ReadUpTo(1000000, &stream, &content));
    EXPECT_EQ(content, "head " + written);
  }
}

TEST(BoundedReadTest, StopsSoonAfterTheLimit) {
  std::ifstream endless("/dev/zero", std::ios::binary);
  ASSERT_TRUE(endless);
  std::string content;
  EXPECT_TRUE(ReadUpTo(100000, &endless, &content));
  EXPECT_GT(content.size(), 100000u);
  EXPECT_LE(content.size(), 100000u + 65536u);
}

TEST(BoundedReadTest, ExactlyTheLimitIsNotTooMuch) {
  std::istringstream stream(std::string(100, 'x'));
  std::string content;
  EXPECT_TRUE(ReadUpTo(100, &stream, &content));
  EXPECT_EQ(content.size(), 100u);
  EXPECT_TRUE(stream.eof());
}

TEST(BoundedReadTest, GoesOnWithALargerLimit) {
  const std::string written(300000, 'x');
  std::istringstream stream(written);
  std::string content;
  EXPECT_TRUE(ReadUpTo(0, &stream, &content));
  EXPECT_LT(content.size(), written.size());
  EXPECT_TRUE(ReadUpTo(1000000, &stream, &content));
  EXPECT_EQ(content, written);
}

TEST(BoundedReadTest, AFolderCannotBeRead) {
  std::ifstream folder("/", std::ios::binary);
  std::string content;
  EXPECT_FALSE(folder.is_open() && ReadUpTo(100, &folder, &content));
  EXPECT_EQ(content, "");
}

}  // namespace
}  // namespace cartographer_ext
