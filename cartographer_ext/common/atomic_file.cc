// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace {

absl::Status WriteError(const std::string& path, int error_number) {
  return absl::ErrnoToStatus(error_number == 0 ? EIO : error_number,
                             absl::StrCat("cannot write ", path));
}

// Follows symbolic links, so that renaming replaces the file and not the link.
std::string ResolveLinks(const std::string& path) {
  char* const resolved = ::realpath(path.c_str(), nullptr);
  if (resolved == nullptr) return path;
  std::string result(resolved);
  std::free(resolved);
  return result;
}

// The content reaches the disk before the name does; otherwise a power failure
// may leave an empty file under the new name.
absl::Status Synchronize(const std::string& file, const std::string& path) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return WriteError(path, errno);
  const int result = ::fsync(descriptor);
  const int error_number = errno;
  ::close(descriptor);
  // Some file systems cannot synchronize; that is no failure of writing.
  if (result != 0 && error_number != EINVAL && error_number != ENOTSUP) {
    return WriteError(path, error_number);
  }
  return absl::OkStatus();
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  stream_.reset(new std::ostream(nullptr));  // Swallows output on errors.
  struct stat existing;
  const bool exists = ::stat(path.c_str(), &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode)) {
    status_ = WriteError(path, EISDIR);
    return;
  }
  if (exists && !S_ISREG(existing.st_mode)) {
    // Devices and pipes are written in place, never replaced.
    temporary_path_ = path;
  } else {
    path_ = ResolveLinks(path);
    static std::atomic<int> counter{0};
    temporary_path_ =
        absl::StrCat(path_, ".", ::getpid(), ".", counter++, ".tmp");
    const mode_t mode = exists ? (existing.st_mode & 0777) : 0666;
    const int descriptor =
        ::open(temporary_path_.c_str(),
               O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
    if (descriptor < 0) {
      status_ = WriteError(path, errno);
      temporary_path_.clear();
      return;
    }
    ::close(descriptor);
  }
  errno = 0;
  std::unique_ptr<std::ofstream> file(
      new std::ofstream(temporary_path_, std::ios::binary));
  if (!file->is_open()) {
    status_ = WriteError(path, errno);
    return;
  }
  stream_ = std::move(file);
}

AtomicFile::~AtomicFile() {
  stream_.reset();
  if (!committed_ && !temporary_path_.empty() && temporary_path_ != path_) {
    std::remove(temporary_path_.c_str());
  }
}

std::ostream& AtomicFile::stream() { return *stream_; }

absl::Status AtomicFile::Commit() {
  if (!status_.ok() || committed_) return status_;
  errno = 0;
  stream_->flush();
  if (!stream_->good()) {
    // The stream does not keep the reason; a full disk is the likely one and
    // errno still holds it when it happened in this flush.
    status_ = WriteError(path_, errno == 0 ? ENOSPC : errno);
    return status_;
  }
  static_cast<std::ofstream*>(stream_.get())->close();
  if (!stream_->good()) {
    status_ = WriteError(path_, errno);
    return status_;
  }
  if (temporary_path_ != path_) {
    status_ = Synchronize(temporary_path_, path_);
    if (!status_.ok()) return status_;
    if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
      status_ = WriteError(path_, errno);
      return status_;
    }
  }
  committed_ = true;
  return absl::OkStatus();
}

absl::Status WriteFileAtomically(const std::string& path,
                                 absl::string_view content) {
  if (path == "-") {
    std::cout.write(content.data(), content.size());
    std::cout.flush();
    if (!std::cout.good()) return WriteError("standard output", errno);
    return absl::OkStatus();
  }
  AtomicFile file(path);
  if (!file.status().ok()) return file.status();
  file.stream().write(content.data(), content.size());
  return file.Commit();
}

}  // namespace cartographer_ext
