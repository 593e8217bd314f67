// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Output files that are either complete or absent: written to a temporary file
// in the target's folder, flushed, then renamed. A full disk or an unwritable
// path gives an error naming the path and leaves nothing behind. Temporary
// files left by a killed process on this machine are removed when the same file
// is written again.
#ifndef CARTOGRAPHER_EXT_COMMON_ATOMIC_FILE_H_
#define CARTOGRAPHER_EXT_COMMON_ATOMIC_FILE_H_

#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {

// Streams into a temporary file; `Commit` renames it. Without `Commit` the
// destructor removes it.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Not OK if the temporary file could not be created.
  const absl::Status& status() const { return status_; }
  std::ostream& stream();
  // The temporary file's name, for writers that want a path (cairo, rosbag).
  const std::string& temporary_path() const { return temporary_path_; }
  absl::Status Commit();

 private:
  std::string path_;
  std::string temporary_path_;
  absl::Status status_;
  std::unique_ptr<std::ostream> stream_;
  bool committed_ = false;
};

// While an object of this class exists, committed files are renamed only by its
// own Commit, so that a command writes all of its files or none; without Commit
// they are removed. Code that may read such a pending file opens NameToRead. At
// most one at a time, used by one thread.
class AtomicFileSet {
 public:
  AtomicFileSet();
  ~AtomicFileSet();
  AtomicFileSet(const AtomicFileSet&) = delete;
  AtomicFileSet& operator=(const AtomicFileSet&) = delete;

  // Stops at the first file that cannot be renamed.
  absl::Status Commit();

  // The name under which `path` can be read: the temporary file while `path` is
  // pending in a set, empty if it is to be removed, otherwise `path`.
  static std::string NameToRead(const std::string& path);

 private:
  friend class AtomicFile;
  friend void RemoveWithSet(const std::string& path);
  // The existing set, or null.
  static AtomicFileSet*& Current();

  // A file that was pending for `path` before is discarded.
  void Add(const std::string& temporary, const std::string& path);

  // Temporary files and their targets; a target without a temporary file is
  // removed.
  std::vector<std::pair<std::string, std::string>> waiting_;
};

// Removes a file if it exists; while a set exists, at its Commit.
void RemoveWithSet(const std::string& path);

// From now on, SIGHUP, SIGINT and SIGTERM remove the temporary files of this
// process before they end it. For programs that leave these signals alone.
void RemoveTemporaryFilesOnSignals();

// Writes the whole content in one call. "-" writes to standard output.
absl::Status WriteFileAtomically(const std::string& path,
                                 absl::string_view content);

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_ATOMIC_FILE_H_
