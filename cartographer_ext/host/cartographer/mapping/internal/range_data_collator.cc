// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/range_data_collator.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "glog/logging.h"

namespace cartographer {
namespace mapping {

using sensor::TimedPointCloudData;
using sensor::TimedPointCloudOriginData;
using sensor::TimedRangefinderPoint;

namespace {

using Measurement = TimedPointCloudOriginData::RangeMeasurement;

// Points [begin, end) of a scan.
struct Slice {
  size_t begin;
  size_t end;
};

// The points from `begin` to `end`, both included. The points of a scan are in
// order of time.
Slice PointsBetween(const TimedPointCloudData& scan, const common::Time begin,
                    const common::Time end) {
  const auto first = scan.ranges.begin();
  const auto time_of = [&scan](const TimedRangefinderPoint& point) {
    return scan.time + common::FromSeconds(point.time);
  };
  const auto in_time = std::find_if(first, scan.ranges.end(),
                                    [&](const TimedRangefinderPoint& point) {
                                      return time_of(point) >= begin;
                                    });
  const auto too_new = std::find_if(
      in_time, scan.ranges.end(),
      [&](const TimedRangefinderPoint& point) { return time_of(point) > end; });
  return Slice{static_cast<size_t>(in_time - first),
               static_cast<size_t>(too_new - first)};
}

// Appends points of a scan, their times relative to the time of the sweep.
void Append(const TimedPointCloudData& scan, const Slice& slice,
            TimedPointCloudOriginData* const sweep) {
  if (slice.begin == slice.end) {
    return;
  }
  const float shift = common::ToSeconds(scan.time - sweep->time);
  Measurement measurement;
  measurement.origin_index = sweep->origins.size();
  sweep->origins.push_back(scan.origin);
  sweep->ranges.reserve(sweep->ranges.size() + slice.end - slice.begin);
  for (size_t i = slice.begin; i < slice.end; ++i) {
    measurement.point_time = scan.ranges[i];
    measurement.point_time.time += shift;
    measurement.intensity = scan.intensities[i];
    sweep->ranges.push_back(measurement);
  }
}

bool ComesBefore(const Measurement& a, const Measurement& b) {
  return a.point_time.time < b.point_time.time;
}

template <typename T>
void DropFirst(const size_t count, std::vector<T>* const values) {
  values->erase(values->begin(), values->begin() + count);
}

}  // namespace

TimedPointCloudOriginData RangeDataCollator::AddRangeData(
    const std::string& sensor_id, TimedPointCloudData timed_point_cloud_data) {
  CHECK_EQ(expected_sensor_ids_.count(sensor_id), 1)
      << "'" << sensor_id << "' is not a range sensor of this trajectory";
  timed_point_cloud_data.intensities.resize(
      timed_point_cloud_data.ranges.size(), 0.f);
  TimedPointCloudOriginData sweep;
  const auto overtaken = pending_.find(sensor_id);
  const bool others_are_silent = overtaken != pending_.end();
  if (others_are_silent) {
    sweep = TakeSweepUntil(common::Time(overtaken->second.time));
  }
  pending_.emplace(sensor_id, std::move(timed_point_cloud_data));
  const bool all_have_delivered =
      pending_.size() == expected_sensor_ids_.size();
  if (!others_are_silent && all_have_delivered) {
    sweep = TakeSweepUntil(OldestPendingTime());
  }
  return sweep;
}

common::Time RangeDataCollator::OldestPendingTime() const {
  const auto oldest = std::min_element(pending_.begin(), pending_.end(),
                                       [](const auto& a, const auto& b) {
                                         return a.second.time < b.second.time;
                                       });
  return oldest->second.time;
}

TimedPointCloudOriginData RangeDataCollator::TakeSweepUntil(
    const common::Time end) {
  TimedPointCloudOriginData sweep;
  sweep.time = end;
  size_t num_late_points = 0;
  for (auto entry = pending_.begin(); entry != pending_.end();) {
    TimedPointCloudData& scan = entry->second;
    const Slice slice = PointsBetween(scan, sweep_end_, end);
    Append(scan, slice, &sweep);
    DropFirst(slice.end, &scan.ranges);
    DropFirst(slice.end, &scan.intensities);
    num_late_points += slice.begin;
    entry = scan.ranges.empty() ? pending_.erase(entry) : std::next(entry);
  }
  sweep_end_ = end;
  LOG_IF_EVERY_N(WARNING, num_late_points > 0, 100)
      << num_late_points << " points came after their sweep and are dropped";
  // Not a stable sort: the order of points of one time decides which of them a
  // voxel filter keeps, and must be that of Cartographer.
  std::sort(sweep.ranges.begin(), sweep.ranges.end(), ComesBefore);
  return sweep;
}

}  // namespace mapping
}  // namespace cartographer
