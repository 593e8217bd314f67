// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Recordings of rosbag2: its SQLite databases (.db3) and its folders, whose
// files (.db3 or .mcap, in order of the number in their names) are one
// recording: those of metadata.yaml, or names that differ by the number alone.
// Messages on damaged pages of a database are left out, with a
// warning, and so are files of a folder of which nothing can be read.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROSBAG2_READER_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROSBAG2_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/ros/ros_container.h"

namespace cartographer_ext {
namespace io {

// Errors name the file.
absl::StatusOr<std::unique_ptr<RosContainer>> OpenDb3(
    const std::string& filename);

// A folder without such files, or with those of several recordings, is an error.
absl::StatusOr<std::unique_ptr<RosContainer>> OpenRosbag2Folder(
    const std::string& folder);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROSBAG2_READER_H_
