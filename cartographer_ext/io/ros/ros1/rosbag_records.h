// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The records of ROS 1 bags, format 2.0. File: "#ROSBAG V2.0\n", then records
//   header length (uint32), header, data length (uint32), data
// where a header is a list of
//   field length (uint32), name '=' value
// Little endian. The field "op" is the kind. Messages and, before the first one
// of each, connections are in chunks; indexes, for random access, follow the
// chunks and end the file.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_RECORDS_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_RECORDS_H_

#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace io {

enum RosbagOp : uint8_t {
  kRosbagMessage = 2,
  kRosbagFileHeader = 3,
  kRosbagIndex = 4,  // of the chunk before it
  kRosbagChunk = 5,
  kRosbagChunkInfo = 6,
  kRosbagConnection = 7,
};

// Header fields by name; values stay where they were read from.
class RosbagFields {
 public:
  // False if the bytes are not a list of fields.
  bool Parse(absl::string_view header);
  // Empty if there is no such field.
  absl::string_view Text(absl::string_view name) const;
  // False unless the field is there and has the size of T.
  template <typename T>
  bool Number(absl::string_view name, T* value) const {
    const absl::string_view text = Text(name);
    if (text.size() != sizeof(T)) return false;
    std::memcpy(value, text.data(), sizeof(T));
    return true;
  }

 private:
  std::map<absl::string_view, absl::string_view> fields_;
};

struct RosbagRecord {
  uint8_t op = 0;
  RosbagFields header;
  absl::string_view data;
};

// Takes a record from the front; false if there is no valid one.
bool TakeRosbagRecord(absl::string_view* rest, RosbagRecord* record);

// Whether the bytes end within the record at their front, as those of a bag
// whose recorder was killed do.
bool RosbagRecordIsCutOff(absl::string_view bytes);

// Whether the bytes begin with the header of a record, or are none.
bool StartsLikeRosbagRecord(absl::string_view bytes);

// The records of a chunk ("none", "bz2" or "lz4"), at most 512 MiB; `memory`
// keeps what was compressed. Errors do not name the file.
absl::StatusOr<absl::string_view> RosbagChunkContent(const RosbagRecord& chunk,
                                                     std::string* memory);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_RECORDS_H_
