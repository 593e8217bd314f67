// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reference relations of Kuemmerle et al., one per line:
//
//   t1 t2 x y z roll pitch yaw
//
// the pose at t2 relative to the pose at t1, in seconds, metres and radians;
// rotation = Rz(yaw) Ry(pitch) Rx(roll). Comment lines start with '#'.
// Compressed files are read transparently.
#ifndef CARTOGRAPHER_EXT_IO_RELATIONS_FILE_H_
#define CARTOGRAPHER_EXT_IO_RELATIONS_FILE_H_

#include <string>
#include <vector>

#include "Eigen/Geometry"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

struct StampedRelation {
  TimeNs time1 = 0;
  TimeNs time2 = 0;
  Eigen::Isometry3d relative =  // (pose at t1 <- pose at t2)
      Eigen::Isometry3d::Identity();
};

// In the order of the file. Errors name file and line.
absl::StatusOr<std::vector<StampedRelation>> ReadRelations(
    const std::string& filename);

// Atomically; "-" is standard output. Lines of `comment` are written at the
// top.
absl::Status WriteRelations(const std::vector<StampedRelation>& relations,
                            const std::string& filename,
                            const std::string& comment = "");

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_RELATIONS_FILE_H_
