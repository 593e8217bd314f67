// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The MCAP container, version 0, according to its published specification:
//
//   magic, records, magic;  record: opcode (uint8), length (uint64), content
//
// Little endian; strings and byte arrays have a uint32 length in front (the
// records of a chunk a uint64). Messages belong to channels (topic, encoding)
// and channels to schemas (message type); they are at the top level or,
// usually, in chunks, which may be compressed. Everything else (indexes,
// summary, attachments) is for random access and not needed for sequential
// reading.
#ifndef CARTOGRAPHER_EXT_IO_ROS_MCAP_FORMAT_H_
#define CARTOGRAPHER_EXT_IO_ROS_MCAP_FORMAT_H_

#include <cstdint>
#include <cstring>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace io {

constexpr char kMcapMagic[] = "\x89MCAP0\r\n";
constexpr size_t kMcapMagicSize = 8;
// Opcode and length.
constexpr size_t kMcapRecordHeadSize = 9;

enum McapOpcode : uint8_t {
  kMcapHeader = 0x01,
  kMcapFooter = 0x02,
  kMcapSchema = 0x03,
  kMcapChannel = 0x04,
  kMcapMessage = 0x05,
  kMcapChunk = 0x06,
  kMcapMessageIndex = 0x07,
  kMcapChunkIndex = 0x08,
  kMcapStatistics = 0x0b,
  kMcapDataEnd = 0x0f,
};

// Takes little-endian fields off the front of a record; once one is missing,
// all are zero and ok() is false.
class McapFields {
 public:
  explicit McapFields(absl::string_view data) : rest_(data) {}

  template <typename T>
  T Take() {
    T value{};
    if (!ok_ || rest_.size() < sizeof(T)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return value;
  }
  absl::string_view TakeBytes(uint64_t size) {
    if (!ok_ || rest_.size() < size) {
      ok_ = false;
      return {};
    }
    const absl::string_view bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return bytes;
  }
  absl::string_view TakeString() { return TakeBytes(Take<uint32_t>()); }
  absl::string_view rest() const { return rest_; }
  bool ok() const { return ok_; }

 private:
  absl::string_view rest_;
  bool ok_ = true;
};

// The records of a chunk: `compression` is "", "lz4" (frames) or "zstd". Memory
// grows with the actual output, up to `size`, and at most to 1 GiB. Errors do
// not name the file.
absl::StatusOr<std::string> McapDecompress(absl::string_view compression,
                                           absl::string_view data,
                                           uint64_t size);
// The inverse. Unknown compressions are errors.
absl::StatusOr<std::string> McapCompress(const std::string& compression,
                                         absl::string_view data);
// CRC-32 as zlib computes it.
uint32_t McapChecksum(absl::string_view data);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_MCAP_FORMAT_H_
