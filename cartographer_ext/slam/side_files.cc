// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/side_files.h"

#include <fstream>
#include <limits>
#include <utility>

#include "absl/strings/strip.h"
#include "cartographer_ext/common/bounded_read.h"

namespace cartographer_ext {
namespace evaluation {

std::string SideFilename(const absl::string_view pbstream_filename,
                         const absl::string_view ending) {
  return absl::StrCat(absl::StripSuffix(pbstream_filename, ".pbstream"),
                      ending);
}

SideFileWriter::SideFileWriter(std::string records_filename,
                               std::string csv_filename)
    : records_filename_(std::move(records_filename)),
      csv_filename_(std::move(csv_filename)) {}

void SideFileWriter::Add(const absl::string_view bytes,
                         const absl::string_view csv) {
  if (records_ == nullptr) {
    records_ = std::make_unique<AtomicFile>(records_filename_);
    csv_ = std::make_unique<AtomicFile>(csv_filename_);
  }
  if (!records_->status().ok() || !csv_->status().ok()) return;
  records_->stream().write(bytes.data(),
                           static_cast<std::streamsize>(bytes.size()));
  csv_->stream().write(csv.data(), static_cast<std::streamsize>(csv.size()));
}

absl::Status SideFileWriter::Finish() {
  if (records_ == nullptr) {
    RemoveWithSet(records_filename_);
    RemoveWithSet(csv_filename_);
    return absl::OkStatus();
  }
  for (AtomicFile* const file : {records_.get(), csv_.get()}) {
    const absl::Status status =
        file->status().ok() ? file->Commit() : file->status();
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
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
