// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/record_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace {

constexpr int kMaxNumber = 100000;

// Claims the first free name; empty, with errno set, where none can be made.
std::string MakeFile(const std::string& stem) {
  for (int number = 1; number <= kMaxNumber; ++number) {
    const std::string filename = absl::StrCat(stem, "-", number, ".csv");
    const int file =
        open(filename.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return filename;
    }
    if (errno != EEXIST) return "";
  }
  return "";
}

}  // namespace

RecordLog::RecordLog(const std::string& directory, const std::string& stem,
                     const absl::string_view head) {
  if (directory.empty()) return;
  mkdir(directory.c_str(), 0777);
  const std::string path = absl::StrCat(directory, "/", stem);
  filename_ = MakeFile(path);
  if (filename_.empty()) {
    Close(absl::StrCat(path, "-1.csv"));
    return;
  }
  table_.open(filename_, std::ios::binary);
  const std::string messages =
      absl::StrCat(filename_.substr(0, filename_.size() - 4), ".pb");
  messages_.open(messages, std::ios::binary | std::ios::trunc);
  if (!messages_) {
    Close(messages);
    return;
  }
  Append(head, "");
}

void RecordLog::Append(const absl::string_view lines,
                       const absl::string_view bytes) {
  if (!is_on()) return;
  table_.write(lines.data(), static_cast<std::streamsize>(lines.size()));
  messages_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!table_.flush() || !messages_.flush()) Close(filename_);
}

void RecordLog::Close(const std::string& filename) {
  status_ = absl::ErrnoToStatus(errno, absl::StrCat("cannot write ", filename));
  table_.close();
  messages_.close();
}

}  // namespace cartographer_ext
