// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records stored beside a map: FILE.pbstream has FILE.KIND.pb (messages)
// and FILE.KIND.csv (the same as a table).
#ifndef CARTOGRAPHER_EXT_SLAM_SIDE_FILES_H_
#define CARTOGRAPHER_EXT_SLAM_SIDE_FILES_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace evaluation {

// The map's name with `ending`, such as ".loops.pb", in place of its own.
std::string SideFilename(absl::string_view pbstream_filename,
                         absl::string_view ending);

// Writes both files. Without records (no bytes), files of an earlier map are
// removed.
absl::Status WriteSideFiles(const std::string& records_filename,
                            const std::string& bytes,
                            const std::string& csv_filename,
                            const std::string& csv);

// Reads a file; NotFound names it.
absl::StatusOr<std::string> ReadBytes(const std::string& filename);

// Reads a file and parses it with `parse`; errors name the file.
template <typename Records>
absl::StatusOr<Records> ReadSideFile(
    const std::string& filename,
    absl::StatusOr<Records> (*const parse)(absl::string_view)) {
  const absl::StatusOr<std::string> bytes = ReadBytes(filename);
  if (!bytes.ok()) return bytes.status();
  absl::StatusOr<Records> records = parse(*bytes);
  if (records.ok()) return records;
  return absl::Status(records.status().code(),
                      absl::StrCat(filename, ": ", records.status().message()));
}

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SIDE_FILES_H_
