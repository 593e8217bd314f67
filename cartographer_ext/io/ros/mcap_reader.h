// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// MCAP files of ROS 2 (schemas "ros2msg" or "ros2idl", messages in CDR), read
// from the beginning to the end without their index. A truncated file, as from
// a killed recorder, is read up to the truncation, with a warning. A damaged
// chunk is left out, with a warning; where the damage hides the next record,
// the summary at the end of the file says where the next chunk begins. A file
// of which nothing can be read is an error.
#ifndef CARTOGRAPHER_EXT_IO_ROS_MCAP_READER_H_
#define CARTOGRAPHER_EXT_IO_ROS_MCAP_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/ros/ros_container.h"

namespace cartographer_ext {
namespace io {

// Errors name the file and, where it helps, the offset.
absl::StatusOr<std::unique_ptr<RosContainer>> OpenMcap(
    const std::string& filename);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_MCAP_READER_H_
