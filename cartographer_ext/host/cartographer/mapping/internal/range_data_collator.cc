// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/range_data_collator.h"

#include <algorithm>

#include "glog/logging.h"

namespace cartographer {
namespace mapping {

using sensor::TimedPointCloudData;
using sensor::TimedPointCloudOriginData;
using sensor::TimedRangefinderPoint;

TimedPointCloudOriginData RangeDataCollator::AddRangeData(
    const std::string& sensor_id, TimedPointCloudData timed_point_cloud_data) {
  CHECK_NE(expected_sensor_ids_.count(sensor_id), 0)
      << "'" << sensor_id << "' is not a range sensor of this trajectory";
  timed_point_cloud_data.intensities.resize(
      timed_point_cloud_data.ranges.size(), 0.f);

  const auto waiting = pending_.find(sensor_id);
  if (waiting != pending_.end()) {
    const common::Time first_scan = waiting->second.time;
    TimedPointCloudOriginData sweep = TakeSweepUntil(first_scan);
    pending_.emplace(sensor_id, std::move(timed_point_cloud_data));
    return sweep;
  }
  pending_.emplace(sensor_id, std::move(timed_point_cloud_data));
  if (pending_.size() < expected_sensor_ids_.size()) {
    return {};
  }
  common::Time reached_by_all = common::Time::max();
  for (const auto& id_data : pending_) {
    reached_by_all = std::min(reached_by_all, id_data.second.time);
  }
  return TakeSweepUntil(reached_by_all);
}

TimedPointCloudOriginData RangeDataCollator::TakeSweepUntil(
    const common::Time end) {
  const common::Time begin = sweep_end_;
  sweep_end_ = end;
  TimedPointCloudOriginData sweep{end, {}, {}};
  size_t num_late_points = 0;
  for (auto it = pending_.begin(); it != pending_.end();) {
    TimedPointCloudData& scan = it->second;
    const auto time_of = [&scan](const TimedRangefinderPoint& point) {
      return scan.time + common::FromSeconds(point.time);
    };
    const size_t size = scan.ranges.size();
    size_t first = 0;
    while (first < size && time_of(scan.ranges[first]) < begin) {
      ++first;
    }
    size_t last = first;
    while (last < size && time_of(scan.ranges[last]) <= end) {
      ++last;
    }
    num_late_points += first;

    if (first < last) {
      const size_t origin_index = sweep.origins.size();
      sweep.origins.push_back(scan.origin);
      const float shift = common::ToSeconds(scan.time - end);
      sweep.ranges.reserve(sweep.ranges.size() + (last - first));
      for (size_t i = first; i < last; ++i) {
        TimedRangefinderPoint point = scan.ranges[i];
        point.time += shift;
        sweep.ranges.push_back(TimedPointCloudOriginData::RangeMeasurement{
            point, scan.intensities[i], origin_index});
      }
    }
    if (last == size) {
      it = pending_.erase(it);
      continue;
    }
    scan.ranges.erase(scan.ranges.begin(), scan.ranges.begin() + last);
    scan.intensities.erase(scan.intensities.begin(),
                           scan.intensities.begin() + last);
    ++it;
  }
  LOG_IF_EVERY_N(WARNING, num_late_points > 0, 100)
      << num_late_points << " points came after their sweep and are dropped";
  // Not a stable sort: the order of points of one time decides which of them a
  // voxel filter keeps, and is to be the one that Cartographer has.
  std::sort(sweep.ranges.begin(), sweep.ranges.end(),
            [](const TimedPointCloudOriginData::RangeMeasurement& a,
               const TimedPointCloudOriginData::RangeMeasurement& b) {
              return a.point_time.time < b.point_time.time;
            });
  return sweep;
}

}  // namespace mapping
}  // namespace cartographer
