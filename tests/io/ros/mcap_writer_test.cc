// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_writer.h"

#include <map>
#include <sstream>

#include "cartographer_ext/io/ros/mcap_format.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

// The records at the top level: opcode and content, by offset.
std::map<uint64_t, std::pair<uint8_t, std::string>> Records(
    const std::string& file) {
  std::map<uint64_t, std::pair<uint8_t, std::string>> records;
  McapFields fields(absl::string_view(file).substr(
      kMcapMagicSize, file.size() - 2 * kMcapMagicSize));
  while (!fields.rest().empty()) {
    const uint64_t offset = file.size() - kMcapMagicSize - fields.rest().size();
    const uint8_t opcode = fields.Take<uint8_t>();
    const std::string content(fields.TakeBytes(fields.Take<uint64_t>()));
    EXPECT_TRUE(fields.ok());
    records[offset] = {opcode, content};
  }
  return records;
}

TEST(McapWriterTest, IndexesPointToTheMessages) {
  std::ostringstream out;
  McapWriter writer(&out, "");
  const uint16_t a = writer.AddChannel("/a", "std_msgs/msg/Header", "");
  const uint16_t b = writer.AddChannel("/b", "std_msgs/msg/Header", "");
  ASSERT_TRUE(writer.Write(a, 10, "first").ok());
  ASSERT_TRUE(writer.Write(b, 5, "second").ok());
  ASSERT_TRUE(writer.Write(a, 20, "third").ok());
  ASSERT_TRUE(writer.Finish().ok());
  const std::string file = out.str();
  EXPECT_EQ(file.substr(0, kMcapMagicSize), kMcapMagic);
  EXPECT_EQ(file.substr(file.size() - kMcapMagicSize), kMcapMagic);
  const auto records = Records(file);
  std::map<uint8_t, int> counts;
  for (const auto& record : records) ++counts[record.second.first];
  EXPECT_EQ(counts[kMcapChunk], 1);
  EXPECT_EQ(counts[kMcapMessageIndex], 2);
  EXPECT_EQ(counts[kMcapChunkIndex], 1);
  EXPECT_EQ(counts[kMcapStatistics], 1);
  EXPECT_EQ(counts[kMcapSchema],
            1);  // in the summary; the other is in the chunk
  for (const auto& record : records) {
    McapFields fields(record.second.second);
    if (record.second.first == kMcapChunkIndex) {
      EXPECT_EQ(fields.Take<uint64_t>(), 5u);
      EXPECT_EQ(fields.Take<uint64_t>(), 20u);
      const uint64_t chunk = fields.Take<uint64_t>();
      EXPECT_EQ(records.at(chunk).first, kMcapChunk);
      EXPECT_EQ(fields.Take<uint64_t>(),
                kMcapRecordHeadSize + records.at(chunk).second.size());
      McapFields offsets(fields.TakeString());
      for (int i = 0; i < 2; ++i) {
        const uint16_t channel = offsets.Take<uint16_t>();
        const auto& index = records.at(offsets.Take<uint64_t>());
        EXPECT_EQ(index.first, kMcapMessageIndex);
        EXPECT_EQ(McapFields(index.second).Take<uint16_t>(), channel);
      }
    }
    if (record.second.first == kMcapMessageIndex) {
      const uint16_t channel = fields.Take<uint16_t>();
      McapFields entries(fields.TakeString());
      const uint64_t time = entries.Take<uint64_t>();
      const uint64_t offset = entries.Take<uint64_t>();
      EXPECT_EQ(time, channel == a ? 10u : 5u);
      // The chunk: times, size, checksum, compression, length, then records.
      for (const auto& chunk : records) {
        if (chunk.second.first != kMcapChunk) continue;
        McapFields message(
            absl::string_view(chunk.second.second).substr(40 + offset));
        EXPECT_EQ(message.Take<uint8_t>(), kMcapMessage);
        message.Take<uint64_t>();
        EXPECT_EQ(message.Take<uint16_t>(), channel);
      }
    }
    if (record.second.first == kMcapFooter) {
      const uint64_t summary = fields.Take<uint64_t>();
      EXPECT_EQ(records.at(summary).first, kMcapSchema);
    }
    if (record.second.first == kMcapStatistics) {
      EXPECT_EQ(fields.Take<uint64_t>(), 3u);
    }
  }
}

TEST(McapWriterTest, WithoutMessagesTheFileIsStillWhole) {
  std::ostringstream out;
  McapWriter writer(&out, "zstd");
  ASSERT_TRUE(writer.Finish().ok());
  EXPECT_EQ(Records(out.str()).rbegin()->second.first, kMcapFooter);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
