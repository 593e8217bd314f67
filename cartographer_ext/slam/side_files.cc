// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/side_files.h"

#include <fstream>
#include <limits>

#include "absl/strings/strip.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/bounded_read.h"

namespace cartographer_ext {
namespace evaluation {

std::string SideFilename(const absl::string_view pbstream_filename,
                         const absl::string_view ending) {
  return absl::StrCat(absl::StripSuffix(pbstream_filename, ".pbstream"),
                      ending);
}

absl::Status WriteSideFiles(const std::string& records_filename,
                            const std::string& bytes,
                            const std::string& csv_filename,
                            const std::string& csv) {
  if (bytes.empty()) {
    RemoveWithSet(records_filename);
    RemoveWithSet(csv_filename);
    return absl::OkStatus();
  }
  const absl::Status status = WriteFileAtomically(records_filename, bytes);
  if (!status.ok()) return status;
  return WriteFileAtomically(csv_filename, csv);
}

absl::StatusOr<std::string> ReadBytes(const std::string& filename) {
  std::ifstream file(AtomicFileSet::NameToRead(filename), std::ios::binary);
  if (!file) return absl::NotFoundError(absl::StrCat("cannot read ", filename));
  std::string bytes;
  if (!ReadUpTo(std::numeric_limits<size_t>::max(), &file, &bytes)) {
    return absl::DataLossError(absl::StrCat("cannot read ", filename));
  }
  return bytes;
}

}  // namespace evaluation
}  // namespace cartographer_ext
