// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_records.h"

#include <zlib.h>

#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer/common/port.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kNumberSize = 8;
constexpr size_t kChunkSize = 1 << 16;

// Ends the expansion on every return path.
class Inflater {
 public:
  explicit Inflater(absl::string_view compressed) {
    std::memset(&stream_, 0, sizeof(stream_));
    // zlib does not write to its input.
    stream_.next_in =
        reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
    stream_.avail_in = static_cast<uInt>(compressed.size());
    // 15: the largest window; 16: a gzip header and trailer, nothing else.
    result_ = inflateInit2(&stream_, 15 + 16);
  }
  ~Inflater() { inflateEnd(&stream_); }

  // Appends up to a chunk to `data`; false when there is no more.
  bool AppendChunk(std::string* data) {
    if (result_ != Z_OK) return false;
    // Most records are much shorter: enlarging `data` would clear it each time.
    static thread_local std::vector<char> chunk(kChunkSize);
    stream_.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream_.avail_out = kChunkSize;
    result_ = inflate(&stream_, Z_NO_FLUSH);
    data->append(chunk.data(), kChunkSize - stream_.avail_out);
    return true;
  }
  bool complete() const { return result_ == Z_STREAM_END; }
  // Z_BUF_ERROR: the input ended before the member did.
  bool input_is_short() const { return result_ == Z_BUF_ERROR; }
  bool has_surplus() const { return stream_.avail_in > 0; }

 private:
  z_stream stream_;
  int result_;
};

uint64_t NumberAt(absl::string_view bytes) {
  uint64_t number = 0;
  for (size_t i = kNumberSize; i > 0; --i) {
    number = number << 8 | static_cast<unsigned char>(bytes[i - 1]);
  }
  return number;
}

}  // namespace

absl::string_view PbstreamMagic() {
  return absl::string_view("\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b", kNumberSize);
}

absl::StatusOr<std::string> ExpandGzipMember(absl::string_view compressed,
                                             const ContentLimit& limit) {
  if (compressed.size() >> 31 != 0) {
    return absl::ResourceExhaustedError("the record is larger than 2 GiB");
  }
  Inflater inflater(compressed);
  std::string data;
  int64_t max_size = -1;
  while (inflater.AppendChunk(&data)) {
    if (max_size < 0) {
      max_size = limit.For(data, static_cast<int64_t>(compressed.size()));
    }
    if (static_cast<int64_t>(data.size()) > max_size) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("the record of %d bytes expands to more than the %d "
                          "bytes that are allowed",
                          compressed.size(), max_size));
    }
  }
  if (!inflater.complete()) {
    return absl::DataLossError(inflater.input_is_short()
                                   ? "the compressed data ends early"
                                   : "the compressed data is corrupt");
  }
  if (inflater.has_surplus()) {
    return absl::DataLossError("the compressed data is followed by more");
  }
  return data;
}

PbstreamRecords::PbstreamRecords(absl::string_view content, std::string name)
    : content_(content), name_(std::move(name)) {
  const absl::string_view magic = PbstreamMagic();
  if (content_.empty()) {
    status_ = absl::InvalidArgumentError(absl::StrCat(name_, ": is empty"));
  } else if (content_.substr(0, magic.size()) != magic) {
    status_ = absl::InvalidArgumentError(
        absl::StrCat(name_, ": is not a pbstream (wrong magic number)"));
  }
  position_ = magic.size();
}

absl::StatusOr<bool> PbstreamRecords::Skip() {
  if (!status_.ok()) return status_;
  if (position_ == content_.size()) return false;
  ++index_;
  record_position_ = position_;
  size_t left = content_.size() - position_;
  if (left < kNumberSize) {
    return Error(absl::StatusCode::kDataLoss,
                 "the file ends inside the size of the record");
  }
  const uint64_t size = NumberAt(content_.substr(position_));
  position_ += kNumberSize;
  left -= kNumberSize;
  if (size > left) {
    return Error(absl::StatusCode::kDataLoss,
                 absl::StrFormat("the record should have %d bytes, but the "
                                 "file ends after %d",
                                 size, left));
  }
  position_ += size;
  return true;
}

absl::StatusOr<bool> PbstreamRecords::Next(const ContentLimit& limit,
                                           std::string* data) {
  const absl::StatusOr<bool> more = Skip();
  if (!more.ok() || !*more) return more;
  auto expanded = ExpandGzipMember(bytes().substr(kNumberSize), limit);
  if (!expanded.ok()) {
    return Error(expanded.status().code(), expanded.status().message());
  }
  *data = *std::move(expanded);
  return true;
}

absl::Status PbstreamRecords::Error(absl::StatusCode code,
                                    absl::string_view message) const {
  return absl::Status(
      code, absl::StrFormat("%s: record %d at byte %d: %s", name_, index_,
                            record_position_, message));
}

void AppendPbstreamRecord(const std::string& data, std::string* content) {
  std::string compressed;
  cartographer::common::FastGzipString(data, &compressed);
  uint64_t size = compressed.size();
  for (size_t i = 0; i != kNumberSize; ++i) {
    content->push_back(static_cast<char>(size & 0xff));
    size >>= 8;
  }
  content->append(compressed);
}

}  // namespace io
}  // namespace cartographer_ext
