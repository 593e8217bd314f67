// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records stored beside a map: FILE.pbstream has FILE.KIND.pb (messages)
// and FILE.KIND.csv (the same as a table).
#ifndef CARTOGRAPHER_EXT_SLAM_SIDE_FILES_H_
#define CARTOGRAPHER_EXT_SLAM_SIDE_FILES_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/host_ticks.h"

namespace cartographer_ext {
namespace evaluation {

// The map's name with `ending`, such as ".loops.pb", in place of its own.
std::string SideFilename(absl::string_view pbstream_filename,
                         absl::string_view ending);

// Writes both files, piece by piece: of some runs they have 20 MB. Without any
// piece, files of an earlier map are removed.
class SideFileWriter {
 public:
  SideFileWriter(std::string records_filename, std::string csv_filename);

  // Appends to each file. Errors are kept for Finish.
  void Add(absl::string_view bytes, absl::string_view csv);
  // To be called once, at the end.
  absl::Status Finish();

 private:
  const std::string records_filename_, csv_filename_;
  std::unique_ptr<AtomicFile> records_, csv_;
};

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

// The same for records with a time in host ticks; an error names the first record,
// a `name`, at a time that is none.
template <typename Record>
absl::StatusOr<std::vector<Record>> ReadTimedSideFile(
    const std::string& filename, const absl::string_view name,
    absl::StatusOr<std::vector<Record>> (*const parse)(absl::string_view),
    const std::function<int64_t(const Record&)>& time) {
  auto records = ReadSideFile(filename, parse);
  if (!records.ok()) return records;
  for (size_t i = 0; i != records->size(); ++i) {
    const int64_t ticks = time((*records)[i]);
    if (AreHostTicks(ticks)) continue;
    return absl::DataLossError(absl::StrCat(filename, ": ", name, " record ", i,
                                            " is at ", ticks,
                                            ", which no clock can show"));
  }
  return records;
}

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SIDE_FILES_H_
