// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_records.h"

#include <algorithm>
#include <exception>
#include <istream>
#include <utility>

#include "absl/status/status.h"
#include "boost/iostreams/device/array.hpp"
#include "boost/iostreams/filter/bzip2.hpp"
#include "boost/iostreams/filtering_stream.hpp"
#include "cartographer_ext/io/ros/mcap_format.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr uint32_t kMaxHeaderSize = 1 << 16;
constexpr uint32_t kMaxChunkSize = uint32_t{1} << 29;

bool TakeNumber(absl::string_view* rest, uint32_t* number) {
  if (rest->size() < sizeof(*number)) return false;
  std::memcpy(number, rest->data(), sizeof(*number));
  rest->remove_prefix(sizeof(*number));
  return true;
}

// A length and as many bytes.
bool TakeBlock(absl::string_view* rest, absl::string_view* block) {
  uint32_t length;
  if (!TakeNumber(rest, &length) || length > rest->size()) return false;
  *block = rest->substr(0, length);
  rest->remove_prefix(length);
  return true;
}

// Memory grows with what really comes out, up to `size`; false unless it is
// exactly that.
bool Bunzip(absl::string_view data, const uint32_t size, std::string* to) {
  namespace streams = boost::iostreams;
  constexpr size_t kStep = size_t{1} << 18;
  to->clear();
  try {
    streams::filtering_istream stream;
    stream.push(streams::bzip2_decompressor());
    stream.push(streams::array_source(data.data(), data.size()));
    while (to->size() < size) {
      const size_t before = to->size();
      const size_t step = std::min<size_t>(kStep, size - before);
      to->resize(before + step);
      stream.read(&(*to)[before], static_cast<std::streamsize>(step));
      if (static_cast<size_t>(stream.gcount()) != step) return false;
    }
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

}  // namespace

bool RosbagFields::Parse(absl::string_view header) {
  fields_.clear();
  while (!header.empty()) {
    absl::string_view field;
    if (!TakeBlock(&header, &field)) return false;
    const size_t equals = field.find('=');
    if (equals == absl::string_view::npos) return false;
    fields_[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return true;
}

absl::string_view RosbagFields::Text(absl::string_view name) const {
  const auto it = fields_.find(name);
  return it == fields_.end() ? absl::string_view() : it->second;
}

bool TakeRosbagRecord(absl::string_view* rest, RosbagRecord* record) {
  absl::string_view header;
  return TakeBlock(rest, &header) && header.size() <= kMaxHeaderSize &&
         record->header.Parse(header) &&
         record->header.Number("op", &record->op) &&
         TakeBlock(rest, &record->data);
}

bool RosbagRecordIsCutOff(absl::string_view bytes) {
  uint32_t length;
  if (!TakeNumber(&bytes, &length)) return true;
  if (length > kMaxHeaderSize) return false;
  if (length > bytes.size()) return true;
  bytes.remove_prefix(length);
  return !TakeNumber(&bytes, &length) || length > bytes.size();
}

bool StartsLikeRosbagRecord(absl::string_view bytes) {
  if (bytes.empty()) return true;
  absl::string_view header;
  RosbagFields fields;
  uint8_t op;
  return TakeBlock(&bytes, &header) && header.size() <= kMaxHeaderSize &&
         fields.Parse(header) && fields.Number("op", &op) &&
         op >= kRosbagMessage && op <= kRosbagConnection;
}

absl::StatusOr<absl::string_view> RosbagChunkContent(const RosbagRecord& chunk,
                                                     std::string* memory) {
  uint32_t size;
  if (!chunk.header.Number("size", &size) || size > kMaxChunkSize) {
    return absl::DataLossError("a chunk of invalid size");
  }
  const absl::string_view compression = chunk.header.Text("compression");
  if (compression == "none") {
    if (chunk.data.size() != size) {
      return absl::DataLossError("a chunk of wrong size");
    }
    return chunk.data;
  }
  if (compression == "bz2") {
    if (!Bunzip(chunk.data, size, memory)) {
      return absl::DataLossError("a chunk that cannot be decompressed");
    }
  } else if (compression == "lz4") {
    auto content = McapDecompress("lz4", chunk.data, size);
    if (!content.ok()) return content.status();
    *memory = std::move(*content);
  } else {
    return absl::DataLossError("a chunk of unknown compression");
  }
  return absl::string_view(*memory);
}

}  // namespace io
}  // namespace cartographer_ext
