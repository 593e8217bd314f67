// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Bags with damage in the middle: what is whole around it is read.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"
#include "cartographer_ext/io/ros/ros1/rosbag_records.h"
#include "cartographer_ext/io/ros/ros1/rosbag_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr size_t kBegin = 13;  // of the records, behind the magic word
constexpr int kScans = 120;
constexpr int kBeams = 5000;

struct Chunk {
  size_t begin = 0;  // of the record
  size_t data = 0;
  size_t size = 0;
};

// Three of them.
std::vector<Chunk> Chunks(const std::string& bytes) {
  std::vector<Chunk> chunks;
  absl::string_view rest = bytes;
  rest.remove_prefix(kBegin);
  RosbagRecord record;
  while (!rest.empty()) {
    Chunk chunk;
    chunk.begin = rest.data() - bytes.data();
    if (!TakeRosbagRecord(&rest, &record)) break;
    chunk.data = record.data.data() - bytes.data();
    chunk.size = record.data.size();
    if (record.op == kRosbagChunk) chunks.push_back(chunk);
  }
  return chunks;
}

struct Read {
  absl::Status status;
  std::vector<std::string> warnings;
  std::vector<int> scans;  // their numbers
};

Read ReadScans(const std::string& bytes) {
  test::TemporaryFile file(".bag");
  test::WriteBytes(file.path(), bytes);
  Read read;
  auto source = OpenRosbag(file.path(), {});
  read.status = source.status();
  if (!source.ok()) return read;
  read.warnings = (*source)->info().warnings;
  SensorEvent event;
  while ((*source)->Next(&event).value()) {
    if (const auto* scan = absl::get_if<LaserScan>(&event)) {
      read.scans.push_back(static_cast<int>(scan->time / 100000000));
    }
  }
  EXPECT_EQ(read.scans.size(), (*source)->info().num_scans);
  return read;
}

class DamagedRosbagTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    test::TemporaryFile file(".bag");
    RosbagWriterOptions options;
    options.compression = GetParam();
    auto writer = RosbagWriter::Open(file.path(), options);
    if (!writer.ok()) GTEST_SKIP() << writer.status();
    LaserScan scan;
    scan.angle_increment = 1e-3;
    scan.range_max = 30.;
    uint32_t noise = 1;
    for (int i = 1; i <= kScans; ++i) {
      scan.time = 100000000LL * i;
      scan.ranges.clear();
      for (int k = 0; k < kBeams; ++k) {
        noise = noise * 1664525u + 1013904223u;
        scan.ranges.push_back(1.f + 1e-9f * static_cast<float>(noise >> 2));
      }
      ASSERT_TRUE((*writer)->AddScan(scan).ok());
    }
    ASSERT_TRUE((*writer)->Finish().ok());
    bytes_ = test::ReadBytes(file.path());
    chunks_ = Chunks(bytes_);
    ASSERT_GE(chunks_.size(), 3u);
  }

  bool compressed() const { return std::string(GetParam()) != "none"; }
  void Damage(const size_t at, const size_t length = 64) {
    bytes_.replace(at, length, std::string(length, '\xff'));
  }

  // Everything but (a part of) the second chunk.
  void ExpectBothEnds(const std::string& problem, const std::string& place) {
    const Read read = ReadScans(bytes_);
    ASSERT_TRUE(read.status.ok()) << read.status;
    EXPECT_THAT(
        read.warnings,
        Contains(AllOf(HasSubstr(absl::StrCat("at byte ", chunks_[1].begin)),
                       HasSubstr(problem),
                       HasSubstr("; left out 1 damaged part" + place + ", "),
                       HasSubstr(" MB and "), HasSubstr(" s of messages"))));
    EXPECT_EQ(read.scans.front(), 1);
    EXPECT_EQ(read.scans.back(), kScans);
    EXPECT_GT(read.scans.size(), kScans / 2u);
    EXPECT_LT(read.scans.size(), size_t{kScans});
  }

  std::string bytes_;
  std::vector<Chunk> chunks_;
};

TEST_P(DamagedRosbagTest, ADamagedChunkIsLeftOut) {
  if (compressed()) {
    Damage(chunks_[1].data + 4, 32);
    ExpectBothEnds("cannot be decompressed", " (in chunk 2)");
  } else {
    // The first record of the chunk.
    Damage(chunks_[1].data, 64);
    ExpectBothEnds("a damaged record in a chunk", " (in chunk 2)");
  }
}

TEST_P(DamagedRosbagTest, TheIndexLeadsBehindAWrongHeader) {
  Damage(chunks_[1].begin, 4);
  ExpectBothEnds("a damaged record", "");
}

TEST_P(DamagedRosbagTest, TheIndexLeadsBehindAWrongLength) {
  // Longer than the file.
  Damage(chunks_[1].data - 4, 4);
  ExpectBothEnds("a record without end", "");
}

TEST_P(DamagedRosbagTest, TheIndexLeadsBehindALengthThatIsALittleWrong) {
  bytes_[chunks_[1].data - 4] ^= 0x04;
  const Read read = ReadScans(bytes_);
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_EQ(read.scans.front(), 1);
  EXPECT_EQ(read.scans.back(), kScans);
  EXPECT_GT(read.scans.size(), kScans / 2u);
  EXPECT_THAT(read.warnings, Contains(HasSubstr("left out 1 damaged part")));
}

TEST_P(DamagedRosbagTest, TheIndexKnowsTheConnectionsOfALostChunk) {
  Damage(chunks_[0].data + (compressed() ? 4 : 0), 32);
  const Read read = ReadScans(bytes_);
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_EQ(read.scans.back(), kScans);
  EXPECT_THAT(read.warnings, Contains(HasSubstr("(in chunk 1)")));
}

TEST_P(DamagedRosbagTest, WithoutAnIndexWholeRecordsLeadOn) {
  bytes_.resize(chunks_[2].data + chunks_[2].size + 10);
  const size_t index_position = bytes_.find("index_pos=") + 10;
  bytes_.replace(index_position, 8, std::string(8, '\0'));
  Damage(chunks_[1].data + (compressed() ? 4 : 0), 32);
  const Read read = ReadScans(bytes_);
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_THAT(read.warnings, AllOf(Contains(AllOf(HasSubstr("cut off at byte"),
                                                  HasSubstr("rosbag reindex"))),
                                   Contains(HasSubstr("(in chunk 2)"))));
  EXPECT_EQ(read.scans.front(), 1);
  EXPECT_GT(read.scans.back(), 2 * kScans / 3);
}

TEST_P(DamagedRosbagTest, WithoutAnIndexNothingBehindAWrongHeaderIsFound) {
  bytes_.resize(chunks_[2].data + chunks_[2].size);
  const size_t index_position = bytes_.find("index_pos=") + 10;
  bytes_.replace(index_position, 8, std::string(8, '\0'));
  Damage(chunks_[1].begin, 4);
  const Read read = ReadScans(bytes_);
  ASSERT_TRUE(read.status.ok()) << read.status;
  EXPECT_EQ(read.scans.front(), 1);
  EXPECT_LT(read.scans.back(), kScans / 2);
  EXPECT_THAT(read.warnings, Contains(HasSubstr("left out 1 damaged part")));
}

TEST_P(DamagedRosbagTest, NothingUsableIsAnError) {
  for (const Chunk& chunk : chunks_) {
    Damage(chunk.data + (compressed() ? 4 : 0), 32);
  }
  const Read read = ReadScans(bytes_);
  EXPECT_EQ(read.status.code(), absl::StatusCode::kDataLoss) << read.status;
  EXPECT_THAT(std::string(read.status.message()), HasSubstr("at byte"));
}

INSTANTIATE_TEST_SUITE_P(All, DamagedRosbagTest,
                         ::testing::Values("none", "bz2", "lz4"));

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
