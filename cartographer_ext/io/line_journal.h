// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What has been done, on disk: a line of JSON for each finished piece of work,
// appended and flushed to the disk at once, so that a command that is started
// again goes on where it was killed.
//
// The first line says what kind of work it is and what it depends on. A power
// cut or kill -9 can leave half a line at the end, which is cut off; half a line
// anywhere else is an error. A lock keeps two commands from writing into one
// journal.
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

// What a journal must be of, and the words of the errors where it is not.
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
  // the line where there is one. An empty name gives a journal that is not kept.
  static absl::StatusOr<std::unique_ptr<LineJournal>> Open(
      const std::string& filename, const JournalKind& kind,
      const std::string& fingerprint, const Reader& reader);
  ~LineJournal();
  LineJournal(const LineJournal&) = delete;
  LineJournal& operator=(const LineJournal&) = delete;

  // Whether half a line was cut off its end.
  bool was_torn() const { return was_torn_; }

  // On disk when it returns OK.
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
