// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Journal of finished work: one line of JSON per item, appended and flushed to
// disk immediately, so that an interrupted command can be resumed.
//
// The first line identifies the kind of work and its dependencies. A power
// failure or kill -9 can leave an incomplete last line, which is removed; an
// incomplete line anywhere else is an error. A lock keeps two commands from
// writing into one journal.
#ifndef CARTOGRAPHER_EXT_IO_LINE_JOURNAL_H_
#define CARTOGRAPHER_EXT_IO_LINE_JOURNAL_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace io {

// The expected kind of a journal, and the texts of the errors for a different
// one.
struct JournalKind {
  std::string key;     // of the version in the first line, the command's name
  std::string name;    // "tuning journal"
  std::string writer;  // "search"
  std::string cause;   // what differs where the fingerprint does
};

class LineJournal {
 public:
  // Called for each line behind the first, in order; its errors are reported
  // with file and line.
  using Reader = std::function<absl::Status(const nlohmann::json&)>;

  // Opens or starts the journal. `fingerprint` identifies what the lines depend
  // on; a journal of another fingerprint is an error. Errors name the file, and
  // the line where there is one. With an empty name the journal is not stored.
  static absl::StatusOr<std::unique_ptr<LineJournal>> Open(
      const std::string& filename, const JournalKind& kind,
      const std::string& fingerprint, const Reader& reader);
  ~LineJournal();
  LineJournal(const LineJournal&) = delete;
  LineJournal& operator=(const LineJournal&) = delete;

  // Whether an incomplete last line was removed.
  bool was_torn() const { return was_torn_; }

  // On disk if it returns OK.
  absl::Status Append(const nlohmann::ordered_json& line);

 private:
  LineJournal(std::string filename, int descriptor);
  absl::Status ReadAll(const JournalKind& kind, const std::string& fingerprint,
                       const Reader& reader);
  absl::Status WriteLine(const std::string& line);

  const std::string filename_;
  const int descriptor_;  // -1: not kept
  bool was_torn_ = false;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_LINE_JOURNAL_H_
