// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads whole Cartographer states (.pbstream, format versions 1 and 2, 2D) from
// untrusted files. The host's own loader aborts if something is wrong with a
// file; it accepts every file that passes these checks.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_READER_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_READER_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"

namespace cartographer_ext {
namespace io {

// The records of a state by kind, each in the order of the file. Withdrawn
// loops and their marks (common/withdrawn_loops.h) are skipped, so they have no
// effect and are not in a state that is written again.
struct Pbstream {
  cartographer::mapping::proto::SerializationHeader header;
  cartographer::mapping::proto::PoseGraph pose_graph;
  cartographer::mapping::proto::AllTrajectoryBuilderOptions options;
  std::vector<cartographer::mapping::proto::Submap> submaps;
  std::vector<cartographer::mapping::proto::Node> nodes;
  std::vector<cartographer::mapping::proto::TrajectoryData> trajectory_data;
  std::vector<cartographer::mapping::proto::ImuData> imu_data;
  std::vector<cartographer::mapping::proto::OdometryData> odometry_data;
  std::vector<cartographer::mapping::proto::FixedFramePoseData>
      fixed_frame_pose_data;
  std::vector<cartographer::mapping::proto::LandmarkData> landmark_data;
  // Number of records of unknown kinds, which are skipped.
  int64_t num_unknown_records = 0;
  // Constraints skipped as withdrawn, with the marks.
  int64_t num_withdrawn_constraints = 0;
};

// Memory limits for a file. A record may expand to `max_expansion` times its
// size, or to the given floor if that is more: grids of unknown cells compress
// very well (up to 110 times), but nothing else does. Maps of buildings expand
// 1 to 8 times in total and take up to 30 times their size once parsed.
struct PbstreamLimits {
  int64_t max_file_size = int64_t{1} << 32;    // bytes
  int64_t max_record_size = int64_t{1} << 30;  // bytes, expanded
  int64_t max_expansion = 64;
  int64_t record_floor = int64_t{1} << 20;         // bytes
  int64_t submap_record_floor = int64_t{1} << 24;  // bytes
  // For all records of one file together: expanded bytes, then memory of the
  // parsed messages, each relative to the size of the file.
  int64_t total_floor = int64_t{1} << 24;  // bytes
  int64_t max_total_expansion = 32;
  int64_t memory_floor = int64_t{1} << 26;  // bytes
  int64_t max_memory_expansion = 40;
  // Known cells of all grids, relative to the size of the file. The loop search
  // needs some hundred bytes for each. The submaps of fifteen robot maps have
  // at most 2.6 per byte.
  int64_t known_cells_floor = 1500000;
  int64_t max_known_cells_expansion = 8;
};

struct PbstreamReaderOptions {
  PbstreamLimits limits;
  // Reject contents with problems found by FindPbstreamProblems.
  bool validate = true;
  // Takes each submap with a grid as it is read, before the rest of the file is
  // checked. Of the grid only the limits are then in the result: the cells of
  // all of them together would take most of the memory.
  std::function<void(const cartographer::mapping::proto::Submap&)> take_grid;
};

// Errors name the file and, where there is one, the record (the header is
// record 0) and its position: NotFound when the file cannot be opened,
// InvalidArgument for any other input, Unimplemented for 3D states and versions
// that are not supported, ResourceExhausted beyond the limits, DataLoss for
// truncated and corrupt files.
absl::StatusOr<Pbstream> ReadPbstream(
    const std::string& filename, const PbstreamReaderOptions& options = {});

// The same for a file in memory; `name` is for messages.
absl::StatusOr<Pbstream> ParsePbstream(
    const std::string& content, const std::string& name,
    const PbstreamReaderOptions& options = {});

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_PBSTREAM_READER_H_
