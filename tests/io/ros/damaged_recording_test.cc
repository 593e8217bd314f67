// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// ROS 2 recordings with damage in the middle: what is whole around it is read.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/ros/mcap_format.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/ros/ros2_sample.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Chunks are 768 KiB: three of them.
constexpr int kSteps = 100;
constexpr int kBeams = 5000;

// Where the chunks of an MCAP file begin.
std::vector<size_t> ChunkOffsets(const std::string& bytes) {
  std::vector<size_t> offsets;
  size_t at = kMcapMagicSize;
  while (at + kMcapRecordHeadSize < bytes.size()) {
    uint64_t size;
    std::memcpy(&size, &bytes[at + 1], sizeof(size));
    if (bytes[at] == kMcapChunk) offsets.push_back(at);
    if (bytes[at] == kMcapDataEnd) break;
    at += kMcapRecordHeadSize + size;
  }
  return offsets;
}

void SetSize(const size_t record, const uint64_t size, std::string* bytes) {
  std::memcpy(&(*bytes)[record + 1], &size, sizeof(size));
}

uint64_t GetSize(const size_t record, const std::string& bytes) {
  uint64_t size;
  std::memcpy(&size, &bytes[record + 1], sizeof(size));
  return size;
}

struct Read {
  absl::Status status;
  std::vector<std::string> warnings;
  std::vector<int> steps;  // of the scans
};

// In order and as often as promised.
Read ReadScans(const std::string& bytes, const std::string& ending) {
  test::TemporaryFile file(ending);
  test::WriteBytes(file.path(), bytes);
  Read read;
  auto source = OpenSensorSource(file.path(), {});
  read.status = source.status();
  if (!source.ok()) return read;
  read.warnings = (*source)->info().warnings;
  SensorEvent event;
  while ((*source)->Next(&event).value()) {
    if (const auto* scan = absl::get_if<LaserScan>(&event)) {
      read.steps.push_back(
          static_cast<int>((scan->time - 1000000000000) / 100000000));
    }
  }
  EXPECT_EQ(read.steps.size(), (*source)->info().num_scans);
  return read;
}

class DamagedMcapTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    test::TemporaryFile file(".mcap");
    test::WriteRos2Sample(file.path(), Rosbag2Storage::kMcap, GetParam(),
                          kSteps, kBeams);
    bytes_ = test::ReadBytes(file.path());
    chunks_ = ChunkOffsets(bytes_);
    ASSERT_EQ(chunks_.size(), 3u);
  }

  // Everything but the second chunk.
  void ExpectBothEnds(const std::string& problem,
                      const std::string& place = " (in chunk 2)") {
    const Read read = ReadScans(bytes_, ".mcap");
    ASSERT_TRUE(read.status.ok()) << read.status;
    EXPECT_THAT(
        read.warnings,
        ElementsAre(
            AllOf(HasSubstr(problem),
                  HasSubstr(absl::StrCat("(record at byte ", chunks_[1], ")")),
                  HasSubstr("; left out 1 damaged part" + place + ", "),
                  HasSubstr(" MB and "), HasSubstr(" s of messages"),
                  HasSubstr("mcap recover"))));
    EXPECT_EQ(read.steps.front(), 1);
    EXPECT_EQ(read.steps.back(), kSteps);
    EXPECT_GT(read.steps.size(), kSteps / 2u);
    EXPECT_LT(read.steps.size(), 3u * kSteps / 4);
  }

  std::string bytes_;
  std::vector<size_t> chunks_;
};

TEST_P(DamagedMcapTest, AChunkWithFlippedBitsIsLeftOut) {
  bytes_[(chunks_[1] + chunks_[2]) / 2] ^= 0x10;
  ExpectBothEnds("a chunk ");
}

TEST_P(DamagedMcapTest, TheSummaryLeadsBehindAWrongLength) {
  SetSize(chunks_[1], uint64_t{1} << 60, &bytes_);
  ExpectBothEnds("a record of wrong length", "");
}

TEST_P(DamagedMcapTest, AndBehindALengthThatIsALittleWrong) {
  // The chunk itself is whole; what is taken for the record behind it is not.
  SetSize(chunks_[1], GetSize(chunks_[1], bytes_) + 7, &bytes_);
  const Read read = ReadScans(bytes_, ".mcap");
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_EQ(read.steps.size(), size_t{kSteps});
}

TEST_P(DamagedMcapTest, TheSummaryKnowsTheChannelsOfALostChunk) {
  bytes_[(chunks_[0] + chunks_[1]) / 2] ^= 0x10;
  const Read read = ReadScans(bytes_, ".mcap");
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_GT(read.steps.size(), kSteps / 2u);
  EXPECT_EQ(read.steps.back(), kSteps);
  EXPECT_THAT(read.warnings, Contains(HasSubstr("(in chunk 1)")));
}

TEST_P(DamagedMcapTest, NothingUsableIsAnError) {
  for (const size_t chunk : chunks_) bytes_[chunk + 600] ^= 0x10;
  const Read read = ReadScans(bytes_, ".mcap");
  EXPECT_EQ(read.status.code(), absl::StatusCode::kDataLoss) << read.status;
  EXPECT_THAT(std::string(read.status.message()), HasSubstr("record at byte"));
}

TEST_P(DamagedMcapTest, ErrorsSayWhatCouldNotBeRead) {
  // Without the summary the channels are lost with the first chunk.
  bytes_[(chunks_[0] + chunks_[1]) / 2] ^= 0x10;
  bytes_.resize(chunks_[2] + 100);
  const Read read = ReadScans(bytes_, ".mcap");
  EXPECT_THAT(std::string(read.status.message()),
              AllOf(HasSubstr("no topic of type"), HasSubstr("in chunk 1)"),
                    HasSubstr("cut off")));
}

INSTANTIATE_TEST_SUITE_P(All, DamagedMcapTest,
                         ::testing::Values("none", "lz4", "zstd"));

std::string Database(const int num_steps) {
  test::TemporaryFile file(".db3");
  test::WriteRos2Sample(file.path(), Rosbag2Storage::kDb3, "none", num_steps,
                        200);
  return test::ReadBytes(file.path());
}

TEST(DamagedDb3Test, PagesThatCannotBeReadAreLeftOut) {
  constexpr size_t kPage = 4096;
  constexpr int kManySteps = 300;
  const std::string whole = Database(kManySteps);
  const size_t num_pages = whole.size() / kPage;
  ASSERT_GT(num_pages, 100u);
  int num_lossy = 0;
  // The first pages hold the tables of tables and topics.
  for (size_t page = 20; page < num_pages; page += 7) {
    SCOPED_TRACE(page);
    std::string bytes = whole;
    bytes.replace(page * kPage, kPage, std::string(kPage, '\xff'));
    const Read read = ReadScans(bytes, ".db3");
    ASSERT_TRUE(read.status.ok()) << read.status;
    EXPECT_GT(read.steps.size(), 9u * kManySteps / 10);
    if (read.steps.size() == size_t{kManySteps}) continue;
    ++num_lossy;
    ASSERT_FALSE(read.warnings.empty());
    EXPECT_EQ(read.steps.front(), 1);
  }
  EXPECT_GT(num_lossy, 5);
}

TEST(DamagedDb3Test, WhatIsThereOfADatabaseThatWasCutOffIsRead) {
  const std::string whole = Database(300);
  const Read read = ReadScans(whole.substr(0, whole.size() / 2), ".db3");
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_GT(read.steps.size(), 100u);
  EXPECT_LT(read.steps.size(), 200u);
  EXPECT_EQ(read.steps.front(), 1);
  EXPECT_THAT(read.warnings,
              Contains(AllOf(HasSubstr("cut off or damaged"),
                             HasSubstr("ros2 bag reindex"), HasSubstr("lost"),
                             HasSubstr(" are read"))));
}

TEST(DamagedDb3Test, NothingUsableIsAnError) {
  std::string bytes = Database(20);
  bytes.replace(4096, bytes.size() - 4096,
                std::string(bytes.size() - 4096, '\xff'));
  const Read read = ReadScans(bytes, ".db3");
  EXPECT_FALSE(read.status.ok());
  EXPECT_THAT(read.warnings, IsEmpty());
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
