// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>

#include "cartographer_ext/io/expansion_budget.h"
#include "cartographer_ext/io/ros/mcap_format.h"
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

std::string Block(const std::string& bytes) {
  const uint32_t size = static_cast<uint32_t>(bytes.size());
  return std::string(reinterpret_cast<const char*>(&size), sizeof(size)) +
         bytes;
}

template <typename Number>
std::string Field(const std::string& name, const Number number) {
  return Block(
      name + "=" +
      std::string(reinterpret_cast<const char*>(&number), sizeof(number)));
}

// A chunk of zeros after a file header.
TEST(RosbagBombTest, ChunksThatExpandTooMuchEnd) {
  constexpr uint32_t kSize = 100 << 20;
  const auto packed = McapCompress("lz4", std::string(kSize, '\0'));
  ASSERT_TRUE(packed.ok());
  ASSERT_LT(packed->size(), 600000u);
  test::TemporaryFile file(".bag");
  test::WriteBytes(
      file.path(),
      "#ROSBAG V2.0\n" +
          Block(Field("op", uint8_t{3}) + Field("index_pos", uint64_t{0})) +
          Block("") +
          Block(Field("op", uint8_t{5}) + Field("size", kSize) +
                Block("compression=lz4")) +
          Block(*packed));
  const auto source = OpenRosbag(file.path(), {});
  EXPECT_EQ(source.status().code(), absl::StatusCode::kResourceExhausted)
      << source.status();
  EXPECT_THAT(std::string(source.status().message()),
              HasSubstr(file.path() + ": expands to more than 50 times"));
  SetMaxExpansion(1000);
  EXPECT_EQ(OpenRosbag(file.path(), {}).status().code(),
            absl::StatusCode::kDataLoss);
  SetMaxExpansion(50);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
