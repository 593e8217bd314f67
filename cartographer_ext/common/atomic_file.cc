// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace {

absl::Status WriteError(const std::string& path, int error_number) {
  return absl::ErrnoToStatus(error_number == 0 ? EIO : error_number,
                             absl::StrCat("cannot write ", path));
}

// Follows symbolic links, so that renaming replaces the file and not the link.
// A link whose target does not exist yet leads to where it would be.
std::string ResolveLinks(const std::string& path) {
  constexpr int kMaxLinks = 40;
  std::string result = path;
  for (int i = 0; i < kMaxLinks; ++i) {
    char* const resolved = ::realpath(result.c_str(), nullptr);
    if (resolved != nullptr) {
      result = resolved;
      std::free(resolved);
      return result;
    }
    char target[PATH_MAX];
    const ssize_t length =
        ::readlink(result.c_str(), target, sizeof(target) - 1);
    if (length <= 0) return result;
    const absl::string_view name(target, static_cast<size_t>(length));
    const size_t slash = result.rfind('/');
    result = absl::StartsWith(name, "/") || slash == std::string::npos
                 ? std::string(name)
                 : absl::StrCat(result.substr(0, slash + 1), name);
  }
  return path;
}

// Temporary files that exist, for the signal handler, which may neither lock
// nor allocate. Files beyond the table, those with longer names and those of a
// parent process are left alone.
struct TemporaryName {
  enum State { kFree, kBeingFilled, kKnown };
  std::atomic<int> state{kFree};
  std::atomic<pid_t> process{0};
  std::atomic<size_t> hash{0};  // of the name
  char name[PATH_MAX];
};
constexpr int kMaxTemporaryNames = 64;
TemporaryName temporary_names[kMaxTemporaryNames];

void RememberTemporary(const std::string& name) {
  if (name.size() >= sizeof(TemporaryName::name)) return;
  for (TemporaryName& entry : temporary_names) {
    int expected = TemporaryName::kFree;
    if (!entry.state.compare_exchange_strong(expected,
                                             TemporaryName::kBeingFilled)) {
      continue;
    }
    std::memcpy(entry.name, name.c_str(), name.size() + 1);
    entry.process = ::getpid();
    entry.hash = std::hash<std::string>()(name);
    entry.state = TemporaryName::kKnown;
    return;
  }
}

void ForgetTemporary(const std::string& name) {
  const size_t hash = std::hash<std::string>()(name);
  for (TemporaryName& entry : temporary_names) {
    if (entry.state == TemporaryName::kKnown && entry.hash == hash) {
      entry.state = TemporaryName::kFree;
    }
  }
}

void RemoveTemporary(const std::string& name) {
  std::remove(name.c_str());
  ForgetTemporary(name);
}

void RemoveTemporariesAndEnd(const int signal_number) {
  for (const TemporaryName& entry : temporary_names) {
    if (entry.state == TemporaryName::kKnown && entry.process == ::getpid()) {
      ::unlink(entry.name);
    }
  }
  // The handler is reset to the default, which ends the process.
  ::raise(signal_number);
}

// The beginning of the temporary files of this computer for `path`.
std::string TemporaryStem(const std::string& path) {
  char host[256] = {};
  ::gethostname(host, sizeof(host) - 1);
  return absl::StrCat(path, ".", host, "-");
}

// Removes the temporary files of processes that have ended. Their names end in
// PID.NUMBER.tmp.
void RemoveAbandoned(const std::string& stem) {
  const size_t slash = stem.rfind('/');
  const std::string folder =
      slash == std::string::npos ? "." : stem.substr(0, slash + 1);
  const std::string beginning =
      slash == std::string::npos ? stem : stem.substr(slash + 1);
  DIR* const names = ::opendir(folder.c_str());
  if (names == nullptr) return;
  std::vector<std::string> abandoned;
  while (const dirent* const entry = ::readdir(names)) {
    const absl::string_view name = entry->d_name;
    if (!absl::StartsWith(name, beginning) || !absl::EndsWith(name, ".tmp")) {
      continue;
    }
    const absl::string_view rest = name.substr(beginning.size());
    int pid = 0;
    if (absl::SimpleAtoi(rest.substr(0, rest.find('.')), &pid) && pid > 0 &&
        ::kill(pid, 0) != 0 && errno == ESRCH) {
      abandoned.push_back(absl::StrCat(folder, "/", name));
    }
  }
  ::closedir(names);
  for (const std::string& name : abandoned) std::remove(name.c_str());
}

absl::Status Replace(const std::string& temporary, const std::string& path) {
  if (std::rename(temporary.c_str(), path.c_str()) != 0) {
    return WriteError(path, errno);
  }
  ForgetTemporary(temporary);
  return absl::OkStatus();
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
  if (path == "-") {
    status_ =
        absl::InvalidArgumentError("cannot write -: this output needs a file");
    return;
  }
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
    const std::string stem = TemporaryStem(path_);
    RemoveAbandoned(stem);
    temporary_path_ = absl::StrCat(stem, ::getpid(), ".", counter++, ".tmp");
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
    RememberTemporary(temporary_path_);
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
    RemoveTemporary(temporary_path_);
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
    if (AtomicFileSet::Current() != nullptr) {
      AtomicFileSet::Current()->Add(temporary_path_, path_);
    } else {
      status_ = Replace(temporary_path_, path_);
      if (!status_.ok()) return status_;
    }
  }
  committed_ = true;
  return absl::OkStatus();
}

AtomicFileSet::AtomicFileSet() { Current() = this; }

AtomicFileSet::~AtomicFileSet() {
  Current() = nullptr;
  for (const auto& file : waiting_) {
    if (!file.first.empty()) RemoveTemporary(file.first);
  }
}

void AtomicFileSet::Add(const std::string& temporary, const std::string& path) {
  for (auto& file : waiting_) {
    if (file.second != path) continue;
    if (!file.first.empty()) RemoveTemporary(file.first);
    file.first = temporary;
    return;
  }
  waiting_.emplace_back(temporary, path);
}

std::string AtomicFileSet::NameToRead(const std::string& path) {
  if (Current() == nullptr) return path;
  const std::string resolved = ResolveLinks(path);
  for (const auto& file : Current()->waiting_) {
    if (file.second == resolved) return file.first;
  }
  return path;
}

AtomicFileSet*& AtomicFileSet::Current() {
  static AtomicFileSet* current = nullptr;
  return current;
}

absl::Status AtomicFileSet::Commit() {
  while (!waiting_.empty()) {
    const auto& file = waiting_.front();
    if (file.first.empty()) {
      std::remove(file.second.c_str());
    } else {
      const absl::Status status = Replace(file.first, file.second);
      if (!status.ok()) return status;
    }
    waiting_.erase(waiting_.begin());
  }
  return absl::OkStatus();
}

void RemoveWithSet(const std::string& path) {
  if (AtomicFileSet::Current() == nullptr) {
    std::remove(path.c_str());
  } else {
    AtomicFileSet::Current()->Add("", ResolveLinks(path));
  }
}

void RemoveTemporaryFilesOnSignals() {
  for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction action;
    // Ignored signals stay ignored, as under nohup.
    if (::sigaction(number, nullptr, &action) != 0 ||
        action.sa_handler != SIG_DFL) {
      continue;
    }
    action.sa_handler = &RemoveTemporariesAndEnd;
    action.sa_flags = SA_RESETHAND | SA_NODEFER;
    ::sigaction(number, &action, nullptr);
  }
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
