// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Merges the scans of several range sensors of one trajectory into sweeps that
// do not overlap in time, so that every point passes exactly once and in order.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_RANGE_DATA_COLLATOR_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_RANGE_DATA_COLLATOR_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/sensor/timed_point_cloud_data.h"

namespace cartographer {
namespace mapping {

class RangeDataCollator {
 public:
  explicit RangeDataCollator(
      const std::vector<std::string>& expected_range_sensor_ids)
      : expected_sensor_ids_(expected_range_sensor_ids.begin(),
                             expected_range_sensor_ids.end()) {}

  // Returns the points up to the newest time that all sensors have reached; no
  // points as long as some sensor has not delivered yet. A sensor that delivers
  // twice while others are silent forces out what is there up to its first
  // scan. The times of the points are relative to the time of the result.
  sensor::TimedPointCloudOriginData AddRangeData(
      const std::string& sensor_id,
      sensor::TimedPointCloudData timed_point_cloud_data);

 private:
  // There must be a scan.
  common::Time OldestPendingTime() const;
  // Takes all points after the last sweep and not after `end`.
  sensor::TimedPointCloudOriginData TakeSweepUntil(common::Time end);

  const std::set<std::string> expected_sensor_ids_;
  std::map<std::string, sensor::TimedPointCloudData> pending_;
  common::Time sweep_end_ = common::Time::min();
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_RANGE_DATA_COLLATOR_H_
