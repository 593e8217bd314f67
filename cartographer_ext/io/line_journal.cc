// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/line_journal.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/io/bounded_json.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr int kJournalVersion = 1;
// A line holds a record with fields that are scalars or lists of them.
constexpr int kMaxDepth = 3;

absl::Status JournalError(const std::string& filename,
                          const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(filename, ": ", what));
}

absl::Status JournalSystemError(const std::string& filename, const int error) {
  return JournalError(filename, strerror(error));
}

std::string JournalLine(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false,
                   nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

}  // namespace

LineJournal::LineJournal(std::string filename, const int descriptor)
    : filename_(std::move(filename)), descriptor_(descriptor) {}

LineJournal::~LineJournal() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::StatusOr<std::unique_ptr<LineJournal>> LineJournal::Open(
    const std::string& filename, const JournalKind& kind,
    const std::string& fingerprint, const Reader& reader) {
  if (filename.empty()) {
    return std::unique_ptr<LineJournal>(new LineJournal(filename, -1));
  }
  const int descriptor =
      open(filename.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return JournalSystemError(filename, errno);
  std::unique_ptr<LineJournal> journal(new LineJournal(filename, descriptor));
  struct stat state;
  if (fstat(descriptor, &state) != 0)
    return JournalSystemError(filename, errno);
  if (!S_ISREG(state.st_mode))
    return JournalError(filename, "not a plain file");
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return JournalError(filename, errno == EWOULDBLOCK
                                      ? absl::StrCat("another ", kind.writer,
                                                     " is writing to it")
                                      : std::string(strerror(errno)));
  }
  const absl::Status status = journal->ReadAll(kind, fingerprint, reader);
  if (!status.ok()) return status;
  return journal;
}

absl::Status LineJournal::ReadAll(const JournalKind& kind,
                                  const std::string& fingerprint,
                                  const Reader& reader) {
  std::string content;
  char buffer[65536];
  while (true) {
    const ssize_t count = pread(descriptor_, buffer, sizeof(buffer),
                                static_cast<off_t>(content.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return JournalSystemError(filename_, errno);
    if (count == 0) break;
    content.append(buffer, static_cast<size_t>(count));
  }
  const size_t whole = content.rfind('\n') + 1;  // 0 when there is none
  // A file that is not a journal is never truncated.
  const std::string begin_of_all = absl::StrCat("{\"", kind.key, "\":");
  const size_t common = std::min(content.size(), begin_of_all.size());
  if (content.compare(0, common, begin_of_all, 0, common) != 0) {
    return JournalError(filename_, absl::StrCat("line 1: not a ", kind.name));
  }
  int line_number = 0;
  for (size_t begin = 0; begin < whole;) {
    const size_t end = content.find('\n', begin);
    const auto json = ParseBoundedJson(
        absl::string_view(content).substr(begin, end - begin), kMaxDepth);
    ++line_number;
    begin = end + 1;
    if (line_number == 1) {
      if (!json.is_object() || !json.contains(kind.key) ||
          !json.contains("fingerprint")) {
        return JournalError(filename_,
                            absl::StrCat("line 1: not a ", kind.name));
      }
      if (json[kind.key] != kJournalVersion) {
        return JournalError(filename_, "line 1: of another version");
      }
      if (json["fingerprint"] != fingerprint) {
        return JournalError(filename_,
                            absl::StrCat("is of another ", kind.writer, ": ",
                                         kind.cause, "; use another journal"));
      }
      continue;
    }
    const absl::Status status = reader(json);
    if (!status.ok()) {
      return JournalError(filename_, absl::StrCat("line ", line_number, ": ",
                                                  status.message()));
    }
  }
  if (whole < content.size()) {
    was_torn_ = true;
    if (ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) {
      return JournalSystemError(filename_, errno);
    }
  }
  if (line_number > 0) return absl::OkStatus();
  nlohmann::ordered_json header;
  header[kind.key] = kJournalVersion;
  header["fingerprint"] = fingerprint;
  return WriteLine(JournalLine(header));
}

absl::Status LineJournal::Append(const nlohmann::ordered_json& line) {
  if (descriptor_ < 0) return absl::OkStatus();
  return WriteLine(JournalLine(line));
}

absl::Status LineJournal::WriteLine(const std::string& line) {
  size_t written = 0;
  while (written < line.size()) {
    const ssize_t count =
        write(descriptor_, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return JournalError(filename_,
                          absl::StrCat("cannot be written: ", strerror(errno)));
    }
    written += static_cast<size_t>(count);
  }
  if (fsync(descriptor_) != 0) {
    return JournalError(filename_,
                        absl::StrCat("cannot be written: ", strerror(errno)));
  }
  return absl::OkStatus();
}

}  // namespace io
}  // namespace cartographer_ext
