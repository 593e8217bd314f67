// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_format.h"

#include <cstdint>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

TEST(McapFormatTest, FieldsEndWhereTheRecordEnds) {
  McapFields fields(
      absl::string_view("\x01\x02\x00\x00\x00"
                        "abc",
                        8));
  EXPECT_EQ(fields.Take<uint8_t>(), 1);
  EXPECT_EQ(fields.TakeString(), "ab");
  EXPECT_TRUE(fields.ok());
  EXPECT_EQ(fields.Take<uint16_t>(), 0);
  EXPECT_FALSE(fields.ok());
  EXPECT_EQ(fields.Take<uint8_t>(), 0);  // and stays so
}

TEST(McapFormatTest, DecompressionInvertsCompression) {
  std::string text;
  for (int64_t i = 0; i < 200000; ++i) text += static_cast<char>(i * i % 251);
  for (const std::string compression : {"", "lz4", "zstd"}) {
    for (const std::string& data : {text, std::string("x"), std::string()}) {
      const auto packed = McapCompress(compression, data);
      ASSERT_TRUE(packed.ok()) << packed.status();
      const auto unpacked = McapDecompress(compression, *packed, data.size());
      ASSERT_TRUE(unpacked.ok()) << compression << unpacked.status();
      EXPECT_EQ(*unpacked, data);
    }
  }
  EXPECT_LT(McapCompress("zstd", text)->size(), text.size() / 2);
  EXPECT_FALSE(McapCompress("bz2", text).ok());
}

TEST(McapFormatTest, ChunksHoldWhatTheySay) {
  const std::string text(100000, 'a');
  for (const std::string compression : {"", "lz4", "zstd"}) {
    const std::string packed = *McapCompress(compression, text);
    EXPECT_FALSE(McapDecompress(compression, packed, text.size() - 1).ok());
    EXPECT_FALSE(McapDecompress(compression, packed, text.size() + 1).ok());
    EXPECT_FALSE(McapDecompress(compression,
                                packed.substr(0, packed.size() / 2),
                                text.size())
                     .ok());
  }
  // A chunk that expands to gigabytes is refused before it does.
  EXPECT_THAT(
      std::string(
          McapDecompress("zstd", "", uint64_t{1} << 40).status().message()),
      HasSubstr("declares"));
  EXPECT_EQ(McapDecompress("bz2", "x", 1).status().code(),
            absl::StatusCode::kUnimplemented);
}

TEST(McapFormatTest, ChecksumIsThatOfThePublishedExample) {
  EXPECT_EQ(McapChecksum("123456789"),
            0xcbf43926u);  // the check value of CRC-32
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
