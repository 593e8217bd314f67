// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that a ROS 1 bag (format 2.0) is sound before librosbag-storage sees
// it: that library trusts the offsets, lengths and counts it finds and reads
// beyond its buffers where they lie. Every record, every chunk (decompressed)
// and every index entry is checked, so this costs about as much as reading the
// bag once.
//
// File: "#ROSBAG V2.0\n", then records
//   header length (uint32), header, data length (uint32), data
// where a header is a list of
//   field length (uint32), name '=' value
// Little endian. The field "op" is the kind: 3 file header, 5 chunk (its
// data are records of kinds 7 and 2, maybe compressed), 4 index of the chunk
// before it, 7 connection, 6 chunk summary, 2 message.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_CHECK_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_CHECK_H_

#include <string>

#include "absl/status/status.h"

namespace cartographer_ext {
namespace io {

// OK if the bag is safe to open. Errors name the file and, where it helps, the
// offset. Unindexed (unfinished) bags are recognised.
absl::Status CheckRosbag(const std::string& filename);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_CHECK_H_
