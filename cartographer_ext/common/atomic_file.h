// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Output files that are either whole or absent: written to a temporary file in
// the target's folder, flushed, then renamed. A full disk or an unwritable path
// gives an error naming the path and leaves nothing behind. What a killed process
// of this computer left is removed when its file is written again.
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

  // Not OK when the temporary file could not be created.
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

// While it lives, files that are committed wait for its own Commit, so that a
// command writes all of its files or none. Without it they are removed. Readers
// of what may wait open NameToRead. One at a time, used by one thread.
class AtomicFileSet {
 public:
  AtomicFileSet();
  ~AtomicFileSet();
  AtomicFileSet(const AtomicFileSet&) = delete;
  AtomicFileSet& operator=(const AtomicFileSet&) = delete;

  // The first file that cannot be put in its place ends it.
  absl::Status Commit();

  // Where the content of `path` is: that of the temporary file while a set
  // lives in which `path` waits, empty if it waits to be removed, else `path`.
  static std::string NameToRead(const std::string& path);

 private:
  friend class AtomicFile;
  friend void RemoveWithSet(const std::string& path);
  // The set that lives, or null.
  static AtomicFileSet*& Current();

  // What waited for `path` before is given up.
  void Add(const std::string& temporary, const std::string& path);

  // Temporary files and what they become; without one the file is removed.
  std::vector<std::pair<std::string, std::string>> waiting_;
};

// Removes a file, if it is there; while a set lives, with its Commit.
void RemoveWithSet(const std::string& path);

// The whole content in one call. "-" writes to standard output.
absl::Status WriteFileAtomically(const std::string& path,
                                 absl::string_view content);

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_ATOMIC_FILE_H_
