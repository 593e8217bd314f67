// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the laser is mounted, from the two poses of the scan lines.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_LASER_OFFSET_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_LASER_OFFSET_H_

#include <vector>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace io {

constexpr double kMaxLaserOffset = 5.;  // metres

// (robot <- laser) that explains 99 % of `offsets`; false if none does, or if
// it is farther than kMaxLaserOffset.
bool FindConstantOffset(const std::vector<Pose2>& offsets, Pose2* offset);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_LASER_OFFSET_H_
