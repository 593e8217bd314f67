// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records written while a program runs, so that they survive if it is killed:
// <directory>/<stem>-<number>.csv as a table and .pb as messages. The number is
// the first unused one; nothing is overwritten.
#ifndef CARTOGRAPHER_EXT_COMMON_RECORD_LOG_H_
#define CARTOGRAPHER_EXT_COMMON_RECORD_LOG_H_

#include <fstream>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {

// Writes records as a table and as messages. Not thread-safe.
class RecordLog {
 public:
  // Writes nothing if `directory` is empty; it is created if its parent exists.
  // `head` is the first line of the table, with its line break.
  RecordLog(const std::string& directory, const std::string& stem,
            absl::string_view head);
  RecordLog(const RecordLog&) = delete;
  RecordLog& operator=(const RecordLog&) = delete;

  // Whether anything is written; false after an error.
  bool is_on() const { return table_.is_open(); }
  // OK, or why the log was closed; it names the file.
  const absl::Status& status() const { return status_; }
  // Name of the table.
  const std::string& filename() const { return filename_; }

  // Appends lines to the table and the same records as bytes; both are on disk
  // on return.
  void Append(absl::string_view lines, absl::string_view bytes);

 private:
  void Close(const std::string& filename);

  std::string filename_;
  std::ofstream table_;
  std::ofstream messages_;
  absl::Status status_;
};

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_RECORD_LOG_H_
