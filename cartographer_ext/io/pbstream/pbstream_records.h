// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The layer below messages: a magic number, then per record the size of its
// compressed form (8 bytes, little-endian, as all numbers) and one gzip member.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_RECORDS_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_RECORDS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace io {

// The first 8 bytes of every file.
absl::string_view PbstreamMagic();

// Limit of the expanded size of a record.
class ContentLimit {
 public:
  virtual ~ContentLimit() = default;
  // Bytes, for a record with this compressed size and these first bytes of its
  // content (up to 64 KiB).
  virtual int64_t For(absl::string_view beginning,
                      int64_t compressed_size) const = 0;
};

// Expands exactly one gzip member. DataLoss for broken, incomplete or surplus
// data; ResourceExhausted when it is larger than `limit` allows, which it never
// exceeds by more than 64 KiB.
absl::StatusOr<std::string> ExpandGzipMember(absl::string_view compressed,
                                             const ContentLimit& limit);

// Iterates over the records of a file in memory.
class PbstreamRecords {
 public:
  // `content` must remain valid. Check status() first: the magic number may be
  // wrong.
  PbstreamRecords(absl::string_view content, std::string name);

  const absl::Status& status() const { return status_; }

  // False at the end of the file.
  absl::StatusOr<bool> Next(const ContentLimit& limit, std::string* data);
  // The same without expanding the record.
  absl::StatusOr<bool> Skip();

  // An error about the record that Next has last been asked for.
  absl::Status Error(absl::StatusCode code, absl::string_view message) const;

  // Of that record; -1 before the first.
  int64_t index() const { return index_; }
  // That record in the file, with its size.
  absl::string_view bytes() const {
    return content_.substr(record_position_, position_ - record_position_);
  }

 private:
  const absl::string_view content_;
  const std::string name_;
  absl::Status status_;
  size_t position_ = 0;         // where the next record starts
  size_t record_position_ = 0;  // where the current one started
  int64_t index_ = -1;
};

// Appends one record to a file in memory.
void AppendPbstreamRecord(const std::string& data, std::string* content);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_RECORDS_H_
