// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SLAM_SCAN_CONVERSION_H_
#define CARTOGRAPHER_EXT_SLAM_SCAN_CONVERSION_H_

#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace evaluation {

// The scan as points in the tracking frame with the laser as origin. Beams
// without an echo are skipped: NaN, infinite, and ranges outside the laser's
// own limits and outside [min_range, max_range] (metres). Hits and rays that
// only clear free space are distinguished later, by the range limits of local
// SLAM. The time of a point is relative to the stamp of the scan, which is that
// of the last beam, so it is never positive.
cartographer::sensor::TimedPointCloudData ToTimedPointCloudData(
    const io::LaserScan& scan, double min_range, double max_range);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SCAN_CONVERSION_H_
