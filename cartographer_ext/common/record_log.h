// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records written while a program runs, so that they are there when it is
// killed: <directory>/<stem>-<number>.csv as a table and .pb as messages. The
// number is the first that is free; nothing is overwritten.
#ifndef CARTOGRAPHER_EXT_COMMON_RECORD_LOG_H_
#define CARTOGRAPHER_EXT_COMMON_RECORD_LOG_H_

#include <fstream>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {

// One thread at a time.
class RecordLog {
 public:
  // Writes nothing without a directory, which is made where its parent exists.
  // `head` is the first line of the table, ended.
  RecordLog(const std::string& directory, const std::string& stem,
            absl::string_view head);
  RecordLog(const RecordLog&) = delete;
  RecordLog& operator=(const RecordLog&) = delete;

  // Whether anything is written; false after an error.
  bool is_on() const { return table_.is_open(); }
  // OK, or why the log was closed; it names the file.
  const absl::Status& status() const { return status_; }
  // Of the table.
  const std::string& filename() const { return filename_; }

  // Lines of the table and the same as bytes; both are on disk when it returns.
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
