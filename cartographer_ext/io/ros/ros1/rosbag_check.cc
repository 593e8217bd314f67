// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_check.h"

#ifdef CARTOGRAPHER_EXT_HAS_ROSBAG

#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "boost/iostreams/device/array.hpp"
#include "boost/iostreams/device/mapped_file.hpp"
#include "boost/iostreams/filter/bzip2.hpp"
#include "boost/iostreams/filtering_streambuf.hpp"
#include "roslz4/lz4s.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr uint32_t kMaxHeaderSize = 1 << 16;
constexpr uint32_t kMaxChunkSize = uint32_t{1} << 29;

enum Op : uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

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

// Header fields by name; values stay where they were read from.
class Fields {
 public:
  bool Parse(absl::string_view header) {
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

  absl::string_view Text(absl::string_view name) const {
    const auto it = fields_.find(name);
    return it == fields_.end() ? absl::string_view() : it->second;
  }

  // False unless the field is there and has the size of T.
  template <typename T>
  bool Number(absl::string_view name, T* value) const {
    const absl::string_view text = Text(name);
    if (text.size() != sizeof(T)) return false;
    std::memcpy(value, text.data(), sizeof(T));
    return true;
  }

 private:
  std::map<absl::string_view, absl::string_view> fields_;
};

struct Record {
  uint8_t op = 0;
  Fields header;
  absl::string_view data;
};

bool TakeRecord(absl::string_view* rest, Record* record) {
  absl::string_view header;
  return TakeBlock(rest, &header) && header.size() <= kMaxHeaderSize &&
         record->header.Parse(header) &&
         record->header.Number("op", &record->op) &&
         TakeBlock(rest, &record->data);
}

// Decompresses to exactly `size` bytes.
bool Decompress(absl::string_view compression, absl::string_view data,
                uint32_t size, std::vector<char>* to) {
  namespace streams = boost::iostreams;
  to->resize(size);
  if (compression == "bz2") {
    streams::filtering_istreambuf stream;
    stream.push(streams::bzip2_decompressor());
    stream.push(streams::array_source(data.data(), data.size()));
    return stream.sgetn(to->data(), size) == static_cast<int64_t>(size);
  }
  if (compression == "lz4") {
    // The library takes a pointer to memory it does not change.
    unsigned int output_size = size;
    return roslz4_buffToBuffDecompress(const_cast<char*>(data.data()),
                                       static_cast<unsigned int>(data.size()),
                                       to->data(), &output_size) == ROSLZ4_OK &&
           output_size == size;
  }
  return false;
}

class Checker {
 public:
  explicit Checker(absl::string_view file) : file_(file) {}

  // Empty when sound, else what is wrong.
  std::string Check();

 private:
  std::string CheckFileHeader(const Record& record);
  std::string CheckChunk(const Record& record);
  std::string CheckIndex(const Record& record);
  std::string CheckChunkInfo(const Record& record);
  static std::string CheckConnection(const Record& record);

  const absl::string_view file_;
  uint64_t index_position_ = 0;
  bool index_position_seen_ = false;
  // Of the chunk before: messages by offset, and their connections.
  std::map<uint32_t, uint32_t> messages_;
  std::map<uint64_t, uint32_t> chunks_;  // number of index records, by offset
  uint32_t* num_indices_ = nullptr;
  std::vector<char> decompressed_;
};

std::string Checker::CheckFileHeader(const Record& record) {
  uint32_t unused;
  if (!record.header.Number("index_pos", &index_position_) ||
      !record.header.Number("conn_count", &unused) ||
      !record.header.Number("chunk_count", &unused)) {
    return "the file header lacks fields";
  }
  if (!record.header.Text("encryptor").empty()) return "the bag is encrypted";
  if (index_position_ == 0) {
    return "the bag was not finished and has no index; \"rosbag reindex\" "
           "makes one";
  }
  return "";
}

std::string Checker::CheckConnection(const Record& record) {
  Fields data;
  uint32_t unused;
  if (!record.header.Number("conn", &unused) ||
      record.header.Text("topic").empty() || !data.Parse(record.data) ||
      data.Text("type").empty() || data.Text("md5sum").empty()) {
    return "a damaged connection record";
  }
  return "";
}

std::string Checker::CheckChunk(const Record& record) {
  uint32_t size;
  if (!record.header.Number("size", &size) || size > kMaxChunkSize) {
    return "a chunk of invalid size";
  }
  const absl::string_view compression = record.header.Text("compression");
  absl::string_view content = record.data;
  if (compression == "none") {
    if (content.size() != size) return "a chunk of wrong size";
  } else {
    if (compression != "bz2" && compression != "lz4") {
      return "a chunk of unknown compression";
    }
    if (!Decompress(compression, record.data, size, &decompressed_)) {
      return "a chunk that cannot be decompressed";
    }
    content = absl::string_view(decompressed_.data(), size);
  }
  messages_.clear();
  const char* const begin = content.data();
  while (!content.empty()) {
    const uint32_t offset = static_cast<uint32_t>(content.data() - begin);
    Record inner;
    if (!TakeRecord(&content, &inner)) return "a damaged record in a chunk";
    if (inner.op == kMessage) {
      uint32_t connection;
      uint64_t unused;
      if (!inner.header.Number("conn", &connection) ||
          !inner.header.Number("time", &unused)) {
        return "a damaged message record";
      }
      messages_[offset] = connection;
    } else if (inner.op == kConnection) {
      const std::string problem = CheckConnection(inner);
      if (!problem.empty()) return problem;
    } else {
      return "a chunk with records that do not belong there";
    }
  }
  return "";
}

std::string Checker::CheckIndex(const Record& record) {
  constexpr size_t kEntrySize = 12;  // seconds, nanoseconds, offset
  uint32_t version, connection, count;
  if (num_indices_ == nullptr || !record.header.Number("ver", &version) ||
      !record.header.Number("conn", &connection) ||
      !record.header.Number("count", &count) || version != 1 ||
      record.data.size() != kEntrySize * count) {
    return "a damaged index record";
  }
  ++*num_indices_;
  absl::string_view rest = record.data;
  while (!rest.empty()) {
    uint32_t seconds, nanoseconds, offset;
    TakeNumber(&rest, &seconds);
    TakeNumber(&rest, &nanoseconds);
    TakeNumber(&rest, &offset);
    const auto message = messages_.find(offset);
    if (message == messages_.end() || message->second != connection) {
      return "an index entry that points to no message";
    }
  }
  return "";
}

std::string Checker::CheckChunkInfo(const Record& record) {
  constexpr size_t kEntrySize = 8;  // connection, number of messages
  uint32_t version, count;
  uint64_t position, unused;
  if (!record.header.Number("ver", &version) || version != 1 ||
      !record.header.Number("chunk_pos", &position) ||
      !record.header.Number("start_time", &unused) ||
      !record.header.Number("end_time", &unused) ||
      !record.header.Number("count", &count) ||
      record.data.size() != kEntrySize * count) {
    return "a damaged chunk summary";
  }
  const auto chunk = chunks_.find(position);
  if (chunk == chunks_.end()) return "a summary of a chunk that is not there";
  if (chunk->second < count) return "a chunk whose index is incomplete";
  return "";
}

std::string Checker::Check() {
  absl::string_view rest = file_;
  if (!absl::StartsWith(rest, "#ROSBAG V")) return "not a ROS 1 bag";
  if (!absl::StartsWith(rest, kMagic)) {
    return "only bags of format 2.0 are read; \"rosbag fix\" converts others";
  }
  rest.remove_prefix(sizeof(kMagic) - 1);
  bool first = true;
  while (!rest.empty()) {
    const uint64_t position = rest.data() - file_.data();
    if (position == index_position_) index_position_seen_ = true;
    Record record;
    std::string problem;
    if (!TakeRecord(&rest, &record)) {
      problem = "a damaged or truncated record";
    } else if (first != (record.op == kFileHeader)) {
      problem = "no file header at the beginning";
    } else if (record.op == kFileHeader) {
      problem = CheckFileHeader(record);
    } else if (record.op == kChunk) {
      problem = CheckChunk(record);
      num_indices_ = &chunks_[position];
    } else if (record.op == kIndex) {
      problem = CheckIndex(record);
    } else if (record.op == kConnection) {
      problem = CheckConnection(record);
    } else if (record.op == kChunkInfo) {
      problem = CheckChunkInfo(record);
    } else {
      problem = "a record of unknown kind";
    }
    if (!problem.empty()) {
      return absl::StrCat("at byte ", position, ": ", problem);
    }
    // Indices follow their chunk directly.
    if (record.op != kChunk && record.op != kIndex) num_indices_ = nullptr;
    first = false;
  }
  if (first) return "the bag is empty";
  // A bag without any message has its index at its end.
  if (index_position_ == file_.size()) index_position_seen_ = true;
  return index_position_seen_ ? "" : "the index is not where the header says";
}

}  // namespace

absl::Status CheckRosbag(const std::string& filename) {
  std::string problem;
  try {
    const boost::iostreams::mapped_file_source file(filename);
    problem = Checker(absl::string_view(file.data(), file.size())).Check();
  } catch (const std::exception& exception) {
    problem = exception.what();
  }
  if (problem.empty()) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat(filename, ": ", problem));
}

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_HAS_ROSBAG
