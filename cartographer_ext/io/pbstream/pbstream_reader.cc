// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/bounded_read.h"
#include "cartographer_ext/io/pbstream/grid_validation.h"
#include "cartographer_ext/io/pbstream/message_size.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/io/pbstream/pose_graph_edit.h"
#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace io {
namespace {

using Data = cartographer::mapping::proto::SerializedData;

constexpr uint32_t kOldestVersion = 1;
constexpr uint32_t kNewestVersion = 2;

bool TakeVarint(absl::string_view* bytes, uint64_t* value) {
  *value = 0;
  for (int shift = 0; shift < 64 && !bytes->empty(); shift += 7) {
    const unsigned char byte = bytes->front();
    bytes->remove_prefix(1);
    *value |= static_cast<uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return true;
  }
  return false;
}

// SerializedData is a union of messages, so a record is the number of one
// field, a size, and that message. It is parsed by hand so that the kind is
// known before memory is allocated, and that records with several messages,
// which no program writes, are refused.
bool OpenEnvelope(absl::string_view record, int* field_number,
                  absl::string_view* message) {
  uint64_t tag, size;
  constexpr uint64_t kLengthDelimited = 2;
  if (!TakeVarint(&record, &tag) || (tag & 7) != kLengthDelimited ||
      tag >> 3 == 0 || tag >> 3 >= (uint64_t{1} << 29) ||
      !TakeVarint(&record, &size) || size != record.size()) {
    return false;
  }
  *field_number = static_cast<int>(tag >> 3);
  *message = record;
  return true;
}

class RecordLimit : public ContentLimit {
 public:
  explicit RecordLimit(const PbstreamLimits& limits) : limits_(limits) {}

  int64_t For(absl::string_view beginning,
              int64_t compressed_size) const override {
    uint64_t tag = 0;
    const bool is_submap =
        TakeVarint(&beginning, &tag) && tag >> 3 == Data::kSubmapFieldNumber;
    return std::min(limits_.max_record_size,
                    std::max(limits_.max_expansion * compressed_size,
                             is_submap ? limits_.submap_record_floor
                                       : limits_.record_floor));
  }

 private:
  const PbstreamLimits limits_;
};

class Parser {
 public:
  Parser(const std::string& content, const std::string& name,
         const PbstreamReaderOptions& options)
      : name_(name),
        options_(options),
        limit_(options.limits),
        records_(content, name),
        max_total_size_(options.limits.total_floor +
                        options.limits.max_total_expansion *
                            static_cast<int64_t>(content.size())),
        max_memory_(options.limits.memory_floor +
                    options.limits.max_memory_expansion *
                        static_cast<int64_t>(content.size())),
        max_known_cells_(options.limits.known_cells_floor +
                         options.limits.max_known_cells_expansion *
                             static_cast<int64_t>(content.size())) {}

  absl::StatusOr<Pbstream> Parse() {
    if (!records_.status().ok()) return records_.status();
    for (;;) {
      std::string record;
      const absl::StatusOr<bool> more = records_.Next(limit_, &record);
      if (!more.ok()) return more.status();
      if (!*more) break;
      total_size_ += static_cast<int64_t>(record.size());
      if (total_size_ > max_total_size_) {
        return records_.Error(
            absl::StatusCode::kResourceExhausted,
            absl::StrFormat("the file expands to more than the %d bytes that "
                            "are allowed",
                            max_total_size_));
      }
      const absl::Status status =
          records_.index() == 0 ? TakeHeader(record) : TakeRecord(record);
      if (!status.ok()) return status;
    }
    if (records_.index() < 2) {
      return absl::DataLossError(
          absl::StrCat(name_, ": ends before ",
                       records_.index() < 0   ? "its header"
                       : records_.index() < 1 ? "the pose graph"
                                              : "the options"));
    }
    if (options_.validate) {
      const std::vector<std::string> problems =
          FindProblemsBesideGrids(pbstream_);
      if (!problems.empty()) {
        std::string more;
        if (problems.size() > 1) {
          more = absl::StrCat(" (and ", problems.size() - 1, " more problems)");
        }
        return absl::InvalidArgumentError(
            absl::StrCat(name_, ": ", problems.front(), more));
      }
    }
    pbstream_.num_withdrawn_constraints =
        RemoveWithdrawnLoops(&pbstream_.pose_graph);
    return std::move(pbstream_);
  }

 private:
  absl::Status TakeHeader(const std::string& record) {
    // The first record of streams from before 1.0 is another message, in which
    // field 1 is not a number.
    if (!pbstream_.header.ParseFromString(record) ||
        pbstream_.header.format_version() == 0) {
      return records_.Error(
          absl::StatusCode::kUnimplemented,
          "there is no format version: the file is not a serialized state, or "
          "it was written before Cartographer 1.0");
    }
    const uint32_t version = pbstream_.header.format_version();
    if (version < kOldestVersion || version > kNewestVersion) {
      return records_.Error(
          absl::StatusCode::kUnimplemented,
          absl::StrFormat("format version %d is not supported, only %d to %d",
                          version, kOldestVersion, kNewestVersion));
    }
    return absl::OkStatus();
  }

  // Checked before the messages are created.
  absl::Status CountMemory(const int kind, const absl::string_view message) {
    const auto* const field = Data::descriptor()->FindFieldByNumber(kind);
    if (field == nullptr) return absl::OkStatus();
    memory_ += EstimateParsedSize(*field->message_type(), message,
                                  max_memory_ - memory_);
    if (memory_ <= max_memory_) return absl::OkStatus();
    return records_.Error(
        absl::StatusCode::kResourceExhausted,
        absl::StrFormat("the contents of the file would take more than the %d "
                        "bytes of memory that are allowed for its size",
                        max_memory_));
  }

  absl::Status TakeRecord(const std::string& record) {
    int kind;
    absl::string_view message;
    if (record.empty()) {
      ++pbstream_.num_unknown_records;
      return absl::OkStatus();
    }
    if (!OpenEnvelope(record, &kind, &message)) {
      return records_.Error(absl::StatusCode::kDataLoss,
                            "this is not a message of a serialized state");
    }
    // Everything else refers to these two.
    const bool is_pose_graph = kind == Data::kPoseGraphFieldNumber;
    const bool is_options =
        kind == Data::kAllTrajectoryBuilderOptionsFieldNumber;
    if (is_pose_graph != (records_.index() == 1)) {
      return records_.Error(absl::StatusCode::kInvalidArgument,
                            is_pose_graph ? "a second pose graph"
                                          : "the pose graph should be here");
    }
    if (is_options != (records_.index() == 2)) {
      return records_.Error(absl::StatusCode::kInvalidArgument,
                            is_options ? "trajectory options for a second time"
                                       : "the trajectory options should be "
                                         "here");
    }
    const absl::Status small_enough = CountMemory(kind, message);
    if (!small_enough.ok()) return small_enough;
    switch (kind) {
      case Data::kPoseGraphFieldNumber:
        return Fill("pose graph", message, &pbstream_.pose_graph);
      case Data::kAllTrajectoryBuilderOptionsFieldNumber:
        return Fill("trajectory options", message, &pbstream_.options);
      case Data::kSubmapFieldNumber:
        return TakeSubmap(message);
      case Data::kNodeFieldNumber:
        return Add("node", message, &pbstream_.nodes);
      case Data::kTrajectoryDataFieldNumber:
        return Add("trajectory data", message, &pbstream_.trajectory_data);
      case Data::kImuDataFieldNumber:
        return Add("IMU data", message, &pbstream_.imu_data);
      case Data::kOdometryDataFieldNumber:
        return Add("odometry data", message, &pbstream_.odometry_data);
      case Data::kFixedFramePoseDataFieldNumber:
        return Add("fixed frame pose", message,
                   &pbstream_.fixed_frame_pose_data);
      case Data::kLandmarkDataFieldNumber:
        return Add("landmark data", message, &pbstream_.landmark_data);
      default:
        ++pbstream_.num_unknown_records;
        return absl::OkStatus();
    }
  }

  absl::Status TakeSubmap(absl::string_view message) {
    const absl::Status status = Add("submap", message, &pbstream_.submaps);
    if (!status.ok()) return status;
    if (pbstream_.submaps.back().has_submap_3d()) {
      return records_.Error(absl::StatusCode::kUnimplemented,
                            "this is a 3D submap; only 2D states are "
                            "supported");
    }
    return TakeGrid(&pbstream_.submaps.back());
  }

  absl::Status TakeGrid(cartographer::mapping::proto::Submap* const submap) {
    const std::string name =
        absl::StrFormat("submap (%d, %d)", submap->submap_id().trajectory_id(),
                        submap->submap_id().submap_index());
    const auto& cells = submap->submap_2d().grid().cells();
    known_cells_ += cells.size() - std::count(cells.begin(), cells.end(), 0);
    if (known_cells_ > max_known_cells_) {
      return records_.Error(
          absl::StatusCode::kResourceExhausted,
          absl::StrFormat("with %s the grids have more than the %d known cells "
                          "that are allowed for the size of the file",
                          name, max_known_cells_));
    }
    if (!submap->submap_2d().has_grid()) return absl::OkStatus();
    if (options_.validate) {
      const std::vector<std::string> problems =
          FindGridProblems(submap->submap_2d().grid(), name);
      if (!problems.empty()) {
        return records_.Error(absl::StatusCode::kInvalidArgument,
                              problems.front());
      }
    }
    if (!options_.take_grid) return absl::OkStatus();
    options_.take_grid(*submap);
    auto* const grid = submap->mutable_submap_2d()->mutable_grid();
    // Clearing would keep the memory.
    cartographer::mapping::proto::Grid2D head;
    *head.mutable_limits() = grid->limits();
    grid->Swap(&head);
    return absl::OkStatus();
  }

  absl::Status Fill(absl::string_view kind, absl::string_view message,
                    google::protobuf::Message* proto) const {
    if (!proto->ParseFromArray(message.data(),
                               static_cast<int>(message.size()))) {
      return records_.Error(
          absl::StatusCode::kDataLoss,
          absl::StrCat("the ", kind, " in this record is corrupt"));
    }
    return absl::OkStatus();
  }

  template <typename Proto>
  absl::Status Add(absl::string_view kind, absl::string_view message,
                   std::vector<Proto>* protos) const {
    protos->emplace_back();
    return Fill(kind, message, &protos->back());
  }

  const std::string name_;
  const PbstreamReaderOptions options_;
  const RecordLimit limit_;
  PbstreamRecords records_;
  const int64_t max_total_size_;
  int64_t total_size_ = 0;
  const int64_t max_memory_;
  int64_t memory_ = 0;
  const int64_t max_known_cells_;
  int64_t known_cells_ = 0;
  Pbstream pbstream_;
};

}  // namespace

absl::StatusOr<Pbstream> ReadPbstream(const std::string& filename,
                                      const PbstreamReaderOptions& options) {
  struct stat info;
  if (::stat(filename.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) {
    return absl::InvalidArgumentError(absl::StrCat(filename, " is a folder"));
  }
  std::ifstream file(AtomicFileSet::NameToRead(filename), std::ios::binary);
  if (!file) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", filename));
  }
  std::string content;
  // The first block tells whether this is a pbstream, before all is read.
  if (ReadUpTo(0, &file, &content)) {
    const PbstreamRecords start(content, filename);
    if (!start.status().ok()) return start.status();
  }
  const size_t limit = static_cast<size_t>(options.limits.max_file_size);
  if (!ReadUpTo(limit, &file, &content)) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": cannot be read"));
  }
  if (content.size() > limit) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("%s: is larger than the %d bytes that are allowed",
                        filename, options.limits.max_file_size));
  }
  return ParsePbstream(content, filename, options);
}

absl::StatusOr<Pbstream> ParsePbstream(const std::string& content,
                                       const std::string& name,
                                       const PbstreamReaderOptions& options) {
  return Parser(content, name, options).Parse();
}

}  // namespace io
}  // namespace cartographer_ext
