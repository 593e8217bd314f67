// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_reader.h"

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer/common/port.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Data = cartographer::mapping::proto::SerializedData;

absl::Status Read(const std::string& content,
                  const PbstreamReaderOptions& options = {}) {
  return ParsePbstream(content, "x.pbstream", options).status();
}

void ExpectError(const absl::Status& status, const absl::StatusCode code,
                 const std::string& text) {
  EXPECT_EQ(status.code(), code) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(text));
  EXPECT_THAT(std::string(status.message()), HasSubstr("x.pbstream: "));
}

// A file of these records, each a serialized message.
std::string FileOf(const std::vector<std::string>& records) {
  std::string content(PbstreamMagic());
  for (const std::string& record : records) {
    AppendPbstreamRecord(record, &content);
  }
  return content;
}

std::string HeaderRecord(const int version) {
  cartographer::mapping::proto::SerializationHeader header;
  header.set_format_version(version);
  return header.SerializeAsString();
}

std::string EmptyPoseGraph() {
  Data data;
  data.mutable_pose_graph();
  return data.SerializeAsString();
}

std::string EmptyOptions() {
  Data data;
  data.mutable_all_trajectory_builder_options();
  return data.SerializeAsString();
}

TEST(PbstreamReaderTest, RoundTrip) {
  const Pbstream example = ExamplePbstream();
  EXPECT_THAT(FindPbstreamProblems(example), IsEmpty());
  const std::string content = SerializePbstream(example);
  const auto loaded = ParsePbstream(content, "x.pbstream");
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->nodes.size(), 3);
  EXPECT_EQ(loaded->submaps.size(), 2);
  EXPECT_EQ(loaded->odometry_data.size(), 2);
  EXPECT_EQ(loaded->imu_data.size(), 2);
  EXPECT_EQ(loaded->fixed_frame_pose_data.size(), 1);
  EXPECT_EQ(loaded->landmark_data.size(), 1);
  EXPECT_EQ(loaded->trajectory_data.size(), 1);
  EXPECT_EQ(SerializePbstream(*loaded), content);
}

TEST(PbstreamReaderTest, GridsCanBeTakenOneByOne) {
  Pbstream example = ExamplePbstream();
  std::vector<std::string> taken;
  PbstreamReaderOptions options;
  options.take_grid =
      [&taken](const cartographer::mapping::proto::Submap& submap) {
        taken.push_back(submap.SerializeAsString());
      };
  auto loaded =
      ParsePbstream(SerializePbstream(example), "x.pbstream", options);
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  ASSERT_EQ(taken.size(), 2u);
  for (int i = 0; i != 2; ++i) {
    EXPECT_EQ(taken[i], example.submaps[i].SerializeAsString());
    const auto& grid = loaded->submaps[i].submap_2d().grid();
    EXPECT_EQ(grid.cells_size(), 0);
    EXPECT_EQ(
        grid.limits().SerializeAsString(),
        example.submaps[i].submap_2d().grid().limits().SerializeAsString());
  }
  // The rest is there.
  loaded->submaps = example.submaps;
  EXPECT_EQ(SerializePbstream(*loaded), SerializePbstream(example));
  // What is wrong with a grid is said of its record.
  example.submaps[1].mutable_submap_2d()->mutable_grid()->set_cells(0, 40000);
  ExpectError(Read(SerializePbstream(example), options),
              absl::StatusCode::kInvalidArgument,
              "submap (0, 1) has a cell with the value 40000");
  ExpectError(Read(SerializePbstream(example)),
              absl::StatusCode::kInvalidArgument, "record 4 at byte ");
}

TEST(PbstreamReaderTest, FilesOnDisk) {
  const std::string path = ::testing::TempDir() + "/pbstream_test.pbstream";
  ASSERT_TRUE(WritePbstream(ExamplePbstream(), path).ok());
  const auto loaded = ReadPbstream(path);
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(SerializePbstream(*loaded), SerializePbstream(ExamplePbstream()));
  PbstreamReaderOptions options;
  options.limits.max_file_size = 100;
  EXPECT_EQ(ReadPbstream(path, options).status().code(),
            absl::StatusCode::kResourceExhausted);
  std::remove(path.c_str());

  const auto missing = ReadPbstream("/nonexistent/file.pbstream");
  EXPECT_EQ(missing.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(missing.status().message()),
              HasSubstr("/nonexistent/file.pbstream"));
  EXPECT_FALSE(ReadPbstream(::testing::TempDir()).ok());
  EXPECT_FALSE(WritePbstream(ExamplePbstream(), "/nonexistent/file").ok());
}

TEST(PbstreamReaderTest, RecordsAreSerializedDataToOthers) {
  const std::string content = SerializePbstream(ExamplePbstream());
  PbstreamRecords records(content, "x");
  class NoLimit : public ContentLimit {
    int64_t For(absl::string_view, int64_t) const override {
      return int64_t{1} << 40;
    }
  };
  std::vector<int> kinds;
  std::string record;
  while (*records.Next(NoLimit(), &record)) {
    if (records.index() == 0) continue;
    Data data;
    ASSERT_TRUE(data.ParseFromString(record));
    kinds.push_back(data.data_case());
    EXPECT_EQ(data.SerializeAsString(), record);
  }
  EXPECT_THAT(kinds, ElementsAre(1, 2, 3, 3, 4, 4, 4, 5, 6, 6, 7, 7, 8, 9));
}

TEST(PbstreamReaderTest, Version1IsReadAndKept) {
  Pbstream example = ExamplePbstream();
  example.header.set_format_version(1);
  const auto loaded = ParsePbstream(SerializePbstream(example), "x");
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->header.format_version(), 1);
}

TEST(PbstreamReaderTest, UnknownRecordsAreCounted) {
  std::string content = SerializePbstream(ExamplePbstream());
  AppendPbstreamRecord("", &content);
  AppendPbstreamRecord("\xaa\x06\x01x", &content);  // field 101
  const auto loaded = ParsePbstream(content, "x");
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->num_unknown_records, 2);
}

TEST(PbstreamReaderTest, UnknownFieldsSurvive) {
  Pbstream example = ExamplePbstream();
  auto* const options = example.options.mutable_options_with_sensor_ids(0)
                            ->mutable_trajectory_builder_options();
  options->GetReflection()->MutableUnknownFields(options)->AddLengthDelimited(
      51966, "ours");
  const auto loaded = ParsePbstream(SerializePbstream(example), "x");
  ASSERT_TRUE(loaded.ok());
  const auto& again =
      loaded->options.options_with_sensor_ids(0).trajectory_builder_options();
  const auto& fields = again.GetReflection()->GetUnknownFields(again);
  ASSERT_EQ(fields.field_count(), 1);
  EXPECT_EQ(fields.field(0).length_delimited(), "ours");
}

TEST(PbstreamReaderTest, WhatIsNoPbstream) {
  ExpectError(Read(""), absl::StatusCode::kInvalidArgument, "is empty");
  ExpectError(Read("FLASER 180 1.0"), absl::StatusCode::kInvalidArgument,
              "is not a pbstream");
  ExpectError(Read("\xdb\x01\xf5"), absl::StatusCode::kInvalidArgument,
              "is not a pbstream");
}

TEST(PbstreamReaderTest, MissingParts) {
  ExpectError(Read(FileOf({})), absl::StatusCode::kDataLoss,
              "before its header");
  ExpectError(Read(FileOf({HeaderRecord(2)})), absl::StatusCode::kDataLoss,
              "before the pose graph");
  ExpectError(Read(FileOf({HeaderRecord(2), EmptyPoseGraph()})),
              absl::StatusCode::kDataLoss, "before the options");
  EXPECT_TRUE(
      Read(FileOf({HeaderRecord(2), EmptyPoseGraph(), EmptyOptions()})).ok());
}

TEST(PbstreamReaderTest, PartsOutOfOrder) {
  ExpectError(Read(FileOf({HeaderRecord(2), EmptyOptions(), EmptyPoseGraph()})),
              absl::StatusCode::kInvalidArgument,
              "record 1 at byte " +
                  std::to_string(FileOf({HeaderRecord(2)}).size()) +
                  ": the pose graph should be here");
  ExpectError(Read(FileOf({HeaderRecord(2), EmptyPoseGraph(), EmptyOptions(),
                           EmptyPoseGraph()})),
              absl::StatusCode::kInvalidArgument, "a second pose graph");
  ExpectError(Read(FileOf({HeaderRecord(2), EmptyPoseGraph(), EmptyOptions(),
                           EmptyOptions()})),
              absl::StatusCode::kInvalidArgument, "for a second time");
}

TEST(PbstreamReaderTest, Versions) {
  ExpectError(Read(FileOf({HeaderRecord(3)})), absl::StatusCode::kUnimplemented,
              "record 0 at byte 8: format version 3 is not supported");
  ExpectError(Read(FileOf({HeaderRecord(0)})), absl::StatusCode::kUnimplemented,
              "before Cartographer 1.0");
  // What older streams start with: field 1 is a message.
  ExpectError(Read(FileOf({EmptyPoseGraph() + "\x12\x01x"})),
              absl::StatusCode::kUnimplemented, "before Cartographer 1.0");
}

TEST(PbstreamReaderTest, ThreeDimensionalSubmaps) {
  Pbstream example = ExamplePbstream();
  example.submaps[1].clear_submap_2d();
  example.submaps[1].mutable_submap_3d()->set_finished(true);
  ExpectError(Read(SerializePbstream(example)),
              absl::StatusCode::kUnimplemented, "3D submap");
}

TEST(PbstreamReaderTest, EveryTruncationIsNoticed) {
  const std::string content = SerializePbstream(ExamplePbstream());
  // Where records end a shorter file is whole, up to what the graph promises.
  int whole = 0;
  for (size_t size = 0; size != content.size(); ++size) {
    const absl::Status status = Read(content.substr(0, size));
    if (status.ok()) ++whole;
  }
  // Nodes and submaps are missed by constraints; readings are not missed.
  EXPECT_EQ(whole, 7);
  ExpectError(Read(content.substr(0, content.size() - 5)),
              absl::StatusCode::kDataLoss, "the file ends after");
  ExpectError(Read(content.substr(0, 11)), absl::StatusCode::kDataLoss,
              "ends inside the size");
}

TEST(PbstreamReaderTest, CorruptCompression) {
  std::string content = FileOf({HeaderRecord(2), EmptyPoseGraph()});
  const size_t checksum = content.size() - 6;
  content[checksum] ^= 0x10;
  ExpectError(Read(content), absl::StatusCode::kDataLoss,
              "the compressed data is corrupt");

  std::string cut;
  cartographer::common::FastGzipString(HeaderRecord(2), &cut);
  const auto file_of = [](const std::string& compressed) {
    return std::string(PbstreamMagic()) + static_cast<char>(compressed.size()) +
           std::string(7, '\0') + compressed;
  };
  ExpectError(Read(file_of(cut.substr(0, cut.size() - 3))),
              absl::StatusCode::kDataLoss, "ends early");
  ExpectError(Read(file_of(cut + "more")), absl::StatusCode::kDataLoss,
              "followed by more");
  ExpectError(Read(file_of("")), absl::StatusCode::kDataLoss, "ends early");
}

TEST(PbstreamReaderTest, CorruptMessages) {
  const std::vector<std::string> start = {HeaderRecord(2), EmptyPoseGraph(),
                                          EmptyOptions()};
  const auto with = [&start](const std::string& record) {
    std::vector<std::string> records = start;
    records.push_back(record);
    return Read(FileOf(records));
  };
  ExpectError(with("\x22\x02\x0a\x05"), absl::StatusCode::kDataLoss,
              "the node in this record is corrupt");
  ExpectError(with("garbage"), absl::StatusCode::kDataLoss,
              "not a message of a serialized state");
  // Two messages in one record, a number in place of a message.
  Data node;
  node.mutable_node();
  ExpectError(with(node.SerializeAsString() + node.SerializeAsString()),
              absl::StatusCode::kDataLoss, "not a message");
  ExpectError(with("\x20\x01"), absl::StatusCode::kDataLoss, "not a message");
}

TEST(PbstreamReaderTest, ZipBombs) {
  // 8 MiB of zeros, 36 KiB compressed.
  std::string content = FileOf({HeaderRecord(2), EmptyPoseGraph(),
                                EmptyOptions(), std::string(8 << 20, '\0')});
  EXPECT_LT(content.size(), 40000);
  ExpectError(Read(content), absl::StatusCode::kResourceExhausted,
              "expands to more than the");

  // Submaps may be that empty, one by one but not all together.
  Pbstream example = ExamplePbstream();
  auto* const grid = example.submaps[0].mutable_submap_2d()->mutable_grid();
  grid->mutable_limits()->mutable_cell_limits()->set_num_x_cells(2000);
  grid->mutable_limits()->mutable_cell_limits()->set_num_y_cells(2000);
  grid->mutable_cells()->Resize(4000000, 0);
  content = SerializePbstream(example);
  EXPECT_TRUE(Read(content).ok()) << Read(content);
  PbstreamReaderOptions options;
  options.limits.total_floor = 1 << 20;
  ExpectError(Read(content, options), absl::StatusCode::kResourceExhausted,
              "the file expands to more than the");
  options = PbstreamReaderOptions();
  options.limits.max_record_size = 1 << 20;
  ExpectError(Read(content, options), absl::StatusCode::kResourceExhausted,
              "expands to more than the 1048576 bytes");
}

// Cells that have been seen cost more than their bytes: they are searched.
TEST(PbstreamReaderTest, GridBombs) {
  Pbstream example = ExamplePbstream();
  auto* const grid = example.submaps[0].mutable_submap_2d()->mutable_grid();
  const auto resize = [grid](const int size) {
    auto* const limits = grid->mutable_limits()->mutable_cell_limits();
    limits->set_num_x_cells(size);
    limits->set_num_y_cells(size);
    grid->mutable_cells()->Clear();
    grid->mutable_cells()->Resize(size * size, 100);
  };
  resize(1200);
  std::string content = SerializePbstream(example);
  EXPECT_TRUE(Read(content).ok()) << Read(content);
  resize(2000);
  content = SerializePbstream(example);
  EXPECT_LT(content.size(), 100000u);
  ExpectError(Read(content), absl::StatusCode::kResourceExhausted,
              absl::StrCat("with submap (0, 0) the grids have more than the ",
                           1500000 + 8 * content.size(), " known cells"));
  PbstreamReaderOptions options;
  options.limits.known_cells_floor = 4000000;
  EXPECT_TRUE(Read(content, options).ok());
}

// Two bytes of a file each, a hundred of memory.
TEST(PbstreamReaderTest, ObjectBombs) {
  using cartographer::mapping::proto::PoseGraph;
  for (const int field :
       {PoseGraph::kConstraintFieldNumber, PoseGraph::kLandmarkPosesFieldNumber,
        PoseGraph::kTrajectoryFieldNumber}) {
    std::string graph;
    for (int i = 0; i != 2000000; ++i) {
      graph += {static_cast<char>(field << 3 | 2), '\0'};
    }
    // 4000000 as a varint.
    const std::string size = {'\x80', '\x92', '\xf4', '\x01'};
    const std::string content =
        FileOf({HeaderRecord(2), "\x0a" + size + graph});
    PbstreamReaderOptions options;
    options.limits.max_expansion = 1 << 20;
    options.limits.max_total_expansion = 1 << 20;
    ExpectError(Read(content, options), absl::StatusCode::kResourceExhausted,
                "bytes of memory that are allowed for its size");
  }
}

TEST(PbstreamReaderTest, DevicesAreNotReadOn) {
  const auto zero = ReadPbstream("/dev/zero");
  EXPECT_EQ(zero.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(zero.status().message()), HasSubstr("magic number"));
}

TEST(PbstreamReaderTest, ValidationCanBeLeftOut) {
  Pbstream example = ExamplePbstream();
  example.nodes.clear();
  const std::string content = SerializePbstream(example);
  ExpectError(Read(content), absl::StatusCode::kInvalidArgument,
              "constraint 0 refers to node (0, 0), which does not exist (and");
  PbstreamReaderOptions options;
  options.validate = false;
  EXPECT_TRUE(Read(content, options).ok());
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
