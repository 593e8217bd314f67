// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/io/internal/submap_record.h"

#include <functional>
#include <memory>
#include <string>

#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace io {
namespace {

using mapping::SubmapId;

std::string Record(const SubmapId& id, const mapping::Submap2D& submap) {
  std::string bytes;
  WriteSubmapRecord(id, submap,
                    [&bytes](const std::string& piece) { bytes += piece; });
  return bytes;
}

std::string Message(const SubmapId& id, const mapping::Submap2D& submap) {
  mapping::proto::SerializedData message;
  *message.mutable_submap() = submap.ToProto(true);
  id.ToProto(message.mutable_submap()->mutable_submap_id());
  return message.SerializeAsString();
}

TEST(SubmapRecordTest, IsTheSerializedMessage) {
  mapping::ValueConversionTables tables;
  const SubmapId id(3, 300);
  mapping::Submap2D submap(Eigen::Vector2f(1.f, -2.f),
                           mapping::test::RoomGrid(&tables, 0.05, 5), &tables);
  EXPECT_EQ(Record(id, submap), Message(id, submap));
  submap.Finish();
  EXPECT_EQ(Record(id, submap), Message(id, submap));
  // Nothing but unknown cells, and default values, which take no bytes.
  const mapping::Submap2D empty(
      Eigen::Vector2f::Zero(),
      std::make_unique<mapping::ProbabilityGrid>(
          mapping::MapLimits(0.05, Eigen::Vector2d(1., 1.),
                             mapping::CellLimits(300, 400)),
          &tables),
      &tables);
  EXPECT_EQ(Record(SubmapId(0, 0), empty), Message(SubmapId(0, 0), empty));
}

// Compressed in pieces the text is as compressed in one.
TEST(SubmapRecordTest, PiecesAreCompressedAsOne) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += std::to_string(i % 977 * (i % 31));
  std::string whole;
  common::FastGzipString(text, &whole);
  for (const size_t size : {1000, 65536, 10000000}) {
    std::string pieces;
    common::FastGzipPieces(
        [&](const std::function<void(const std::string&)>& write) {
          for (size_t i = 0; i < text.size(); i += size) {
            write(text.substr(i, size));
          }
        },
        &pieces);
    EXPECT_EQ(pieces, whole);
    std::string back;
    common::FastGunzipString(pieces, &back);
    EXPECT_EQ(back, text);
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer
