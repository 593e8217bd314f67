// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Lines of a text file, plain or compressed by gzip, bzip2 or xz (recognised by the
// content, not by the name), in bounded memory.
#ifndef CARTOGRAPHER_EXT_IO_LINE_READER_H_
#define CARTOGRAPHER_EXT_IO_LINE_READER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <streambuf>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {

// Decompressed content of `filename`, within its ExpansionBudget; reading the stream buffer may throw on
// damaged compressed data, so use LineReader or ReadFile where possible.
absl::StatusOr<std::unique_ptr<std::streambuf>> OpenDecompressed(
    const std::string& filename);

class LineReader {
 public:
  // Longer lines are truncated; `truncated` is set.
  static constexpr size_t kMaxLineLength = 1 << 20;
  // Longer input is not text, but for example an endless device.
  static constexpr size_t kMaxSkippedLength = 64 << 20;

  static absl::StatusOr<std::unique_ptr<LineReader>> Open(
      const std::string& filename);

  // False at the end of the file. The view lives until the next call; line
  // ends (LF or CR LF) and a byte order mark are stripped. Damaged or truncated
  // compressed data (DataLoss, behind all whole lines that could be
  // decompressed), data that expand too much, lines beyond kMaxSkippedLength
  // and read errors are errors naming the file.
  absl::StatusOr<bool> Next(absl::string_view* line);

  // Of the line last returned, from 1.
  int64_t line_number() const { return line_number_; }
  bool truncated() const { return truncated_; }
  // Whether the file ended without a line end behind it.
  bool unterminated() const { return unterminated_; }
  const std::string& filename() const { return filename_; }
  // "file:12", for messages.
  std::string Location() const;

 private:
  LineReader(const std::string& filename,
             std::unique_ptr<std::streambuf> content);
  // Moves the rest of the buffer to its front and reads more behind it.
  absl::Status Fill();

  const std::string filename_;
  std::unique_ptr<std::streambuf> content_;
  std::vector<char> buffer_;
  size_t begin_ = 0;  // unread part of `buffer_`
  size_t end_ = 0;
  bool at_end_ = false;
  bool truncated_ = false;
  bool unterminated_ = false;
  int64_t line_number_ = 0;
};

// The whole decompressed content; an error above `max_size` bytes.
absl::StatusOr<std::string> ReadFile(const std::string& filename,
                                     size_t max_size);

// Calls `parse` with the words of every line of a text file, but for empty
// lines and comments (#). Its error ends the reading and is returned behind
// file and line.
absl::Status ForEachRecord(const std::string& filename,
                           const std::function<absl::Status(Tokens*)>& parse);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_LINE_READER_H_
