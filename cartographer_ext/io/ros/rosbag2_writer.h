// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes ROS 2 recordings with the topics and frames of RosbagWriter: an MCAP
// file (options.compression "none", "lz4" or "zstd") or a rosbag2 database
// (".db3", not compressed).
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROSBAG2_WRITER_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROSBAG2_WRITER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/ros/ros1/rosbag_writer.h"

namespace cartographer_ext {
namespace io {

enum class Rosbag2Storage { kMcap, kDb3 };

absl::StatusOr<std::unique_ptr<RosbagWriter>> OpenRosbag2Writer(
    const std::string& filename, Rosbag2Storage storage,
    const RosbagWriterOptions& options);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROSBAG2_WRITER_H_
